#!/usr/bin/env bash
# Builds with g++ and clang at -O1 and -O3, and compares the float pictures of the crystal ball with
# stored hashes: a compiler must not change a bit either. Its pictures in double and those of the frame scenes
# (make_scene; the first build's, since libm makes some vertices) are compared with the first build's, and the
# stress cases run in each.
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
    -DCMAKE_BUILD_TYPE=Plain -DCMAKE_CXX_FLAGS="-${build#*-} -DNDEBUG" -DSHEAF_BUILD_TESTS=OFF \
    -DSHEAF_BUILD_BENCH=ON >/dev/null
  cmake --build "build/$build" --parallel "$(nproc)" --target sheaf make_scene >"$folder/log" ||
    { cat "$folder/log" >&2; exit 1; }
  sheaf=build/$build/sheaf
  "$sheaf" render scenes/crystal-ball.json --views seven --size 320x240 -q -o "$folder/{camera}.pfm"
  (cd "$folder" && sha256sum --quiet --check "$hashes")
  "$sheaf" compare scenes/crystal-ball.json --views seven --size 320x240 | tail -1

  "$sheaf" render scenes/crystal-ball.json --views seven --size 160x120 --precision double -q -o "$folder/{camera}-double.pfm"
  for scene in balls tetra mount knot; do
    [[ -e $folder/$scene.json ]] || "build/$build/bench/make_scene" "$scene" -o "$folder/$scene.json"
    "$sheaf" render "$folder/$scene.json" --size 160x120 -q -o "$folder/$scene.pfm"
    "$sheaf" render "$folder/$scene.json" --size 160x120 --precision double -q -o "$folder/$scene-double.pfm"
  done
  if [[ -e $folder/first.sha256 ]]; then
    (cd "$folder" && sha256sum --quiet --check first.sha256)
  else
    (cd "$folder" && sha256sum -- *.pfm >first.sha256)
  fi
  "$sheaf" stress >"$folder/log" || { cat "$folder/log" >&2; exit 1; }
  tail -1 "$folder/log"
  echo "$build: the stored bits"
done
