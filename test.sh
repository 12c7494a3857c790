#!/usr/bin/env bash
# Installs the Debian 12 packages that are missing, checks the formatting, builds everything, and
# runs all tests but those that .ci/run adds and those that take hours.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
source cmake/setup.sh

install_packages build mpi python tests benchmarks
find . -name build -prune -o \( -name '*.h' -o -name '*.cpp' \) -print0 |
  xargs -0 clang-format --dry-run -Werror
configure_release ON
cmake --build --preset release
ctest --preset release --parallel "$(nproc)"
