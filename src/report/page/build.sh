#!/usr/bin/env bash
# Builds page.html, which becomes part of the program, from the sources in this folder. Needs node and
# npm, and the network for the packages of package-lock.json, which go to build/report-page.
#
#   src/report/page/build.sh             writes page.html
#   src/report/page/build.sh --check     exit code 1 if page.html is not what the sources build, and
#                                        77 where npm is missing or cannot get the packages
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
modules=${NEEDLEWORK_MODULES:-$here/../../../build/report-page}

source "$here/../../../cmake/npm.sh"

install_npm_packages "$here" "$modules"
export NEEDLEWORK_MODULES=$modules
if [[ ${1:-} != --check ]]; then
  node "$here/build.js" "$here/page.html"
  exit
fi
node "$here/build.js" "$modules/page.html"
if ! cmp "$modules/page.html" "$here/page.html"; then
  echo "page.html is not what its sources build: run src/report/page/build.sh and commit it"
  exit 1
fi
echo "page.html is what its sources build"
