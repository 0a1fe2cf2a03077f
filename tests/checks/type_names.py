#!/usr/bin/env python3
"""Checks that no type of one namespace is defined in two files of host_tools.

usage: type_names.py TOP
Two types of one name and namespace are one type to the linker, and either's constructor may be run on the other. Types
in unnamed namespaces are free. Exit status: 0 each name is defined once, 1 one is not, 2 no type was found at all.
"""
import collections
import pathlib
import re
import sys

NAMESPACE = re.compile(r"^namespace ([\w:]+) \{", re.MULTILINE)
UNNAMED = re.compile(r"^namespace \{.*?^\}  // namespace$", re.DOTALL | re.MULTILINE)
TYPE = re.compile(r"^(?:struct|class|enum class) (\w+)(?: final)?\s*(?::(?!:)[^;{]*)?\{", re.MULTILINE)


def main(arguments):
    top = pathlib.Path(arguments[1])
    places = collections.defaultdict(set)
    for file in sorted((top / "host_tools").rglob("*.?pp")):
        text = UNNAMED.sub("", file.read_text())
        opened = NAMESPACE.findall(text)
        for name in TYPE.findall(text):
            places[f"{opened[-1]}::{name}" if opened else name].add(str(file.relative_to(top)))
    if not places:
        print("type_names: no type found", file=sys.stderr)
        return 2
    twice = {name: files for name, files in places.items() if len(files) > 1}
    for name, files in sorted(twice.items()):
        print(f"type_names: {name} is defined in {' and '.join(sorted(files))}", file=sys.stderr)
    if not twice:
        print(f"type_names: all {len(places)} names are defined once")
    return 1 if twice else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
