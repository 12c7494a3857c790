#!/usr/bin/env bash
# Installs the Debian 12 packages that are missing, builds the program, and runs a first scene.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
source cmake/setup.sh

install_packages build
echo "Building needlework, which takes some minutes."
configure_release OFF
cmake --build --preset release
if [[ ! -d build/release/python ]]; then
  echo "Without the Python package, which needs section [python] of packages.txt (docs/python.md)."
fi
echo
build/release/needlework run profiles/quickstart.toml --out build/quickstart.h5 --force
