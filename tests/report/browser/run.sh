#!/usr/bin/env bash
# Tests pages of `needlework report` in Debian's Chromium: run.sh PROGRAM FOLDER. FOLDER keeps what npm
# installs. Exit code 77, with the reason, where there is no Chromium, no npm or no network.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=$(realpath "$1")
folder=$2

source "$here/../../../cmake/npm.sh"

chromium=$(command -v chromium) || skip "There is no chromium."
install_npm_packages "$here" "$folder"
cp "$here"/*.js "$folder/"
NEEDLEWORK_PROGRAM=$program CHROMIUM=$chromium exec node --test --test-reporter=spec "$folder/page.test.js"
