#!/usr/bin/env bash
# Installs the Debian 12 packages that are missing, checks the formatting, builds everything, and
# runs all tests that are not labelled slow. Runs those of several threads once more under
# ThreadSanitizer.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
source cmake/setup.sh

install_packages build mpi python tests benchmarks browser
find . -name build -prune -o \( -name '*.h' -o -name '*.cpp' \) -print0 |
  xargs -0 clang-format --dry-run -Werror
configure_release ON
cmake --build --preset release
ctest --preset release --parallel "$(nproc)"

run_quietly cmake --preset tsan
cmake --build --preset tsan
ctest --preset tsan --parallel "$(nproc)"
