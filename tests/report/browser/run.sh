#!/usr/bin/env bash
# Tests pages of `needlework report` in Debian's Chromium: run.sh PROGRAM FOLDER. FOLDER keeps what npm
# installs. Exit code 77, with the reason, where there is no Chromium, no npm or no network.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=$(realpath "$1")
folder=$2

skip() {
  echo "$1: pages are not tested in a browser"
  exit 77
}

for needed in node npm; do
  command -v "$needed" >/dev/null || skip "There is no $needed"
done
chromium=$(command -v chromium) || skip "There is no chromium"
mkdir -p "$folder"
if ! cmp -s "$here/package-lock.json" "$folder/package-lock.json" || [[ ! -d $folder/node_modules ]]; then
  cp "$here/package.json" "$here/package-lock.json" "$folder/"
  if ! npm ci --prefix "$folder" --no-audit --no-fund >"$folder/npm.log" 2>&1; then
    cat "$folder/npm.log"
    rm -rf "$folder/node_modules" "$folder/package-lock.json"
    skip "npm cannot install playwright-core"
  fi
fi
cp "$here"/*.js "$folder/"
NEEDLEWORK_PROGRAM=$program CHROMIUM=$chromium exec node --test --test-reporter=spec "$folder/page.test.js"
