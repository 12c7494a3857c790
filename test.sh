#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds with tests, and runs them, all but those called slow;
# those of several threads once more under ThreadSanitizer.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
source cmake/setup.sh

install_packages
configure_release ON
cmake --build --preset release
ctest --preset release --parallel "$(nproc)"

cmake --preset tsan
cmake --build --preset tsan
ctest --preset tsan --parallel "$(nproc)"
