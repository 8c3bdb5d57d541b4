#!/usr/bin/env bash
# What runs on several threads, under the thread sanitizer: tests/tsan.sh [ctest arguments]. Plain threads
# stand in for oneTBB (tests/tsan/plain_threads.h). A race is a failed test.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Others run their work on one thread, or on these paths.
tests='adaptive|bands|bvh|c_api|cluster|denoise|geometry|held_rays|hit_points|instances|misuse|picture_file|placed_groups|queries|render_options|renderer|resume|update|update_meshes|view'
cmake --preset tsan
mapfile -t targets < <(ctest --preset tsan -N -R "^($tests)_test$" | sed -n 's/.*Test *#[0-9]*: \(.*_test\)$/\1/p')
cmake --build --preset tsan --parallel "$(nproc)" --target sheaf "${targets[@]}"
# The first report ends a process; children that a test forks and kills leave threads behind.
export TSAN_OPTIONS="halt_on_error=1 die_after_fork=0 ${TSAN_OPTIONS:-}"
ctest --preset tsan --parallel "$(nproc)" -R "^($tests)_test$" "$@"
