#!/usr/bin/env python3
"""Compares the edges of whole programs between the host and another architecture.

usage: architectures.py --host EDGE_LIST --other EDGE_LIST --emulator "COMMAND ..." [--programs N]
                        [PROGRAM ...]
EDGE_LIST is tests/unit/boards_sim/edge_list.cpp, built for each. Besides the programs named, N random
ones with scripts of holds and overrides run.
Exit status: 0 all lists are equal, 1 they are not, 2 something could not run.
"""
import argparse
import pathlib
import random
import subprocess
import sys
import tempfile

import random_programs


def edges(command):
    run = subprocess.run(list(map(str, command)), stdin=subprocess.DEVNULL, capture_output=True,
                         timeout=600)
    if run.returncode:
        raise OSError(f"{command[0]}: status {run.returncode}: {run.stderr[-300:]!r}")
    return run.stdout


def make_random(folder, seed):
    chance = random.Random(seed)
    program, script = folder / f"random_{seed}.ngc", folder / f"random_{seed}.script"
    settings = random_programs.random_settings(chance)
    program.write_text(settings + random_programs.random_program(chance).replace("\r", ""))
    script.write_text(random_programs.random_script(chance))
    return [program, script]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--host", required=True)
    parser.add_argument("--other", required=True)
    parser.add_argument("--emulator", default="")
    parser.add_argument("--programs", type=int, default=8)
    parser.add_argument("program", nargs="*")
    options = parser.parse_args()
    wrong = total = 0
    try:
        with tempfile.TemporaryDirectory() as name:
            runs = [[program] for program in options.program]
            runs += [make_random(pathlib.Path(name), seed) for seed in range(options.programs)]
            for files in runs:
                here = edges([options.host, *files])
                there = edges([*options.emulator.split(), options.other, *files])
                total += here.count(b"\n")
                if here != there or (not here and len(files) == 1):
                    wrong += 1
                    print(f"{files[0]}: {here.count(10)} edges on the host, {there.count(10)} there")
    except (OSError, subprocess.TimeoutExpired) as error:
        print(f"architectures: {error}", file=sys.stderr)
        return 2
    print(f"{len(runs)} programs, {total} edges; different: {wrong}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
