#!/usr/bin/env python3
"""Checks that each module has a front door: the header that docs/architecture.md names, with an example.

usage: front_doors.py TOP
A module is a folder of firmware/ or host_tools/ with headers. Its front door begins with a comment, in which lines
that are indented by three blanks or more are the example.
Exit status: 0 all have one, 1 some do not, 2 there is no table or no module.
"""
import pathlib
import re
import sys

FOLDERS = ("firmware", "host_tools")
ROW = re.compile(r"^\| `((?:%s)/\w+)` \| `(\w+\.hpp)` \|$" % "|".join(FOLDERS), re.MULTILINE)
EXAMPLE = re.compile(r"^//   +\S", re.MULTILINE)


def opening_comment(text):
    lines = []
    for line in text.splitlines():
        if not line.startswith("//"):
            break
        lines.append(line)
    return "\n".join(lines)


def main(arguments):
    top = pathlib.Path(arguments[1])
    table = dict(ROW.findall((top / "docs/architecture.md").read_text()))
    modules = sorted({file.parent.relative_to(top).as_posix() for folder in FOLDERS for file in (top / folder).glob("*/*.hpp")})
    if not table or not modules:
        print("front_doors: no table in docs/architecture.md, or no module", file=sys.stderr)
        return 2
    found = [f"docs/architecture.md: {module} is no module with headers" for module in table if module not in modules]
    for module in modules:
        if module not in table:
            found.append(f"docs/architecture.md: {module} has no row in \"Front doors\": | `{module}` | `HEADER.hpp` |")
            continue
        header = top / module / table[module]
        if not header.is_file():
            found.append(f"docs/architecture.md: {module}/{table[module]} does not exist")
        elif not EXAMPLE.search(opening_comment(header.read_text())):
            found.append(f"{module}/{table[module]}:1: the opening comment of a front door needs an example: lines `//     code`")
    print("\n".join(found) if found else f"front_doors: {len(modules)} modules have one")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
