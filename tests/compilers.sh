#!/usr/bin/env bash
# Builds with g++ and clang at -O1 and -O3, and compares the float pictures of the crystal ball with
# stored hashes: a compiler must not change a bit either.
#
#   tests/compilers.sh [BUILD...]      of gcc-O1 gcc-O3 clang-O1 clang-O3; all if absent
#
# A compiler that is not installed is left out, and said to be. Takes some minutes a build.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

hashes=$PWD/tests/reference/crystal-ball.sha256
[[ $# -gt 0 ]] || set -- gcc-O1 gcc-O3 clang-O1 clang-O3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for build in "$@"; do
  compiler=${build%-*}
  [[ $compiler == gcc ]] && compiler=g++
  [[ $compiler == clang ]] && compiler=clang++
  command -v "$compiler" >/dev/null || { echo "$build: left out, no $compiler" >&2; continue; }
  # A build type that CMake knows no flags for: Release would add its -O3 behind.
  cmake -S . -B "build/$build" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_BUILD_TYPE=Plain -DCMAKE_CXX_FLAGS="-${build#*-} -DNDEBUG" \
    -DSHEAF_BUILD_TESTS=OFF -DSHEAF_BUILD_BENCH=OFF >/dev/null
  cmake --build "build/$build" --parallel "$(nproc)" --target sheaf >"$folder/log" || { cat "$folder/log" >&2; exit 1; }
  "build/$build/sheaf" render scenes/crystal-ball.json --views seven --size 320x240 -q \
    -o "$folder/{camera}.pfm"
  (cd "$folder" && sha256sum --quiet --check "$hashes")
  "build/$build/sheaf" compare scenes/crystal-ball.json --views seven --size 320x240 | tail -1
  echo "$build: the stored bits"
done
