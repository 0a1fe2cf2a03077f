#!/usr/bin/env python3
"""Checks that no two sources of a folder give one name to two things of unnamed namespaces.

usage: unnamed_names.py TOP
Releases are unity builds: several sources of a module are one translation unit, and which ones changes with every file
that is added. Constants, types and functions of the same parameters clash there. Exit status: 0 no name is given twice,
1 one is, 2 no name was found at all.
"""
import collections
import pathlib
import re
import sys

UNNAMED = re.compile(r"^namespace \{(.*?)^\}  // namespace$", re.DOTALL | re.MULTILINE)
CONSTANT = re.compile(r"^constexpr [^;=({]*?\b(k[A-Z]\w*)", re.MULTILINE)
TYPE = re.compile(r"^(?:struct|class|enum class) (\w+)(?: final)?\s*(?::(?!:)[^;{]*)?\{", re.MULTILINE)
FUNCTION = re.compile(r"^(?!constexpr|using|struct|class|enum)\w[\w:<>,&* ]*?[ &*](\w+)\(([^;{]*?)\)\s*\{", re.MULTILINE)
FOLDERS = ("firmware", "hal", "host_tools")


def names_of(text):
    inside = "\n".join(UNNAMED.findall(text))
    names = set(CONSTANT.findall(inside)) | set(TYPE.findall(inside))
    return names | {f"{name}({' '.join(parameters.split())})" for name, parameters in FUNCTION.findall(inside)}


def main(arguments):
    top = pathlib.Path(arguments[1])
    places = collections.defaultdict(list)
    for file in sorted(file for folder in FOLDERS for file in (top / folder).rglob("*.cpp")):
        for name in names_of(file.read_text()):
            places[file.parent, name].append(str(file.relative_to(top)))
    if not places:
        print("unnamed_names: no name found", file=sys.stderr)
        return 2
    twice = {key: files for key, files in places.items() if len(files) > 1}
    for (_, name), files in sorted(twice.items()):
        print(f"unnamed_names: {name} is in {' and '.join(files)}", file=sys.stderr)
    if not twice:
        print(f"unnamed_names: all {len(places)} names are given once in their folder")
    return 1 if twice else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
