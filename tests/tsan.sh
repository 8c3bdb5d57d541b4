#!/usr/bin/env bash
# What runs on several threads, under the thread sanitizer, where plain threads stand in for oneTBB
# (tests/tsan/plain_threads.h): tests/tsan.sh [ctest arguments]. A race is a failed test.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Of the others the threads are those of these, and their pictures take many minutes.
tests='bvh|c_api|cluster|denoise|geometry|hit_points|instances|misuse|picture_file|queries|render_options|renderer|update|update_meshes|view'
cmake --preset tsan
mapfile -t targets < <(ctest --preset tsan -N -R "^($tests)_test$" | sed -n 's/.*Test *#[0-9]*: \(.*_test\)$/\1/p')
cmake --build --preset tsan --parallel "$(nproc)" --target sheaf bands_test "${targets[@]}"
# The first report ends a process. A test forks while threads run.
export TSAN_OPTIONS="halt_on_error=1 die_after_fork=0 ${TSAN_OPTIONS:-}"
# How a band goes to its sink while the next renders, without the pictures that take minutes.
build/tsan/tests/bands_test --test-case="a sink*,after a stop*,what a sink*"
ctest --preset tsan --parallel "$(nproc)" -R "^($tests)_test$" "$@"
