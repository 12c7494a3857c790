#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds with tests, and runs them, all but those called slow.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
source cmake/setup.sh

install_packages
configure_release ON
cmake --build --preset release
ctest --preset release --parallel "$(nproc)"
