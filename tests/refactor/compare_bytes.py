#!/usr/bin/env python3
"""Shows that two builds of `cusp` give the same bytes: the test of a refactoring.

usage: compare_bytes.py OLD NEW [--first SEED] [--count N] [--no-examples] [--no-messages] [--jobs N] [--limit S] [--keep FOLDER]

Both programs plan every job of examples/ and N random jobs (tests/refactor/random_job.py). Compared are the exit status,
the messages, the G-code and the statistics of `cusp plan`; the figures of `cusp verify`; and, of programs short enough,
the pulse trace (VCD) and the statistics of `cusp sim`. Times, memory, reports of progress and the version in the G-code's
comment are left out; with --no-messages, what is printed too. A random job that OLD does not plan within the limit is passed over and replaced by the next seed.
Exit status: 0 all equal, 1 a difference, which is named, 2 nothing could be compared.
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
import random_job

TOP = pathlib.Path(__file__).resolve().parents[2]
TIMES = {"planning_s", "wall_s"}
PROGRESS = re.compile(rb"(planning|timing|cutting|engagement|running) \d+ %\n")
TIME_WORDS = re.compile(rb"(planned|simulated) in [0-9.]+ s")
VERSION = re.compile(rb"cusp \d+\.\d+\.\d+")
WHOLE = 600  # s: longer than any correct call takes
SIMULATED = 40  # s of motion; longer programs are not traced


class TooSlow(Exception):
    pass


def without_times(value):
    if isinstance(value, dict):
        return {k: without_times(v) for k, v in value.items() if k not in TIMES and "memory" not in k}
    return [without_times(v) for v in value] if isinstance(value, list) else value


def figures(path):
    """A JSON file's text without what differs from run to run; empty where there is none."""
    return json.dumps(without_times(json.loads(path.read_bytes())), indent=1).encode() if path.exists() else b""


def content(path):
    return path.read_bytes() if path.exists() else b""


def call(program, words, folder, limit):
    try:
        run = subprocess.run([program, *words], cwd=folder, capture_output=True, timeout=limit)
    except subprocess.TimeoutExpired:
        raise TooSlow(words[0]) from None
    said = b"%s\n%s" % (run.stdout, run.stderr)
    return run.returncode, TIME_WORDS.sub(rb"\1", PROGRESS.sub(b"", said))


def outputs(program, job, folder, out, plan_limit, options):
    """Everything that is compared, by name."""
    out.mkdir()
    name = lambda file: os.path.relpath(out / file, folder)
    status, said = call(program, ["plan", job, "-o", name("p.ngc"), "--stats", name("plan.json")], folder, plan_limit)
    found = {"exit status of plan": str(status).encode(), "messages of plan": said,
             "G-code": b"".join(VERSION.sub(b"cusp VERSION", content(p), 1) for p in sorted(out.glob("p*.ngc"))),
             "statistics of plan": figures(out / "plan.json")}
    if status == 0 and (out / "p.ngc").exists():  # not of several set-ups
        add_verdict(found, program, job, folder, out)
        motion = json.loads((out / "plan.json").read_text())["estimated_s"]
        if options.simulation(motion):
            add_trace(found, program, folder, out)
    # the two programs get different file names
    return {key: value.replace(out.name.encode(), b"OUT") for key, value in found.items()
            if options.messages or not key.startswith("messages")}


def add_verdict(found, program, job, folder, out):
    name = lambda file: os.path.relpath(out / file, folder)
    status, said = call(program, ["verify", job, name("p.ngc"), "--stats", name("verify.json")], folder, WHOLE)
    found.update({"exit status of verify": str(status).encode(), "messages of verify": said,
                  "figures of verify": figures(out / "verify.json")})


def add_trace(found, program, folder, out):
    name = lambda file: os.path.relpath(out / file, folder)
    words = ["sim", name("p.ngc"), "--vcd", name("p.vcd"), "--stats", name("sim.json")]
    status, said = call(program, words, folder, WHOLE)
    trace = hashlib.sha256()
    with open(out / "p.vcd", "rb") as file:
        for block in iter(lambda: file.read(1 << 20), b""):
            trace.update(block)
    (out / "p.vcd").unlink()
    found.update({"exit status of sim": str(status).encode(), "messages of sim": said,
                  "statistics of sim": figures(out / "sim.json"), "pulse trace": trace.hexdigest().encode()})


def keys_that_differ(a, b):
    """Keys that only one of two JSON objects has, in words, or nothing."""
    try:
        was, now = json.loads(a), json.loads(b)
    except ValueError:
        return None
    if not (isinstance(was, dict) and isinstance(now, dict)) or was.keys() == now.keys():
        return None
    return f"keys added: {sorted(now.keys() - was.keys())}, gone: {sorted(was.keys() - now.keys())}"


