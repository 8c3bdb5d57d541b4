#!/usr/bin/env bash
# Installs the Debian packages that are missing. Usage: install-packages.sh [more packages]
#
# Quick and silent when nothing is missing: then apt is never asked.
set -euo pipefail

packages=(
  g++ cmake ninja-build
  libhwy-dev libglm-dev libtbb-dev libbenchmark-dev doctest-dev
  nlohmann-json3-dev libcli11-dev libfmt-dev libpng-dev pkg-config
  libtinygltf-dev libturbojpeg0-dev libopenexr-dev libassimp-dev assimp-testmodels
  python3-dev python3-numpy pybind11-dev
  "$@"
)

if ! command -v dpkg-query >/dev/null; then
  echo "This is no Debian; please install these or their like: ${packages[*]}" >&2
  exit 0 # CMake will name what it does not find
fi

architecture=$(dpkg --print-architecture)
missing=()
for package in "${packages[@]}"; do
  # A line an architecture: another one's library does not count.
  status=$(dpkg-query --show --showformat='${db:Status-Status} ${Architecture}\n' "$package" 2>/dev/null || true)
  grep -qxE "installed (all|$architecture)" <<<"$status" || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

as_root=()
if [[ $(id -u) -ne 0 ]]; then
  if ! command -v sudo >/dev/null; then
    echo "Please install as root: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "Installing with apt-get: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -qq --no-install-recommends "${missing[@]}"
