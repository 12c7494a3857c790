#!/usr/bin/env bash
# Builds the fuzz targets and runs each for some seconds, as many at a time as there are cores:
#   tests/fuzz/run.sh SECONDS [TARGET...]      all targets by default: the folders of tests/fuzz/corpus
# What ends a target is written to build/fuzz/found/TARGET-KIND-HASH, and build/fuzz/fuzz_TARGET FILE
# shows it again. Exit code 1 if anything is found. New inputs are kept in build/fuzz/inputs/TARGET.
# A clean build tries the same inputs each time, so that what ends a target comes from a change; another
# seed, NEEDLEWORK_FUZZ_SEED, tries others.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source cmake/setup.sh
build=$PWD/build/fuzz  # absolute: targets may change the folder

run_target() { # SECONDS TARGET
  local options=(-max_total_time="$1" -seed="${NEEDLEWORK_FUZZ_SEED:-1}" -timeout=20
    -rss_limit_mb=2048 -verbosity=0 -artifact_prefix="$build/found/$2-")
  local dictionary=$PWD/tests/fuzz/$2.dict log=$build/found/$2.log
  [[ -e $dictionary ]] && options+=(-dict="$dictionary")
  mkdir -p "$build/inputs/$2"
  if "$build/fuzz_$2" "${options[@]}" -print_final_stats=1 "$build/inputs/$2" "$PWD/tests/fuzz/corpus/$2" >"$log" 2>&1; then
    echo "fuzz $2: nothing found in $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs"
  else
    tail -n 60 "$log"
    echo "fuzz $2: found something, see $log and $build/found/$2-*"
    return 1
  fi
}

if [[ ${1:-} == --target ]]; then
  run_target "$2" "$3"
  exit
fi
seconds=${1:?expected a number of seconds}
targets=("${@:2}")
((${#targets[@]})) || mapfile -t targets < <(ls tests/fuzz/corpus)
mkdir -p "$build/found"
[[ -e build/release/build.ninja ]] || configure_release ON
cmake --build --preset release --target needlework_core needlework_theory needlework_picture
run_quietly cmake --preset fuzz
cmake --build --preset fuzz -- "${targets[@]/#/fuzz_}"
printf '%s\n' "${targets[@]}" | xargs -P "$(nproc)" -n 1 "tests/fuzz/run.sh" --target "$seconds"
