#!/usr/bin/env python3
"""Checks that each header compiles on its own, and that base file names are unique.

Headers that a source file includes before all others are left to the build of that file.

usage: headers.py TOP COMPILER [FLAG...]
Exit status: 0 all do, 1 some do not, 2 the tree can't be read.
"""
import collections
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys

FOLDERS = ("firmware", "hal", "boards", "host_tools")


def first_error(compiler, flags, top, header):
    run = subprocess.run([compiler, "-std=c++17", "-fsyntax-only", "-x", "c++", f"-I{top}", *flags,
                          "-include", str(header), os.devnull], capture_output=True, text=True)
    if run.returncode == 0:
        return None
    errors = [line for line in run.stderr.splitlines() if "error:" in line]
    return f"{header.relative_to(top)}: {errors[0] if errors else run.stderr[:200]}"


def included_first(top):
    """Headers, as paths from `top`, that are the first include of a source file."""
    for folder in FOLDERS:
        for file in (top / folder).rglob("*.cpp"):
            first = re.search(r'^#include (?:"(.+)"|<.+>)', file.read_text(), re.MULTILINE)
            if first and first.group(1):
                yield first.group(1)


def twice(top):
    places = collections.defaultdict(list)
    for folder in FOLDERS:
        for file in (top / folder).rglob("*.[hc]pp"):
            places[file.name].append(file.relative_to(top).as_posix())
    for name, found in sorted(places.items()):
        # Each board has its own main; all other names are unique.
        if len(found) > 1 and name != "main.cpp":
            yield f"{name}: {' and '.join(sorted(found))} share their name"


def main(arguments):
    top, compiler, flags = pathlib.Path(arguments[1]), arguments[2], arguments[3:]
    headers = [file for folder in FOLDERS for file in sorted((top / folder).rglob("*.hpp"))]
    if not headers:
        print(f"headers: none below {top}", file=sys.stderr)
        return 2
    built = set(included_first(top))
    alone = [file for file in headers if file.relative_to(top).as_posix() not in built]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = [error for error in pool.map(
            lambda header: first_error(compiler, flags, top, header), alone) if error]
    found += twice(top)
    print("\n".join(found) if found else f"headers: {len(alone)} of {len(headers)} compile on their own, "
          "the others are what some source file includes first")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
