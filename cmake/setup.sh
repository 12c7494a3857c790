# What quickstart.sh, test.sh and .ci/run share: they install what is missing and configure the
# release build. Sourced with bash, in the root of the project.

# Prints the names of all installed packages, and of those that they provide: nodejs of other sources
# than Debian provides npm, which cannot be installed beside it.
installed_packages() {
  dpkg-query --show --showformat='${db:Status-Status} ${Package}, ${Provides}\n' 2>/dev/null |
    sed -n 's/^installed //p' | tr ',' '\n' | awk '{ print $1 }'
}

# Prints the packages that packages.txt names in these sections and that are not installed.
missing_packages() {
  local section line installed
  installed=$(installed_packages)
  while read -r line; do
    case $line in
      '' | '#'*) ;;
      '['*']') section=${line:1:-1} ;;
      *)
        [[ " $* " == *" $section "* ]] || continue
        grep -qxF -- "$line" <<<"$installed" || echo "$line"
        ;;
    esac
  done <packages.txt
}

# run_quietly COMMAND...: shows what the command prints only when it fails.
run_quietly() {
  local log status=0
  log=$(mktemp)
  "$@" >"$log" 2>&1 </dev/null || status=$?
  if ((status)); then
    cat "$log" >&2
    echo "This command failed: $*" >&2
  fi
  rm "$log"
  return "$status"
}

# install_packages SECTION...: installs with apt-get, as root or through sudo. The lists of packages
# are updated only if they lack one.
install_packages() {
  local missing as_root=()
  if ! command -v apt-get >/dev/null; then
    echo "There is no apt-get here. What packages.txt names has to be installed already." >&2
    return 0
  fi
  mapfile -t missing < <(missing_packages "$@")
  ((${#missing[@]})) || return 0
  if ((EUID != 0)); then
    as_root=(sudo)
    # Asks for the password now, when it can be seen.
    if ! command -v sudo >/dev/null || ! sudo true; then
      echo "Packages are missing, and only root can install them. Run as root, then try again:" >&2
      echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
      return 1
    fi
  fi
  local apt_get=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get --yes)
  local install=(install --no-install-recommends "${missing[@]}")
  echo "Installing ${#missing[@]} packages and what they need: ${missing[*]}"
  if ! apt-get --simulate "${install[@]}" >/dev/null 2>&1; then
    run_quietly "${apt_get[@]}" update
  fi
  # A list that is too old names files that are no longer there.
  "${apt_get[@]}" "${install[@]}" >/dev/null 2>&1 </dev/null && return
  run_quietly "${apt_get[@]}" update
  run_quietly "${apt_get[@]}" "${install[@]}" && return
  # One that fails alone is the reason; the others are installed meanwhile.
  local package failed=()
  for package in "${missing[@]}"; do
    "${apt_get[@]}" install --no-install-recommends "$package" >/dev/null 2>&1 </dev/null ||
      failed+=("$package")
  done
  ((${#failed[@]})) || return 0
  echo "These packages cannot be installed: ${failed[*]}" >&2
  return 1
}

# configure_release ON|OFF [ON|OFF]: with or without tests, with or without benchmarks (without).
configure_release() {
  run_quietly cmake --preset release -DNEEDLEWORK_TESTS="$1" -DNEEDLEWORK_BENCH="${2:-OFF}"
}

# Prints the name of clang-format 14: other versions format otherwise. Fails if it is not installed.
find_clang_format() {
  local program
  for program in clang-format-14 clang-format; do
    if [[ $("$program" --version 2>/dev/null) == *" version 14."* ]]; then
      echo "$program"
      return
    fi
  done
  return 1
}

# run_tests PRESET: runs the tests of a preset of ctest on all cores. Shows where it is, in one line on
# a terminal and otherwise at each tenth, and the tests that fail.
run_tests() {
  local ctest=(ctest --preset "$1" --parallel "$(nproc)")
  if [[ -t 1 ]]; then
    "${ctest[@]}" --progress
    return
  fi
  "${ctest[@]}" | awk '
    /^ *Start +[0-9]+: / { next }
    match($0, /^ *[0-9]+\/[0-9]+ Test /) {
      split(substr($0, RSTART, RLENGTH), part, /[\/ ]+/)
      done = part[1] == "" ? part[2] : part[1]
      all = part[1] == "" ? part[3] : part[2]
      if (int(10 * done / all) > tenth) {
        tenth = int(10 * done / all)
        printf "%d of %d tests have run.\n", done, all
        fflush()
      }
      if (/ Passed +[0-9.]+ sec$/) next
    }
    { print; fflush() }'
}
