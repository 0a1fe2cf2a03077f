#!/usr/bin/env python3
"""Compares runs of the core in WebAssembly, under node, with `cusp sim`: every figure and the checksum of all edges.

usage: same_edges.py --cusp CUSP --package FOLDER [--programs N] [--seed N] [--keep FOLDER] [PROGRAM[=SETTINGS] ...]

FOLDER is what host_tools/judge/view/npm/build.mjs makes. Besides the programs named, N random ones with random settings run
(tests/target/random_programs.py). CUSP_WASM_PROGRAMS=N asks for another number. A program that differs is kept.
Exit status: 0 all are equal, 1 one is not, 2 something could not run.
"""
import argparse
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "target"))
import random_programs

EXACT = ("edges_crc32", "duration_s", "total_s", "lines", "moves", "steps", "end_mpos_mm", "length_mm", "max_velocity",
         "max_acceleration", "max_jerk", "pauses", "alarm")


def make_random(folder, seed):
    chance = random.Random(seed)
    program, settings = folder / f"random_{seed}.ngc", folder / f"random_{seed}.settings"
    program.write_bytes(random_programs.random_program(chance).encode())
    settings.write_text(random_programs.random_settings(chance))
    return program, settings


def on_host(cusp, program, settings, folder):
    stats = folder / "host.json"
    stats.unlink(missing_ok=True)
    words = ["--settings", settings] if settings else []
    run = subprocess.run([cusp, "sim", program, "--stats", stats, *words], capture_output=True, text=True)
    if not stats.exists():
        raise OSError(f"cusp sim {program}: status {run.returncode}: {run.stderr[-300:]}")
    return json.loads(stats.read_text())


def in_wasm(package, runs):
    listed = json.dumps([{"program": str(p), "settings": s and str(s)} for p, s in runs])
    script = pathlib.Path(__file__).with_name("run_programs.mjs")
    run = subprocess.run(["node", script, pathlib.Path(package, "dist/index.js")], input=listed, capture_output=True, text=True)
    if run.returncode:
        raise OSError(f"node: status {run.returncode}: {run.stderr[-600:]}")
    return [json.loads(line) for line in run.stdout.splitlines()]


def difference(host, page):
    """The first figure that differs, or nothing."""
    for key in EXACT:
        if host[key] != page[key]:
            return f"{key}: {host[key]} on the host, {page[key]} in WebAssembly"
    faults = [[(e["line"], e["code"]) for e in run["errors"]] for run in (host, page)]
    return None if faults[0] == faults[1] else f"errors: {faults[0]} on the host, {faults[1]} in WebAssembly"


def compare(options, folder):
    runs = [(pathlib.Path(a), pathlib.Path(b) if b else None) for a, _, b in (w.partition("=") for w in options.program)]
    runs += [make_random(folder, seed) for seed in range(options.seed, options.seed + options.programs)]
    pages = in_wasm(options.package, runs)
    wrong, simulated, wall = 0, 0.0, 0.0
    for (program, settings), page in zip(runs, pages, strict=True):
        found = difference(on_host(options.cusp, program, settings, folder), page)
        simulated, wall = simulated + page["total_s"], wall + page["wall_s"]
        if found:
            wrong += 1
            print(f"{program.name}: {found}")
            keep(options.keep, program, settings)
    moving = sum(page["edges_crc32"] != "00000000" for page in pages)
    print(f"{len(runs)} programs, {moving} of them with edges, {simulated:.0f} s simulated in {wall:.1f} s under node;"
          f" different: {wrong}")
    return 1 if wrong or not moving else 0


def keep(folder, *files):
    if folder:
        pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
        for file in filter(None, files):
            pathlib.Path(folder, file.name).write_bytes(file.read_bytes())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cusp", required=True)
    parser.add_argument("--package", required=True)
    parser.add_argument("--programs", type=int, default=int(os.environ.get("CUSP_WASM_PROGRAMS", "50")))
    parser.add_argument("--seed", type=int, default=1, help="of the first random program")
    parser.add_argument("--keep", help="folder for programs that differ")
    parser.add_argument("program", nargs="*")
    options = parser.parse_args()
    try:
        with tempfile.TemporaryDirectory() as folder:
            return compare(options, pathlib.Path(folder))
    except OSError as error:
        print(f"same_edges: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
