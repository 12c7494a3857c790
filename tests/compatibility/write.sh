#!/usr/bin/env bash
# Writes the lists of names and the description of the C interface again, of a build folder:
#   tests/compatibility/write.sh build/release
# Then look at what git says has gone: COMPATIBILITY.md.
set -euo pipefail
build=$(cd "${1:?expected a build folder}" && pwd)
cd "$(dirname "${BASH_SOURCE[0]}")"
cmake --build "$build" --target describe_results needlework_c needlework_python needlework_python_files
PYTHONPATH=$build/python /usr/bin/python3 names.py "$build/describe_results" --write
/usr/bin/python3 abi.py "$build/libneedlework.so" --write
git diff --stat -- .
