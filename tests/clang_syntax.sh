#!/usr/bin/env bash
# Lets clang read what g++ builds of the library and the command: what one compiler takes the other may refuse. No code is made, and
# kernels are read for one SIMD target, so that it takes a small part of a build. tests/compilers.sh builds with both, and compares.
#
#   tests/clang_syntax.sh [BUILD]      BUILD: a configured folder, build/dev if absent
#
# Exits with 77 where clang is not installed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

command -v clang++ >/dev/null || { echo "skipped: no clang++" >&2; exit 77; }
# The command of each file, its compiler replaced and without what it writes, a line each.
list='
import json, shlex, sys
for entry in json.load(open(sys.argv[1])):
    words = shlex.split(entry["command"])
    start = next(i for i, word in enumerate(words) if word.startswith("-"))
    if not any(folder in entry["file"] for folder in ("/src/", "/simd/", "/Unity/")): continue
    keep = [w for w in words[start:words.index("-o")] if w not in ("-MD", "-Werror")]
    if "-MT" in keep: del keep[keep.index("-MT"):]
    flags = ["-fsyntax-only", "-w", "-DHWY_DISABLED_TARGETS=HWY_AVX3_DL+HWY_AVX3+HWY_AVX2+HWY_SSE4"]
    print("cd", shlex.quote(entry["directory"]), "&& clang++", shlex.join(keep + flags + [entry["file"]]))
'
mapfile -t commands < <(python3 -c "$list" "${1:-build/dev}/compile_commands.json")
[[ ${#commands[@]} -gt 0 ]] || { echo "no files in ${1:-build/dev}" >&2; exit 1; }
printf '%s\0' "${commands[@]}" | xargs -0 -n 1 -P "$(nproc)" sh -c
echo "clang read ${#commands[@]} files"
