#!/usr/bin/env bash
# Builds the site of the documentation, whose links must lead somewhere, and runs what the tutorials show: their commands, and
# their programs, whose output must be what the page says.
#
#   tests/docs.sh BUILD      BUILD: a build folder with the command and the tests
#
# Exits with 77, after the tutorials, where MkDocs or Doxygen are not installed.
set -euo pipefail
build=$(realpath "$1")
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export PATH=$build:$PATH

blocks() { "$root/docs/site/code_blocks.awk" -v language="$1" "$page"; }

# The pieces of a language on a page are one program.
ran=0
for page in "$root"/docs/tutorials/*.md; do
  name=$(basename "$page" .md)
  mkdir "$work/$name"
  cd "$work/$name"
  cp "$root/scenes/crystal-ball.json" .
  blocks sh >commands.sh
  if [[ -s commands.sh ]]; then
    bash -euo pipefail commands.sh >commands.log 2>&1 || { cat commands.log; echo "$name: a command fails" >&2; exit 1; }
    ran=$((ran + 1))
  fi
  blocks output >want
  if [[ -n $(blocks cpp) ]]; then
    "$build/tests/tutorial_${name//-/_}" | diff want - || { echo "$name: another output than the page's" >&2; exit 1; }
    ran=$((ran + 1))
  fi
  blocks c >peer.c
  if [[ -s peer.c && -e /usr/include/embree3/rtcore.h ]]; then
    "${CC:-cc}" -std=c99 -Wall -Wextra -Werror peer.c -lembree3 -lm -o peer
    ./peer | diff want - || { echo "$name: Embree's output is another than the page's" >&2; exit 1; }
    ran=$((ran + 1))
  fi
done
[[ $ran -ge 4 ]] || { echo "only $ran pieces were found in the tutorials" >&2; exit 1; }
echo "tutorials: $ran programs and lists of commands"
"$root/docs/build.sh"
