#!/usr/bin/env bash
# Adds to the list of names and the description of the C interface what has come, of a build folder:
#   tests/compatibility/write.sh build/release
# Names that have gone, and structures that changed under the same soname, are errors: COMPATIBILITY.md.
set -euo pipefail
build=$(cd "${1:?expected a build folder}" && pwd)
cd "$(dirname "${BASH_SOURCE[0]}")"
cmake --build "$build" --target describe_results needlework_c needlework_python needlework_python_files
PYTHONPATH=$build/python /usr/bin/python3 names.py "$build/describe_results" --write
/usr/bin/python3 abi.py "$build/libneedlework.so" --write
git diff --stat -- .
