#!/usr/bin/env python3
"""Compares the edges of whole programs between the host and another architecture.

usage: architectures.py --host EDGE_LIST --other EDGE_LIST --emulator "COMMAND ..." --cusp CUSP [--programs N]
                        [PROGRAM ...]
EDGE_LIST is tests/unit/boards_sim/edge_list.cpp, built for each. Besides the programs named, N random
ones with scripts of holds and overrides run. The checksum of the edges must be that of `cusp sim --stats`.
Exit status: 0 all lists are equal, 1 they are not, 2 something could not run.
"""
import argparse
import json
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import zlib

import random_programs


def edges(command):
    run = subprocess.run(list(map(str, command)), stdin=subprocess.DEVNULL, capture_output=True,
                         timeout=600)
    if run.returncode:
        raise OSError(f"{command[0]}: status {run.returncode}: {run.stderr[-300:]!r}")
    return run.stdout


def checksum(listed):
    """The checksum of the edges of a list, and the one that its program printed at its end."""
    rows = (tuple(map(int, line.split())) for line in listed.split(b"\n")[:-2])
    return f"{zlib.crc32(b''.join(struct.pack('<QBB', *row) for row in rows)):08x}"


def simulated_checksum(cusp, files, folder):
    stats = folder / "sim.json"
    words = ["--script", str(files[1])] if len(files) > 1 else []
    run = subprocess.run([cusp, "sim", str(files[0]), "--stats", str(stats), *words], capture_output=True, timeout=600)
    if run.returncode > 1:
        raise OSError(f"cusp sim {files[0]}: status {run.returncode}: {run.stderr[-300:]!r}")
    return json.loads(stats.read_text())["edges_crc32"]


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
    parser.add_argument("--cusp", required=True)
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
                count = here.count(b"\n") - 1
                total += count
                sums = {checksum(there), there.split()[-1].decode(), simulated_checksum(options.cusp, files, pathlib.Path(name))}
                if here != there or len(sums) > 1 or (not count and len(files) == 1):
                    wrong += 1
                    print(f"{files[0]}: {count} edges on the host, {there.count(10) - 1} there; checksums {sorted(sums)}")
    except (OSError, subprocess.TimeoutExpired) as error:
        print(f"architectures: {error}", file=sys.stderr)
        return 2
    print(f"{len(runs)} programs, {total} edges; different: {wrong}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
