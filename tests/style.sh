#!/usr/bin/env bash
# Checks that files keep to .clang-format and .clang-tidy.
#
#   tests/style.sh [--format] [--all | BASE]
#
# Without --all, of what changed since the commit BASE (main where it is absent) and what is not committed. --format leaves
# clang-tidy out: it takes some 15 seconds a file. Exits with 77 where clang-format is not installed.
# clang-tidy reads how files are compiled from build/tidy, which the script configures.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tidy=yes
if [[ ${1:-} == --format ]]; then
  tidy=no
  shift
fi
if [[ ${1:-} == --all ]]; then
  mapfile -t files < <(find src simd tests bench docs -name '*.h' -o -name '*.cc' | sort)
else
  patterns=('*.h' '*.cc')
  mapfile -t files < <({
    git diff --name-only --diff-filter=d "$(git merge-base HEAD "${1:-main}")" -- "${patterns[@]}"
    git ls-files --others --exclude-standard -- "${patterns[@]}"
  } | sort -u)
fi
existing=()
for file in "${files[@]}"; do [[ -e $file ]] && existing+=("$file"); done
if [[ ${#existing[@]} -eq 0 ]]; then
  echo "nothing to check"
  exit 0
fi

command -v clang-format >/dev/null || { echo "skipped: no clang-format" >&2; exit 77; }
clang-format --dry-run --Werror "${existing[@]}"
echo "clang-format: ${#existing[@]} files"
[[ $tidy == yes ]] || exit 0

command -v clang-tidy >/dev/null || { echo "skipped: no clang-tidy" >&2; exit 77; }
cmake --preset dev -B build/tidy -DSHEAF_UNITY_BUILD=OFF >/dev/null 2>&1
mapfile -t sources < <(printf '%s\n' "${existing[@]}" | grep '\.cc$' | grep -v '^tests/consumers/')
[[ ${#sources[@]} -gt 0 ]] || exit 0
printf '%s\0' "${sources[@]}" | xargs -0 -n 1 -P "$(nproc)" clang-tidy -p build/tidy --quiet 2>/dev/null
echo "clang-tidy: ${#sources[@]} files"
