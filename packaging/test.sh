#!/usr/bin/env bash
# Tests what a release consists of, each in a bare root of a Debian:
#
#   packaging/test.sh bookworm|trixie [PART...]
#
# As root, with debootstrap. PART is one of these; without any, all but the last in this order, of a new
# archive of the last commit:
#
#   source   the archive without git and npm: quickstart.sh, as the container does it, cmake --install,
#            the C++ program of the README by find_package, one in C by pkg-config
#   tests    some tests of the archive, built without git; after `source`
#   build    packages and wheel, which go to dist/SUITE/; after `source`
#   debian   the packages
#   wheel    the wheel in a virtual environment with nothing but pip, and NumPy from PyPI, or that of
#            Debian where PyPI cannot be reached
#   suite    all of ./test.sh in the archive, which takes an hour; after `tests`
#
# Each runs the scene of the README, whose trajectory must be that of packaging/first-run.hash, and is
# uninstalled; then no file may be left that was not there before. Roots are made below
# NEEDLEWORK_ROOTS (/var/tmp/needlework-roots); with CCACHE_DIR, compilations are kept there.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
project=$PWD
suite=${1:?expected a suite of Debian: bookworm or trixie}
shift
parts=("$@")
roots=${NEEDLEWORK_ROOTS:-/var/tmp/needlework-roots}
dist=$project/dist/$suite
mkdir -p "$roots" "$dist"

say() { printf '\n== %s: %s\n' "$suite" "$*"; }

fail() {
  echo "$suite: $*" >&2
  exit 1
}

# bare NAME: a new root with what debootstrap installs, and the archive of the sources in it.
bare() {
  root=$roots/$suite-$1
  rm -rf "$root"
  if [[ ! -f $roots/$suite.tar ]]; then
    debootstrap --variant=minbase "$suite" "$root" >"$roots/$suite.log"
    tar -C "$root" -cf "$roots/$suite.tar" .
  else
    mkdir "$root"
    tar -C "$root" -xf "$roots/$suite.tar"
  fi
  cp /etc/resolv.conf "$root/etc/"
  mkdir "$root/release"
  cp "$archive" "$root/release/"
  from_archive packaging/first-run.hash >"$root/release/first-run.hash"
  # The scene and the programs of the README.
  local language
  for language in toml cpp cmake; do
    from_archive README.md | sed -n "/^\`\`\`$language\$/,/^\`\`\`\$/{//!p}" \
      >"$root/release/readme.$language"
  done
  inside 'apt-get update'
}

from_archive() { tar -xOf "$archive" --wildcards "needlework-*/$1"; }

# inside COMMAND: runs it in the root as root, with nothing of the environment outside.
inside() {
  local compiler=() cache=""
  if [[ -n ${CCACHE_DIR:-} && -x $root/usr/bin/ccache ]]; then
    cache=$CCACHE_DIR
    mkdir -p "$root/ccache" "$cache"
    compiler=(CCACHE_DIR=/ccache CCACHE_BASEDIR=/needlework CCACHE_MAXSIZE=20G
      CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache)
  fi
  env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive "${compiler[@]}" \
    unshare --mount --pid --fork bash -c '
      mount -t proc proc "$1/proc"
      mount --rbind /dev "$1/dev"
      [[ -z $3 ]] || mount --bind "$3" "$1/ccache"
      exec chroot "$1" bash -euo pipefail -c "$2"' inside "$root" "$1" "$cache" \
    >"$root.log" 2>&1 </dev/null || {
    tail -40 "$root.log" >&2
    fail "this command failed: $1"
  }
}

install_ccache() {
  [[ -z ${CCACHE_DIR:-} ]] || inside 'apt-get install --yes --no-install-recommends ccache'
}

# Which files there are, without those of apt and dpkg themselves, caches, logs, and the one that netbase,
# on which Python depends, leaves.
files() {
  (cd "$root" && find . -xdev \( -path ./proc -o -path ./dev -o -path ./ccache -o -path ./release \
    -o -path ./tmp -o -path ./root -o -path ./var/lib/dpkg -o -path ./var/lib/apt -o -path ./var/cache \
    -o -path ./var/log -o -path ./needlework -o -path ./etc/ld.so.cache -o -path ./etc/hosts \) -prune \
    -o ! -type d -print -o -iname '*needlework*' -print | sort)
}

remember_files() { files >"$root.before"; }

nothing_is_left() {
  local left
  left=$(comm -13 "$root.before" <(files))
  [[ -z $left ]] || fail "left after uninstalling: $left"
  echo "Nothing is left."
}

# The scene of the README, by the program that is installed, and by the Python package.
program_runs() {
  inside "mkdir -p /tmp/run && cd /tmp/run && cp /release/readme.toml gas.toml &&
    needlework run gas.toml --json --quiet --force | grep -F '\"'\$(cat /release/first-run.hash)'\"'"
  echo "The program gives the trajectory."
}

