#!/usr/bin/env bash
# Runs the tests of the Python package: those of tests/python, the types of the package by mypy where it is installed, and
# the example of docs/python.md.
#
#   tests/python_test.sh PYTHON BUILD      BUILD: a build folder, whose python/ holds the package
#
# Exits with 77 where pytest is not installed.
set -euo pipefail
python=$1 build=$2
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
export PYTHONPATH=$build/python PYTHONDONTWRITEBYTECODE=1 SHEAF_COMMAND=$build/sheaf
"$python" -c 'import pytest' 2>/dev/null || { echo "skipped: no pytest for $python" >&2; exit 77; }
"$python" -m pytest -q -p no:cacheprovider "$root/tests/python"
if "$python" -c 'import mypy' 2>/dev/null; then
  "$python" -m mypy --strict --cache-dir=/dev/null "$root/src/python/sheaf"
else
  echo "types are not checked: no mypy for $python" >&2
fi
