#!/usr/bin/env bash
# Installs the packages of Debian 12 or 13 that are missing, builds the program, and runs a first scene.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
source cmake/setup.sh

install_packages build
echo "Building needlework, which takes some minutes."
configure_release OFF
cmake --build --preset release
build/release/needlework --version
echo
build/release/needlework run profiles/quickstart.toml --out build/quickstart.h5 --force
cat <<'NEXT'

That run is in build/quickstart.h5. Next, look at it in a browser:
  build/release/needlework report build/quickstart.h5 -o build/quickstart.html
or write a scene of your own: README.md, "Your own scene".
NEXT
