#!/usr/bin/env bash
# Installs what is missing, builds the release preset, and renders the crystal ball's seven views
# into out/. Arguments go on to `sheaf render`, for example: scenes/render.sh --size 1280x960
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tests/install-packages.sh
cmake --preset release
cmake --build --preset release --parallel "$(nproc)" --target sheaf

mkdir -p out
cameras=(--views seven)
for argument in "$@"; do
  [[ $argument == --camera* || $argument == --views* ]] && cameras=()
done
build/release/sheaf render scenes/crystal-ball.json "${cameras[@]}" -o 'out/{camera}.png' "$@"
echo "The pictures are in $PWD/out"
