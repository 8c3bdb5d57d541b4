#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test.
#
#   tests/run.sh [PRESET] [ctest arguments]
#
# PRESET is dev (the default: optimised, assertions on, warnings are errors), release, asan or tsan.
# Exits with ctest's code. For example: tests/run.sh asan -R picture
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset=dev
if [[ $# -gt 0 && $1 != -* ]]; then
  preset=$1
  shift
fi

tests/install-packages.sh
cmake --preset "$preset"
cmake --build --preset "$preset" --parallel "$(nproc)"
exec ctest --preset "$preset" --parallel "$(nproc)" "$@"
