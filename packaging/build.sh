#!/usr/bin/env bash
# Makes what a release consists of, in FOLDER (dist/):
#
#   packaging/build.sh source [FOLDER]      needlework-VERSION.tar.gz, of the last commit; needs git
#   packaging/build.sh packages [FOLDER]    packages of the Debian this runs on, and a wheel for its
#                                           Python, of one build; needs no git
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source cmake/setup.sh

version=$(sed -n 's/^project(Needlework VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)

make_source() {
  if ! git diff --quiet HEAD; then
    echo "The archive is of the last commit, without what has changed since." >&2
  fi
  git archive --format=tar.gz --prefix="needlework-$version/" \
    --output="$folder/needlework-$version.tar.gz" HEAD
}

make_packages() {
  install_packages build python pip packaging
  run_quietly cmake --preset package
  cmake --build --preset package
  run_quietly cpack --preset package -B "$folder"
  rm -rf "$folder/_CPack_Packages"
  NEEDLEWORK_BUILD=$PWD/build/package run_quietly /usr/bin/python3 -m pip wheel --no-deps \
    --no-build-isolation --wheel-dir "$folder" .
  # pip leaves these beside setup.py.
  rm -rf build/lib.* build/bdist.* build/temp.* python/needlework.egg-info
}

folder=${2:-dist}
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
case ${1:-} in
  source) make_source ;;
  packages) make_packages ;;
  *)
    sed -n '2,6s/^# \{0,1\}//p' packaging/build.sh >&2
    exit 2
    ;;
esac
ls -l "$folder"
