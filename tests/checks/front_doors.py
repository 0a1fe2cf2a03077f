#!/usr/bin/env python3
"""Checks that each module has a front door: the header of its name, or that docs/architecture.md names, with an example.

usage: front_doors.py TOP
A module is a folder of firmware/ or host_tools/ with headers. Its front door begins with a comment, in which lines
that are indented by three blanks or more are the example. The front door has the module's name. Another name needs a
row with a reason in the third column, and no header may have the module's name then; the reason "class `Streamer`"
means that streamer.hpp defines Streamer.
Exit status: 0 all have one, 1 some do not, 2 there is no table or no module.
"""
import pathlib
import re
import sys

FOLDERS = ("firmware", "host_tools")
ROW = re.compile(r"^\| `((?:%s)/[\w/]+)` \| `(\w+\.hpp)` \|(?: ([^|\n]*?) ?\|)$" % "|".join(FOLDERS), re.MULTILINE)
CLASS = re.compile(r"^class `(\w+)`$")
EXAMPLE = re.compile(r"^//   +\S", re.MULTILINE)


def opening_comment(text):
    lines = []
    for line in text.splitlines():
        if not line.startswith("//"):
            break
        lines.append(line)
    return "\n".join(lines)


def snake_case(name):
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()


def complaint_of_name(folder, header, reason):
    """Why a front door may not have this name, or None."""
    module = folder.name
    if header == f"{module}.hpp":
        return "has the module's name: it needs no row"
    if not reason:
        return f"needs the name {module}.hpp, or a reason in the third column"
    if (folder / f"{module}.hpp").exists():
        return f"is not {module}.hpp, which exists"
    named = CLASS.match(reason)
    if named and (header != f"{snake_case(named[1])}.hpp"
                  or not re.search(rf"^(?:class|struct) {named[1]}\b[^;]*\{{", (folder / header).read_text(), re.MULTILINE)):
        return f"does not define the class {named[1]} that it is to be named after"
    return None


def main(arguments):
    top = pathlib.Path(arguments[1])
    table = {module: (header, reason) for module, header, reason in ROW.findall((top / "docs/architecture.md").read_text())}
    modules = sorted({file.parent.relative_to(top).as_posix() for folder in FOLDERS for file in (top / folder).rglob("*.hpp")})
    if not table or not modules:
        print("front_doors: no table in docs/architecture.md, or no module", file=sys.stderr)
        return 2
    found = [f"docs/architecture.md: {module} is no module with headers" for module in table if module not in modules]
    for module in modules:
        name, reason = table.get(module, (module.split("/")[-1] + ".hpp", ""))
        header = top / module / name
        if not header.is_file():
            found.append(f"{module}: has no {name}; another name needs a row in docs/architecture.md, \"Front doors\"")
            continue
        wrong_name = complaint_of_name(top / module, name, reason) if module in table else None
        if wrong_name:
            found.append(f"docs/architecture.md: {module}/{name} {wrong_name}")
        if not EXAMPLE.search(opening_comment(header.read_text())):
            found.append(f"{module}/{name}:1: the opening comment of a front door needs an example: lines `//     code`")
    print("\n".join(found) if found else f"front_doors: {len(modules)} modules have one")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
