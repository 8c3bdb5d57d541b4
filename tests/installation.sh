#!/usr/bin/env bash
# Installs a build into an empty prefix, looks whether everything is there, and removes it again.
#
#   tests/installation.sh BUILD      BUILD: a build folder of Sheaf with the command, all built
set -euo pipefail
build=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=$work/prefix
fail() {
  echo "$*" >&2
  exit 1
}
cmake --install "$build" --prefix "$prefix" >"$work/log" 2>&1 || { cat "$work/log" >&2; fail "it does not install"; }

sheaf=$prefix/bin/sheaf
"$sheaf" --version
for name in $("$sheaf" completion bash | sed -nE "s/.*compgen -W '(.*) --help --version'.*/\1/p"); do
  [[ -s $prefix/share/man/man1/sheaf-$name.1 ]] || fail "there is no man page of $name"
done
[[ -s $prefix/share/man/man1/sheaf.1 ]] || fail "there is no man page"
"$sheaf" completion bash | cmp - "$prefix/share/bash-completion/completions/sheaf"
"$sheaf" completion zsh | cmp - "$(find "$prefix/share/zsh" -name _sheaf)"
grep -q 'Apache License' "$prefix/share/doc/sheaf/LICENSE" || fail "there is no licence"
[[ -s $prefix/share/doc/sheaf/docs/command.md && -s $prefix/share/doc/sheaf/CHANGELOG.md ]] || fail "there is no documentation"
"$sheaf" render "$prefix/share/sheaf/scenes/crystal-ball.json" --size 32x24 -q -o "$work/ball.png"

# Every part that is named has a version, and every relation two ends.
python3 - "$prefix/share/doc/sheaf/sheaf.spdx.json" <<'END'
import json
import sys

bill = json.load(open(sys.argv[1]))
assert bill["spdxVersion"] == "SPDX-2.3" and bill["creationInfo"]["created"].endswith("Z")
names = {package["SPDXID"]: package for package in bill["packages"]} | {"SPDXRef-DOCUMENT": None}
assert len(names) == len(bill["packages"]) + 1 > 8
assert all(package["versionInfo"] != "NOASSERTION" for package in bill["packages"])
assert all(r["spdxElementId"] in names and r["relatedSpdxElement"] in names for r in bill["relationships"])
print(len(bill["packages"]), "parts in the bill of materials")
END

# Somebody else's file in a shared folder stays.
touch "$prefix/bin/other"
count=$(find "$prefix" -type f -o -type l | wc -l)
[[ $count -gt 30 ]] || fail "only $count files were installed"
cmake --build "$build" --target uninstall >"$work/log" 2>&1 || { cat "$work/log" >&2; fail "it does not uninstall"; }
left=$(find "$prefix" -type f -o -type l -o -name sheaf)
[[ $left == "$prefix/bin/other" ]] || fail "left after uninstalling: $left"
echo "$((count - 1)) files installed and removed"
