#!/usr/bin/env bash
# Installs the packages of Debian 12 or 13 that are missing, builds the program and its tests, and runs
# all but those that .ci/run adds and those that take hours.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
source cmake/setup.sh

echo "Building the program and its tests and running them takes ten minutes of two cores, less after"
echo "the first time; installing packages comes first."
install_packages build mpi python tests
configure_release ON
cmake --build --preset release
run_tests release
