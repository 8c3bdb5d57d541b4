#!/bin/bash -eu
# How OSS-Fuzz builds the targets: with its compiler, its flags and its engine, into $OUT.
cd "$SRC/sheaf"
cmake -S . -B "$WORK/build" -G Ninja -DCMAKE_BUILD_TYPE=Dev -DSHEAF_FUZZ=ON -DSHEAF_FUZZ_ENGINE="$LIB_FUZZING_ENGINE" \
  -DSHEAF_BUILD_COMMAND=OFF -DSHEAF_BUILD_BENCH=OFF -DSHEAF_PYTHON=OFF -DSHEAF_INSTALL=OFF
cmake --build "$WORK/build" --parallel "$(nproc)"
for target in "$WORK"/build/tests/fuzz/fuzz_*; do
  [ -x "$target" ] && [ -f "$target" ] || continue
  name=$(basename "$target")
  format=${name#fuzz_}
  cp "$target" "$OUT/"
  [ ! -e "tests/fuzz/dictionaries/$format.dict" ] || cp "tests/fuzz/dictionaries/$format.dict" "$OUT/$name.dict"
  zip -qj "$OUT/${name}_seed_corpus.zip" tests/fuzz/seeds/"$format"/*
done
