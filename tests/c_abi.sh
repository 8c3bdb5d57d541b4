#!/usr/bin/env bash
# Compares the binary interface of <sheaf/capi.h>, its functions and the types that they take, with the one that is stored.
#
#   tests/c_abi.sh [--store]
#
# New functions are no difference; anything else is: a function that goes away, a structure whose members change. A member
# that is added to the end of a structure with a size is allowed by the header's rules: store the new interface then, with
# --store, and say so in CHANGELOG.md. Exits with 77 where abidw and abidiff (Debian: abigail-tools) are not installed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
stored=tests/abi/capi-$(uname -m).abi

if ! command -v abidw >/dev/null || ! command -v abidiff >/dev/null; then
  echo "skipped: no abigail-tools" >&2
  exit 77
fi
if [[ ! -e $stored && ${1:-} != --store ]]; then
  echo "skipped: no interface is stored for $(uname -m)" >&2
  exit 77
fi

# What the header declares, with bodies that do nothing: a library of the interface alone. (That libsheaf.so has the same
# functions is shown by its own build, which includes the header, and by tests/consumers.sh.)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
{
  echo '#include "sheaf/capi.h"'
  echo '#include <stdlib.h>'
  sed 's|//.*||' src/sheaf/capi*.h | tr '\n' ' ' | grep -oE 'SHEAF_API [^;]*;' | sed 's/^SHEAF_API //; s/;$/ { abort(); }/'
} >"$work/interface.c"
"${CC:-cc}" -std=c99 -g -O0 -fPIC -shared -I src "$work/interface.c" -o "$work/libinterface.so"
abidw --no-corpus-path --no-show-locs --no-comp-dir-path --type-id-style hash "$work/libinterface.so" >"$work/now.abi"
functions=$(grep -c '<elf-symbol name=.sheaf_' "$work/now.abi" || true)
[[ $functions -gt 20 ]] || { echo "only $functions functions were found" >&2; exit 1; }

if [[ ${1:-} == --store ]]; then
  mkdir -p tests/abi
  cp "$work/now.abi" "$stored"
  echo "stored: $functions functions in $stored"
  exit
fi
abidiff --no-added-syms "$stored" "$work/now.abi"
echo "$functions functions, as they are stored"
