# Sourced by scripts that need packages of npm.

# skip REASON: ends the script with the exit code of a test that is skipped.
skip() {
  echo "$1"
  exit 77
}

# install_npm_packages FROM TO: what package-lock.json of folder FROM names, into TO/node_modules.
# Skips where there is no node or npm, or where npm cannot get the packages.
install_npm_packages() {
  local from=$1 to=$2 program
  for program in node npm; do
    command -v "$program" >/dev/null || skip "There is no $program."
  done
  mkdir -p "$to"
  if cmp -s "$from/package-lock.json" "$to/package-lock.json" && [[ -d $to/node_modules ]]; then
    return
  fi
  cp "$from/package.json" "$from/package-lock.json" "$to/"
  if ! npm ci --prefix "$to" --no-audit --no-fund >"$to/npm.log" 2>&1; then
    cat "$to/npm.log"
    rm -rf "$to/node_modules" "$to/package-lock.json"
    skip "npm cannot install the packages of $from."
  fi
}
