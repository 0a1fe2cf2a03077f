#!/usr/bin/env python3
"""Builds, and says what that costs in compilations of reference_compile.cpp on the same machine.

usage: build_cost.py LIMIT COMMAND [ARGUMENT...]

The reference is compiled before and after COMMAND, with -O2; the cost is COMMAND's CPU time over the reference's mean. The
command is to build from nothing, without a compiler cache. Exit status: the command's, or 1 where the cost is over LIMIT.
"""
import os
import pathlib
import resource
import subprocess
import sys

REFERENCE = pathlib.Path(__file__).with_name("reference_compile.cpp")
REPETITIONS = 3


def cpu_of(command):
    """Exit status and CPU seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    status = subprocess.run(command).returncode
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return status, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def reference():
    command = [os.environ.get("CXX", "c++"), "-std=c++17", "-O2", "-c", "-o", os.devnull, str(REFERENCE)]
    times = []
    for _ in range(REPETITIONS):
        status, seconds = cpu_of(command)
        if status != 0:
            sys.exit("build_cost: the reference does not compile")
        times.append(seconds)
    return times


def main():
    limit, command = float(sys.argv[1]), sys.argv[2:]
    times = reference()
    status, seconds = cpu_of(command)
    if status != 0:
        return status
    times += reference()
    unit = sum(times) / len(times)
    cost = seconds / unit
    print(f"build_cost: {seconds:.0f} CPU s, {cost:.1f} times the reference's {unit:.2f} s; limit {limit:g}")
    if cost > limit:
        print("build_cost: the build has become slower: see what ninja's log says of each file (docs/testing.md), and optimise, "
              "include or split less", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
