#!/usr/bin/env python3
"""Checks that the output does not depend on the number of threads.

usage: threads_test.py CUSP [--first SEED] [--count N] [--all-examples]

Examples and random jobs (tests/refactor/random_job.py) are planned and verified by 1, 2 and 3 threads. Compared are the
exit status, the G-code, the statistics without times, and the figures of `cusp verify`.
Exit status: 0 all equal, 1 a difference, which is named.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(TOP / "tests" / "refactor"))
from compare_bytes import figures
from random_job import RandomJob

QUICK_EXAMPLES = ("adaptive_isocurve/trimmed.toml",)
THREADS = (1, 2, 3)
WHOLE = 600  # s: longer than any correct call takes


def results(cusp, job, folder, threads):
    """The results of a job: exit status, bytes of the program, figures of plan and of verify."""
    program, stats, check = (folder / name for name in ("out.ngc", "plan.json", "verify.json"))
    for old in ("out*.ngc", "plan*.json", "verify.json"):
        for path in folder.glob(old):
            path.unlink()
    number = ["--threads", str(threads)]
    plan = subprocess.run([cusp, "plan", job, "-o", program, "--stats", stats, *number], cwd=job.parent,
                          capture_output=True, timeout=WHOLE)
    if plan.returncode != 0:
        # a job that can't be planned is refused in the same words
        return plan.returncode, plan.stderr.splitlines()[-1:], b"", b"", b""
    # of several set-ups each has its own
    programs, all_stats = sorted(folder.glob("out*.ngc")), sorted(folder.glob("plan*.json"))
    program = programs[0]
    verify = subprocess.run([cusp, "verify", job, program, "--stats", check, "--grid", "0.4", *number], cwd=job.parent,
                            capture_output=True, timeout=WHOLE)
    return (plan.returncode, b"".join(p.read_bytes() for p in programs), [figures(s) for s in all_stats],
            verify.returncode, figures(check))


def differs(cusp, job, folder, name):
    one, *others = (results(cusp, job, folder, threads) for threads in THREADS)
    parts = ("exit status of plan", "G-code", "statistics", "exit status of verify", "figures of verify")
    for threads, other in zip(THREADS[1:], others):
        for part, a, b in zip(parts, one, other):
            if a != b:
                print(f"{name}: {part}: {threads} threads differ from one")
                return True
    return False


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("cusp")
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--count", type=int, default=4)
    parser.add_argument("--all-examples", action="store_true")
    args = parser.parse_args()
    examples = TOP / "examples"
    jobs = sorted(examples.glob("*/*.toml")) if args.all_examples else [examples / name for name in QUICK_EXAMPLES]
    wrong = planned = 0
    print(f"seeds {args.first} to {args.first + args.count - 1}")
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        for job in jobs:
            wrong += differs(args.cusp, job, folder, job.name)
        for seed in range(args.first, args.first + args.count):
            random_folder = folder / str(seed)
            random_folder.mkdir()
            job = random_folder / RandomJob(seed).write(random_folder)
            wrong += differs(args.cusp, job, folder, f"random job {seed}")
            planned += (folder / "out.ngc").exists()
    if args.count and not planned:
        print("no random job was planned")
        return 1
    print(f"{len(jobs)} examples, {args.count} random jobs ({planned} planned), {wrong} differ")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
