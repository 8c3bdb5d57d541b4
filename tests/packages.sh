#!/usr/bin/env bash
# Builds the Debian packages (src/packaging/build.sh, with lintian), installs them into a root of their own, uses them there and
# removes them.
#
#   tests/packages.sh [BUILD [cmake arguments]]
#
# The root is a Debian of mmdebstrap where that is installed. Without it the packages are unpacked into an empty folder: what
# they hold and what they need is then checked, but no script of theirs runs. tests/packages.sh build/packages-check
# -DCMAKE_CXX_FLAGS="-DHWY_DISABLED_TARGETS=HWY_AVX3_DL+HWY_AVX3+HWY_AVX2+HWY_SSE4 -O1" takes a quarter of the time.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=${1:-build/packages}
src/packaging/build.sh "$build" "${@:2}"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  echo "$*" >&2
  exit 1
}
names=$(for package in "$build"/*.deb; do dpkg-deb --field "$package" Package; done | sort | tr '\n' ' ')
echo "packages: $names"
for name in sheaf libsheaf0.2 libsheaf-dev; do [[ " $names" == *" $name "* ]] || fail "there is no package $name"; done

# Nothing is in two packages, and every one has what it needs.
for package in "$build"/*.deb; do dpkg-deb --fsys-tarfile "$package" | tar -t | grep -v '/$'; done | sort | uniq -d >"$work/twice"
[[ ! -s $work/twice ]] || fail "in two packages: $(cat "$work/twice")"

use='set -e
cd /tmp
sheaf --version
man -w sheaf-render >/dev/null 2>&1 || test -e /usr/share/man/man1/sheaf-render.1.gz
test -e /usr/share/bash-completion/completions/sheaf
sheaf render /usr/share/sheaf/scenes/crystal-ball.json --size 64x48 -q -o ball.png
test -s ball.png
if test -e /usr/lib/python3/dist-packages/sheaf; then
  python3 -c "
import sheaf
scene = sheaf.read_scene(\"/usr/share/sheaf/scenes/crystal-ball.json\")
print(\"Python:\", scene.render(width=32, height=24).shape, sheaf.Geometry([[0,0,0],[1,0,0],[0,1,0]], [[0,1,2]]))"
fi'
if command -v mmdebstrap >/dev/null && [[ $(id -u) -eq 0 ]]; then
  root=$work/root
  mkdir "$root"
  mmdebstrap --variant=apt --quiet "$(. /etc/os-release && echo "$VERSION_CODENAME")" "$root"
  mkdir "$root/packages"
  cp "$build"/*.deb "$root/packages"
  chroot "$root" sh -c 'apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends /packages/*.deb' >"$work/log" 2>&1 ||
    { cat "$work/log" >&2; fail "apt does not install them"; }
  chroot "$root" sh -c "$use"
  # shellcheck disable=SC2086
  chroot "$root" sh -c "dpkg --purge $names" >"$work/log" 2>&1 || { cat "$work/log" >&2; fail "dpkg does not remove them"; }
  left=$(chroot "$root" find / -xdev -name '*sheaf*' -not -path '/packages/*' -not -path '/proc/*' -not -path '/var/*' -not -path '/tmp/*')
  [[ -z $left ]] || fail "left after they were removed: $left"
  echo "installed, used and removed in a root of its own"
else
  for package in "$build"/*.deb; do dpkg-deb --extract "$package" "$work/root"; done
  libraries=$(dirname "$(find "$work/root" -name 'libsheaf.so.0.2')")
  LD_LIBRARY_PATH=$libraries PYTHONPATH=$work/root/usr/lib/python3/dist-packages "$work/root/usr/bin/sheaf" render \
    "$work/root/usr/share/sheaf/scenes/crystal-ball.json" --size 64x48 -q -o "$work/ball.png"
  [[ -s $work/ball.png ]] || fail "no picture was rendered"
  if [[ -d $work/root/usr/lib/python3/dist-packages/sheaf ]]; then
    LD_LIBRARY_PATH=$libraries PYTHONPATH=$work/root/usr/lib/python3/dist-packages /usr/bin/python3 -c \
      'import sheaf; print(sheaf.Geometry([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))'
  fi
  echo "unpacked and used; not installed: no mmdebstrap, or not root"
fi
