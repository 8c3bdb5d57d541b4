#!/usr/bin/env bash
# Builds the Debian packages, and has lintian check them where it is installed.
#
#   src/packaging/build.sh [BUILD [cmake arguments]]      BUILD: build/packages by default; the packages are in BUILD itself
#
# Install them by name and path: apt install ./build/packages/*.deb
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
build=${1:-build/packages}

# The time that the packages bear: that of what they are made of.
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || date +%s)}
export SOURCE_DATE_EPOCH
libraries=lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH 2>/dev/null || gcc -print-multiarch)
cmake -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DCMAKE_INSTALL_LIBDIR="$libraries" \
  -DCMAKE_SKIP_INSTALL_RPATH=ON -DBUILD_SHARED_LIBS=ON -DSHEAF_BUILD_TESTS=OFF -DSHEAF_BUILD_BENCH=OFF -DSHEAF_DEBIAN=ON \
  -DCMAKE_SHARED_LINKER_FLAGS="-Wl,-z,relro,-z,now" -DCMAKE_MODULE_LINKER_FLAGS="-Wl,-z,relro,-z,now" \
  -DCMAKE_EXE_LINKER_FLAGS="-Wl,-z,relro,-z,now -pie" "${@:2}"
cmake --build "$build" --parallel "$(nproc)"
rm -f "$build"/*.deb
(umask 022 && cd "$build" && cpack -G DEB)

# CPack writes scripts that call ldconfig. Debian's policy (8.1.1) wants a trigger instead, which the library's package has.
unpacked=$(mktemp -d)
trap 'rm -rf "$unpacked"' EXIT
for package in "$build"/*.deb; do
  dpkg-deb --ctrl-tarfile "$package" | tar -t | grep -qx ./postrm || continue
  rm -rf "${unpacked:?}/root"
  dpkg-deb --raw-extract "$package" "$unpacked/root"
  for script in postinst postrm; do
    grep -q ldconfig "$unpacked/root/DEBIAN/$script" && rm "$unpacked/root/DEBIAN/$script"
  done
  dpkg-deb --root-owner-group -Zxz --build "$unpacked/root" "$package" >/dev/null
done
if command -v lintian >/dev/null; then
  lintian --fail-on error,warning --tag-display-limit 0 "$build"/*.deb
else
  echo "no lintian: the packages are not checked" >&2
fi
