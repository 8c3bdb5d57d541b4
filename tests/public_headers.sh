#!/usr/bin/env bash
# Compiles each public header by itself, with each compiler that is installed, strictly; that of C as C99 too.
#
#   tests/public_headers.sh INCLUDE      INCLUDE: the folder that holds sheaf/*.h
set -euo pipefail
include=$1
flags=(-std=c++20 -Wall -Wextra -Wconversion -Wshadow -Wpedantic -Werror -fsyntax-only -I "$include")
count=0
for compiler in g++ clang++; do
  command -v "$compiler" >/dev/null || { echo "$compiler: left out, not installed" >&2; continue; }
  for header in "$include"/sheaf/*.h; do
    echo "#include <sheaf/$(basename "$header")>" | "$compiler" "${flags[@]}" -x c++ -
    count=$((count + 1))
  done
done
for compiler in gcc clang; do
  command -v "$compiler" >/dev/null || continue
  for standard in c99 c11; do
    echo "#include <sheaf/capi.h>" |
      "$compiler" -std=$standard -Wall -Wextra -Wconversion -Wpedantic -Werror -fsyntax-only -I "$include" -x c -
    count=$((count + 1))
  done
done
[[ $count -gt 0 ]] || { echo "nothing was compiled" >&2; exit 1; }
echo "$count compilations"
