#!/usr/bin/env bash
# Installs Sheaf into an empty prefix, moves the prefix, and builds and runs the programs of tests/consumers against it:
# by find_package (a static library and a shared one), by pkg-config, as a plugin, and with Sheaf as a subfolder.
#
#   tests/consumers.sh BUILD      BUILD: a build folder of Sheaf with the static library and the command, all built
#
# Builds the library twice more, for the shared one and the subfolder: with one SIMD target, which is enough to link.
# BUILD/consumers keeps these builds, so that only the first run takes its minute.
set -euo pipefail
build=$(realpath "$1")
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
consumers=$root/tests/consumers
work=$build/consumers
mkdir -p "$work"
trap 'rm -rf "$work"/{prefix,moved}-*' EXIT

# What is run is silent unless it fails.
quietly() {
  "$@" >"$work/log" 2>&1 || { cat "$work/log" >&2; echo "failed: $*" >&2; exit 1; }
}
fail() {
  echo "$*" >&2
  exit 1
}
configure_and_build() { # SOURCE BUILD [cmake arguments]
  quietly cmake -S "$1" -B "$2" -G Ninja "${@:3}"
  quietly cmake --build "$2" --parallel "$(nproc)"
}
# Installs BUILD into an empty prefix and moves that elsewhere; prints the new place.
install_and_move() { # BUILD KIND
  local prefix=$work/prefix-$2 moved=$work/moved-$2
  rm -rf "$prefix" "$moved"
  quietly cmake --install "$1" --prefix "$prefix"
  local headers others
  headers=$(find "$prefix/include/sheaf" -maxdepth 1 -name '*.h' | wc -l)
  others=$(find "$prefix" \( -name '*.h' -o -name '*.hpp' -o -path '*/include/*' \) -type f | wc -l)
  # A dozen of C++, and that of C in its parts.
  [[ $headers -gt 0 && $headers -le 16 && $headers -eq $others ]] ||
    fail "$headers headers in include/sheaf (at most 16), $others in all"
  mv "$prefix" "$moved"
}
one_target=-DHWY_DISABLED_TARGETS=HWY_AVX3_DL+HWY_AVX3+HWY_AVX2+HWY_SSE4

static=$work/moved-static shared=$work/moved-shared
install_and_move "$build" static
echo "installed: $(cd "$static/include" && echo sheaf/*.h)"
configure_and_build "$root" "$work/shared" -DBUILD_SHARED_LIBS=ON -DCMAKE_CXX_FLAGS="$one_target -O0" -DCMAKE_BUILD_TYPE=Plain \
  -DSHEAF_BUILD_COMMAND=OFF -DSHEAF_BUILD_BENCH=OFF -DSHEAF_PYTHON=OFF
install_and_move "$work/shared" shared
library=$(echo "$shared"/lib*/libsheaf.so "$shared"/lib*/*/libsheaf.so | tr ' ' '\n' | grep -v '\*')
readelf -d "$library" | grep -q 'SONAME.*libsheaf\.so\.0\.2' || fail "libsheaf.so has another SONAME"

# It exports what the public headers declare, and nothing of the inside.
names_in() { nm "$@" -C --defined-only 2>/dev/null | sed -nE 's/.* T (sheaf::[A-Za-z:]*[~=A-Za-z]+)\(.*/\1/p' | sort -u; }
names_in -D "$library" >"$work/names"
! grep -E '^sheaf::(simd|scalar)::' "$work/names" || fail "libsheaf.so exports what is inside"
headers=$(sed 's|//.*||' "$shared"/include/sheaf/*.h | awk '/^ private:/ { skip = 1 } /^};/ { skip = 0 } !skip')
count=0
while read -r name; do
  name=${name#sheaf::} owner=
  [[ $name == *::* ]] && owner=${name%::*} && name=${name##*::}
  if [[ -z $owner ]]; then
    grep -qE "^[A-Za-z].*\b$name\(" <<<"$headers" || continue
  else
    grep -qE "^class $owner |^struct $owner " <<<"$headers" && grep -qF " $name(" <<<"$headers" || continue
  fi
  grep -qxF "sheaf::$owner${owner:+::}$name" "$work/names" || fail "libsheaf.so lacks ${owner:+$owner::}$name: SHEAF_API is missing"
  count=$((count + 1))
done < <(names_in "$(find "$static" -name libsheaf.a)")
[[ $count -gt 3 ]] || fail "no public names were found"
echo "libsheaf.so: $count public names"
# Likewise of C: the names of its headers, and no more.
sed 's|//.*||' "$shared"/include/sheaf/capi*.h | tr '\n' ' ' | grep -oE 'SHEAF_API [^(;]*\(' | grep -oE 'sheaf_[a-z_]+\(' |
  tr -d '(' | sort >"$work/names"
nm -D --defined-only "$library" | sed -nE 's/.* T (sheaf_[a-z_]+)$/\1/p' | sort | diff "$work/names" - ||
  fail "<sheaf/capi.h> and libsheaf.so differ in names"
echo "libsheaf.so: $(wc -l <"$work/names") names of C"

for kind in static shared; do
  program=$work/find_package-$kind
  rm -rf "$program"
  configure_and_build "$consumers/find_package" "$program" -DCMAKE_PREFIX_PATH="$work/moved-$kind" -DKIND=$kind
  echo "find_package, $kind: $("$program/program")"
done

for kind in static shared; do
  pkg_config=(pkg-config)
  [[ $kind == static ]] && pkg_config+=(--static)
  folder=$(dirname "$(find "$work/moved-$kind" -name sheaf.pc)")
  flags=$(PKG_CONFIG_PATH=$folder "${pkg_config[@]}" --cflags --libs 'sheaf >= 0.2')
  # shellcheck disable=SC2086
  quietly "${CXX:-c++}" -std=c++20 -I "$consumers" "$consumers/program.cc" -o "$work/program-$kind" $flags
  echo "pkg-config, $kind: $(LD_LIBRARY_PATH=$folder/.. "$work/program-$kind")"
  # shellcheck disable=SC2086
  quietly "${CC:-cc}" -std=c99 -Wall -Wextra -Wpedantic -Werror "$root/docs/trace_rays.c" -o "$work/c-program-$kind" $flags
  echo "C by pkg-config, $kind: $(LD_LIBRARY_PATH=$folder/.. "$work/c-program-$kind")"
done

rm -rf "$work/plugin"
configure_and_build "$consumers/plugin" "$work/plugin" -DCMAKE_PREFIX_PATH="$static"
echo "plugin: $("$work/plugin/host" "$work/plugin/libplugin.so")"
nm -DC --defined-only "$work/plugin/libplugin.so" >"$work/names"
! grep -E ' sheaf::(Render\(|simd|scalar)' "$work/names" || fail "the plugin re-exports the library"

configure_and_build "$consumers/add_subdirectory" "$work/add_subdirectory" -DCMAKE_CXX_FLAGS="$one_target"
grep -q -- '-O3.*render\.cc' "$work/add_subdirectory/compile_commands.json" || fail "a subfolder's library is not optimised"
echo "add_subdirectory: $("$work/add_subdirectory/program")"
