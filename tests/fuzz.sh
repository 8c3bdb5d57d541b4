#!/usr/bin/env bash
# Fuzzes each reader, the C API and the traversals: tests/fuzz.sh MINUTES [TARGET ...]. What is found
# of new ways is kept in build/fuzz/corpus, what fails in build/fuzz/found. Stops at the first failure.
# SHEAF_FUZZ_SECONDS=N in place of MINUTES makes a short run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

minutes=${1:-1}
shift || true
seconds=${SHEAF_FUZZ_SECONDS:-$((60 * minutes))}
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
  targets=(json nff obj ply gltf glb png pfm exr texture c_api differential)
fi

cmake --preset fuzz > /dev/null
cmake --build --preset fuzz --parallel "$(nproc)" --target "${targets[@]/#/fuzz_}"
mkdir -p build/fuzz/found
for target in "${targets[@]}"; do
  corpus=build/fuzz/corpus/$target
  mkdir -p "$corpus"
  dictionary=tests/fuzz/dictionaries/$target.dict
  options=(-max_total_time="$seconds" -rss_limit_mb=2048 -malloc_limit_mb=1024 -timeout=20 -print_final_stats=1
    -artifact_prefix="build/fuzz/found/$target-" -verbosity=0)
  if [ -e "$dictionary" ]; then options+=(-dict="$dictionary"); fi
  echo "fuzz_$target, $seconds s"
  build/fuzz/tests/fuzz/fuzz_"$target" "${options[@]}" "$corpus" tests/fuzz/seeds/"$target" 2>&1 |
    tee build/fuzz/found/"$target".log | grep -E "^stat::number_of_executed|^found:|ERROR|SUMMARY|runtime error" || true
  [ "${PIPESTATUS[0]}" -eq 0 ] || { tail -40 build/fuzz/found/"$target".log; exit 1; }
done
