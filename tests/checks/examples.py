#!/usr/bin/env python3
"""Checks that the jobs of the examples name no file outside them: when installed, they have no other files beside them.

usage: examples.py TOP
Exit status: 0 all files are there and inside, 1 some are not, 2 there are no jobs.
"""
import pathlib
import sys
import tomllib

KEYS = ("floor", "intersect", "boundary", "islands", "after")


def files_of(job):
    for table, keys in [(job.get("stock", {}), ("program", "outline")), *((table, KEYS) for table in job.get("operation", []))]:
        for key in keys:
            named = table.get(key, [])
            yield from [named] if isinstance(named, str) else named


def main(arguments):
    examples = pathlib.Path(arguments[1]).resolve() / "examples"
    jobs, bad, count = sorted(examples.glob("*/*.toml")), [], 0
    for job in jobs:
        for name in files_of(tomllib.loads(job.read_text())):
            count += 1
            file = (job.parent / name.partition("#")[0]).resolve()
            if examples not in file.parents or not file.is_file():
                bad.append(f"{job}: {name} is no file of the examples")
    if not count:
        print("examples: no job names a file", file=sys.stderr)
        return 2
    print("\n".join(bad) if bad else f"examples: {count} files of {len(jobs)} jobs lie inside")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
