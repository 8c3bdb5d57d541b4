#!/usr/bin/env bash
# Builds without optimisation, runs the tests, and reports which lines of src/ and simd/ they run.
#
#   tests/coverage.sh [ctest arguments]      for example: tests/coverage.sh -R formats
#
# build/coverage/coverage.html has the lines. With one SIMD target, the lowest but one-lane code, and assertions on: a line counts
# once, whatever targets it is compiled for. Needs gcovr and g++.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

command -v gcovr >/dev/null || { echo "please install gcovr" >&2; exit 1; }
build=build/coverage
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Plain \
  -DCMAKE_CXX_FLAGS='-O1 --coverage -fprofile-update=atomic' -DCMAKE_EXE_LINKER_FLAGS=--coverage
cmake --build "$build" --parallel "$(nproc)"
find "$build" -name '*.gcda' -delete
ctest --test-dir "$build" --output-on-failure --parallel "$(nproc)" -E '^(consumers|public_headers|style|frame_scenes_test)$' "$@"
gcovr --root . --object-directory "$build" --filter src/ --filter simd/ --gcov-ignore-parse-errors \
  --exclude-unreachable-branches --html-details "$build/coverage.html" --txt "$build/coverage.txt" --print-summary
