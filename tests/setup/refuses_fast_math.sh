#!/usr/bin/env bash
# Configuring with options that change floating-point results fails and names the option, and kernels
# do not compile with -ffast-math: refuses_fast_math.sh SOURCE CXX
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT

for flag in -ffast-math -Ofast -funsafe-math-optimizations; do
  status=0
  message=$(cmake -G Ninja -S "$1" -B "$folder/build" -DCMAKE_CXX_COMPILER="$2" \
            -DCMAKE_CXX_FLAGS="-g $flag" 2>&1) || status=$?
  if ((status == 0)) || ! grep -q -- "$flag among the compiler's flags: Needlework would" <<<"$message"; then
    echo "$flag: expected a failure that names it, got status $status and:"
    echo "$message"
    exit 1
  fi
done
for header in contact_function double_double default_arithmetic; do
  include=(-x c++ -std=c++20 -fsyntax-only -I"$1" -include "kernels/$header.h" /dev/null)
  "$2" "${include[@]}"
  if message=$("$2" -ffast-math "${include[@]}" 2>&1) || ! grep -q "IEEE 754" <<<"$message"; then
    echo "kernels/$header.h: expected not to compile with -ffast-math, for the reason, got:"
    echo "$message"
    exit 1
  fi
done
