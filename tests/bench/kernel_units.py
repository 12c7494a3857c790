#!/usr/bin/python3
"""bench_kernels prints times per pair in the unit that it names.

    tests/bench/kernel_units.py BENCH_KERNELS
"""

import json
import re
import subprocess
import sys

FILTER = ["--benchmark_filter=(first-contact|overlapping)/dense", "--benchmark_min_time=0.01"]


def output_of(*more):
    return subprocess.run([sys.argv[1], *FILTER, *more], check=True, capture_output=True,
                          text=True).stdout


lines = [line for line in output_of().splitlines() if "ns_per_pair=" in line]
assert len(lines) >= 2, lines
for line in lines:
    assert re.search(r" ns_per_pair=[\d.]+( |$)", line), line
    assert re.search(r" pairs_per_cycle=[\d.]+[mu]?( |$)", line), line  # thousandths or millionths

for one in json.loads(output_of("--benchmark_format=json"))["benchmarks"]:
    # The clock of the counters begins and ends a little outside of that of the benchmark.
    quotient = one["ns_per_pair"] * one["items_per_second"] / 1e9
    assert 0.9 < quotient < 1.3, one
