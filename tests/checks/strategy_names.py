#!/usr/bin/env python3
"""Checks that nothing outside the strategies asks for a strategy's name: what depends on one is in its record.

usage: strategy_names.py TOP
Names are those of the records, `Strategy kName{"name", ...}`. The folders that have records may use them. Elsewhere in
host_tools no strategy is compared, by name or by address, and no text in quotes is a name, but for names of tool shapes.
Exit status: 0 nothing does, 1 something does, 2 there is no record.
"""
import pathlib
import re
import sys

RECORD = re.compile(r'\bStrategy k\w+\{\s*"(\w+)"')
SHAPES = re.compile(r"\bshape\b|ToolShape|\"ball\"")
COMPARED = re.compile(r"\bstrategy(?:->name|\.name)?\s*[=!]=(?!\s*nullptr)|\b\w+(?:\.|->)name\(\)\s*[=!]=")


def code_of(line):
    return line.split("//")[0]


def complaints(file, place, names):
    quoted = re.compile(r'(?<!\\)"(?:%s)"' % "|".join(sorted(names)))
    before = ""
    for number, line in enumerate(map(code_of, file.read_text().splitlines()), 1):
        if COMPARED.search(line):
            yield f"{place}:{number}: compares a strategy: ask for a trait of its record"
        elif quoted.search(line) and not SHAPES.search(before + line):
            yield f"{place}:{number}: has the name of a strategy: {quoted.search(line)[0]}"
        before = line


def main(arguments):
    top = pathlib.Path(arguments[1])
    files = sorted((top / "host_tools").rglob("*.?pp"))
    names, folders = set(), set()
    for file in files:
        found = RECORD.findall(re.sub(r"//.*", "", file.read_text()))
        names.update(found)
        folders.update([file.parent] if found else [])
    if not names:
        print("strategy_names: no record of a strategy", file=sys.stderr)
        return 2
    found = [each for file in files if file.parent not in folders
             for each in complaints(file, file.relative_to(top), names)]
    print("\n".join(found) if found else f"strategy_names: {len(names)} strategies, asked for by their records alone")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