python_runs() {
  inside "mkdir -p /tmp/run && cd /tmp/run && cp /release/readme.toml gas.toml && $1 -c '
import needlework
sim = needlework.Simulation(\"gas.toml\", force=True)
sim.run()
sim.close()
assert sim.hash == open(\"/release/first-run.hash\").read().strip(), sim.hash
assert needlework.__file__.startswith(\"$2\"), needlework.__file__'"
  echo "The Python package gives the trajectory."
}

# The program of the README by find_package, and the smallest in C by pkg-config.
clients_run() {
  inside "rm -rf /tmp/mine && mkdir -p /tmp/mine /tmp/run && cd /tmp/mine &&
    cp /release/readme.cmake CMakeLists.txt && cp /release/readme.cpp mine.cpp &&
    cmake -G Ninja -B build && cmake --build build &&
    cd /tmp/run && cp /release/readme.toml gas.toml && /tmp/mine/build/mine | grep '^hash '"
  inside "cd /tmp/run && cp '$1/examples/c/smallest.c' . &&
    gcc smallest.c \$(pkg-config --cflags --libs needlework) -o smallest && ldconfig && ./smallest"
  echo "Programs in C++ and C are built and run."
}

part_source() {
  say "source archive, cmake --install, container"
  bare build
  install_ccache
  inside 'tar -C / -xf /release/needlework-*.tar.gz && mv /needlework-* /needlework'
  # As the container does it, but for what that removes to be small.
  local steps
  steps=$(sed -n '/^RUN /,/[^\\]$/p' Containerfile | sed 's/^RUN //; s/\\$//; /rm -rf build/d' | tr '\n' ' ')
  [[ $steps == *quickstart.sh*"cmake --install build/release"* ]] ||
    fail "Containerfile: expected quickstart.sh and cmake --install, not $steps"
  inside "cd /needlework && ./quickstart.sh"
  inside '! command -v git && ! command -v npm'
  inside "apt-get install --yes --no-install-recommends pkg-config"
  remember_files
  inside "cd /needlework && $steps"
  program_runs
  clients_run /usr/local/share/doc/Needlework
  inside "cd /needlework && cmake --build build/release --target uninstall"
  nothing_is_left
}

part_tests() {
  say "tests of the archive"
  root=$roots/$suite-build
  inside "apt-get install --yes --no-install-recommends libgtest-dev libeigen3-dev"
  inside "cd /needlework && source cmake/setup.sh && install_packages python && configure_release ON &&
    cmake --build build/release --target needlework_program needlework_python with_cpu_time c_header &&
    ctest --test-dir build/release --output-on-failure --no-tests=error \\
      -R '^(docs.links|layers.one_way|cli.hostile_inputs|compatibility.earlier_files|c.header)\$'"
  inside '! command -v git'
  echo "Tests are built and run without git."
}

part_build() {
  say "packages and wheel"
  root=$roots/$suite-build
  inside "cd /needlework && packaging/build.sh packages /release/made"
  rm -f "$dist"/*
  cp "$root"/release/made/* "$dist/"
  ls "$dist"
}

part_debian() {
  say "packages of Debian"
  bare debian
  inside "apt-get install --yes --no-install-recommends g++ cmake ninja-build pkg-config"
  remember_files
  cp "$dist"/*.deb "$root/release/"
  # Each by itself, then all together.
  install_packages needlework
  program_runs
  remove_packages
  install_packages libneedlework5 libneedlework-dev
  clients_run /usr/share/doc/Needlework
  remove_packages
  install_packages python3-needlework
  python_runs python3 /usr/lib/python3/dist-packages
  remove_packages
  install_packages needlework libneedlework5 libneedlework-dev python3-needlework
  program_runs
  remove_packages
  nothing_is_left
}

install_packages() {
  inside "apt-get install --yes --no-install-recommends $(printf '/release/%s_*.deb ' "$@")"
}

# With what they depend on, also what that only suggests to other packages, as some do Python.
remove_packages() {
  inside "apt-get purge --yes \$(dpkg-query --show --showformat '\${Package} ' '*needlework*')
    apt-get autoremove --purge --yes -o APT::AutoRemove::RecommendsImportant=false \
      -o APT::AutoRemove::SuggestsImportant=false"
}

part_wheel() {
  say "wheel"
  bare wheel
  local wheel python
  wheel=$(echo "$dist"/needlework-*.whl)
  python=$(sed -n 's/.*-cp3\([0-9]*\)-.*/3.\1/p' <<<"$wheel")
  cp "$wheel" "$root/release/"
  # NumPy is fetched outside, where PyPI can be reached by whatever way there is.
  local numpy=() venv=()
  if ! python3 -m pip download --quiet --retries 0 --python-version "$python" --only-binary=:all: \
    --no-deps --dest "$root/release" numpy 2>/dev/null; then
    echo "NumPy is that of Debian, as PyPI cannot be reached."
    numpy=(python3-numpy) venv=(--system-site-packages)
  fi
  inside "apt-get install --yes --no-install-recommends python3-venv ${numpy[*]} $(libraries)"
  inside "python3 -m venv ${venv[*]} /opt/env"
  [[ -n ${numpy[*]} ]] || inside "/opt/env/bin/pip install --no-index --find-links /release numpy"
  remember_files
  inside "/opt/env/bin/pip install --no-index --find-links /release needlework"
  python_runs /opt/env/bin/python3 /opt/env
  inside "/opt/env/bin/pip uninstall --yes needlework"
  nothing_is_left
}

part_suite() {
  say "all tests of the archive"
  root=$roots/$suite-build
  inside "cd /needlework && ./test.sh"
  tail -5 "$root.log"
}

# The libraries of the system that the module needs: for Debian 12 those that packaging/README.md names,
# for others those that the package of Debian has found.
libraries() {
  if [[ $suite == bookworm ]]; then
    from_archive packaging/README.md | sed -n 's/.*`sudo apt-get install \(libhdf5[^`]*\)`.*/\1/p'
  else
    dpkg-deb --field "$(echo "$dist"/python3-needlework_*.deb)" Depends | tr ',' '\n' |
      sed -n 's/^ *\(lib[^ ]*\).*/\1/p' | tr '\n' ' '
  fi
}

version=$(sed -n 's/^project(Needlework VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
archive=$project/dist/needlework-$version.tar.gz
if ((${#parts[@]} == 0)); then
  packaging/build.sh source
  parts=(source tests build debian wheel)
fi
for part in "${parts[@]}"; do
  "part_$part"
done
say "all of this holds: ${parts[*]}"
