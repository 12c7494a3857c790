#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds, and lets a first gas of needles cool.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
source cmake/setup.sh

install_packages
configure_release OFF
cmake --build --preset release
echo
build/release/needlework run profiles/quickstart.toml --out build/quickstart.h5 --force
