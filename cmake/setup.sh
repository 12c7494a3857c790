# Set-up shared by the scripts: installs what is missing and configures the release build. Sourced
# with bash, in the root of the project.

# Prints the packages of packages.txt that are not installed.
missing_packages() {
  local package
  while read -r package; do
    dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null |
      grep -qx installed || echo "$package"
  done < <(grep -v '^#' packages.txt)
}

# Installs with apt-get, as root or through sudo; reads the package lists anew only if it has to.
install_packages() {
  local missing as_root=() apt_get
  if ! command -v apt-get >/dev/null; then
    echo "There is no apt-get here: expecting what packages.txt names to be installed." >&2
    return
  fi
  mapfile -t missing < <(missing_packages)
  ((${#missing[@]})) || return 0
  if ((EUID != 0)); then
    if ! command -v sudo >/dev/null; then
      echo "Packages are missing; as root: apt-get install ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  apt_get=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get --yes --quiet)
  local install=(install --no-install-recommends "${missing[@]}")
  if ! apt-get --simulate "${install[@]}" >/dev/null 2>&1 || ! "${apt_get[@]}" "${install[@]}"; then
    "${apt_get[@]}" update
    "${apt_get[@]}" "${install[@]}"
  fi
}

# configure_release ON|OFF: with or without tests and benchmarks. `cmake --build --preset release` builds.
configure_release() {
  cmake --preset release -DNEEDLEWORK_TESTS="$1" -DNEEDLEWORK_BENCH="$1"
}