def first_line_that_differs(key, a, b):
    """The first line in which two outputs differ, in words. A key more or less is a difference, and named."""
    keys = keys_that_differ(a, b)
    if keys:
        return f"{key}: {keys}"
    lines = zip(a.split(b"\n") + [b"(the end)"], b.split(b"\n") + [b"(the end)"])
    number, (was, now) = next((i, pair) for i, pair in enumerate(lines, 1) if pair[0] != pair[1])
    return f"{key}, line {number}: {was[:200].decode(errors='replace')!r} is now {now[:200].decode(errors='replace')!r}"


def difference(old, new):
    """The first difference with its line, and the names of the other outputs that differ; None where all are equal."""
    found = []
    for key in [*old, *(key for key in new if key not in old)]:
        a, b = old.get(key), new.get(key)
        if a is None or b is None:
            found.append((f"{key}: only one of the programs has it", key))
        elif a != b:
            found.append((first_line_that_differs(key, a, b), key))
    if not found:
        return None
    others = ", ".join(key for _, key in found[1:])
    return found[0][0] + (f"; also: {others}" if others else "")


class Outputs:
    """Which outputs are compared. Both programs are simulated or neither: the first one's estimate of the time decides."""

    def __init__(self, simulated_s, messages):
        self.simulated_s, self.messages, self.decided = simulated_s, messages, None

    def simulation(self, motion):
        if self.decided is None:
            self.decided = motion < self.simulated_s
        return self.decided


def compare(programs, job, folder, scratch, limit, options):
    """The difference of the job's outputs, or nothing, and the names of the outputs compared."""
    old = outputs(programs[0], job, folder, scratch / "out-old", limit, options)
    try:
        new = outputs(programs[1], job, folder, scratch / "out-new", WHOLE, options)
    except TooSlow as slow:
        return f"{slow}: not done in {WHOLE} s", old
    return difference(old, new), old


def compare_random(programs, seed, options):
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(options.keep, str(seed)) if options.keep else pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        job = random_job.RandomJob(seed)
        name = job.write(folder)
        try:
            fault, old = compare(programs, name, folder, folder, options.limit, Outputs(SIMULATED, options.messages))
        except TooSlow:
            return f"seed {seed} {job.strategy}", None, None
        return f"seed {seed} {job.strategy}", fault, old


def compare_example(programs, example, options):
    with tempfile.TemporaryDirectory() as scratch:
        fault, old = compare(programs, str(example), TOP, pathlib.Path(scratch), WHOLE, Outputs(0, options.messages))
        return str(example), fault, old


class Tally:
    """Prints differences as they are found, and counts."""

    def __init__(self):
        self.compared = {"examples": 0, "random jobs": 0}
        self.refused = self.traced = self.slow = self.faults = 0

    def add(self, kind, name, fault, old):
        if old is None:
            self.slow += 1
            return
        self.compared[kind] += 1
        self.refused += old["exit status of plan"] != b"0"
        self.traced += "pulse trace" in old
        if fault:
            self.faults += 1
            print(f"{name}: {fault}", flush=True)

    def line(self, first):
        return (f"{self.compared['random jobs']} random jobs from seed {first} and {self.compared['examples']} examples "
                f"({self.refused} refused, {self.traced} traced, {self.slow} passed over as slow): "
                + (f"{self.faults} differ" if self.faults else "byte-equal"))


def compare_all(programs, options):
    tally = Tally()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        if options.examples:
            examples = sorted(p.relative_to(TOP) for p in (TOP / "examples").rglob("*.toml"))
            for answer in pool.map(lambda e: compare_example(programs, e, options), examples):
                tally.add("examples", *answer)
        seed = options.first
        while tally.compared["random jobs"] < options.count:
            missing = options.count - tally.compared["random jobs"]
            for answer in pool.map(lambda s: compare_random(programs, s, options), range(seed, seed + missing)):
                tally.add("random jobs", *answer)
            seed += missing
    return tally


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("old")
    p.add_argument("new")
    p.add_argument("--first", type=int, default=1)
    p.add_argument("--count", type=int, default=200)
    p.add_argument("--examples", action=argparse.BooleanOptionalAction, default=True)
    p.add_argument("--messages", action=argparse.BooleanOptionalAction, default=True,
                   help="compare what is printed: off for a change of wording")
    p.add_argument("--jobs", type=int, default=2)
    p.add_argument("--limit", type=float, default=20.0, help="seconds OLD may plan a random job")
    p.add_argument("--keep", help="folder to keep the random jobs and their outputs in")
    options = p.parse_args()
    programs = [str(pathlib.Path(name).resolve()) for name in (options.old, options.new)]
    tally = compare_all(programs, options)
    print(tally.line(options.first))
    if not sum(tally.compared.values()):
        return 2
    return 1 if tally.faults else 0


if __name__ == "__main__":
    sys.exit(main())
