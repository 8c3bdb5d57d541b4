#!/usr/bin/env bash
# Builds for 64-bit Arm with Debian's cross compiler, renders the crystal ball under emulation, and
# compares every bit with this machine's own pictures; then runs the stress cases there.
#
#   tests/aarch64.sh
#
# Needs, once, on x86-64:
#   dpkg --add-architecture arm64 && apt-get update
#   apt-get install g++-aarch64-linux-gnu qemu-user-static \
#       libhwy-dev:arm64 libtbb-dev:arm64 libpng-dev:arm64 libfmt-dev:arm64 \
#       libtinygltf-dev:arm64 libturbojpeg0-dev:arm64
# Where that is not installed it says so and exits with 77, as a skipped test does.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

for tool in aarch64-linux-gnu-g++ qemu-aarch64-static; do
  command -v "$tool" >/dev/null || { echo "skipped: no $tool" >&2; exit 77; }
done
for library in libhwy libtinygltf libturbojpeg; do
  if ! compgen -G "/usr/lib/aarch64-linux-gnu/$library.*" >/dev/null; then
    echo "skipped: no $library for arm64" >&2
    exit 77
  fi
done

PKG_CONFIG_LIBDIR=/usr/lib/aarch64-linux-gnu/pkgconfig cmake -S . -B build/aarch64 -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 \
  -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++ -DCMAKE_LIBRARY_ARCHITECTURE=aarch64-linux-gnu \
  -DSHEAF_BUILD_TESTS=OFF -DSHEAF_BUILD_BENCH=OFF
cmake --build build/aarch64 --parallel "$(nproc)" --target sheaf
cmake --preset release
cmake --build --preset release --parallel "$(nproc)" --target sheaf

arm=(qemu-aarch64-static build/aarch64/sheaf)
"${arm[@]}" info
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
render=(render scenes/crystal-ball.json --views seven --size 160x120 -q)
build/release/sheaf "${render[@]}" -o "$folder/{camera}.pfm"
"${arm[@]}" "${render[@]}" -o "$folder/{camera}-arm.pfm"
for camera in front up down left right near far; do
  cmp "$folder/$camera.pfm" "$folder/$camera-arm.pfm"
  echo "$camera: the same bits as on this machine"
done
"${arm[@]}" compare scenes/crystal-ball.json --views seven --size 160x120 --threads 1,2
"${arm[@]}" stress
