#!/usr/bin/env python3
"""Checks that each `function()`, each `CamelCaseType` and each `path/file` that the documents name exists in the tree.

usage: doc_names.py TOP DOCUMENT...    (documents relative to TOP)
Exit status: 0 all exist, 1 some do not, 2 a document can't be read or names no function at all.
"""
import pathlib
import re
import sys

FOLDERS = ("firmware", "hal", "boards", "host_tools", "tests", "cmake", "docs")
FUNCTION = re.compile(r"`(?:[\w:<>]+(?:::|\.))?(~?\w+)\(\)`")
FILE = re.compile(r"`((?:%s)/[\w./-]+\.\w+)`" % "|".join(FOLDERS))
TYPE = re.compile(r"`((?:[A-Z][a-z0-9]+){2,})(?:::\w+)?(?:\(\))?`")
WORD_BEFORE_BRACKET = re.compile(r"\b(\w+)\s*\(")
CAMEL_CASE = re.compile(r"\b(?:[A-Z][a-z0-9]+){2,}\b")


def names_in_sources(top):
    """Functions, and words in camel case, of the sources."""
    names, types = set(), set()
    for folder in FOLDERS:
        for file in (top / folder).rglob("*"):
            if file.suffix in (".hpp", ".cpp", ".py", ".cmake", ".c"):
                text = file.read_text()
                names.update(WORD_BEFORE_BRACKET.findall(text))
                types.update(CAMEL_CASE.findall(text))
    return names, types


def main(arguments):
    top, documents = pathlib.Path(arguments[1]), arguments[2:]
    (known, types), missing, count = names_in_sources(top), [], 0
    for document in documents:
        try:
            lines = (top / document).read_text().splitlines()
        except OSError as error:
            print(f"doc_names: {error}", file=sys.stderr)
            return 2
        for number, line in enumerate(lines, 1):
            for name in FUNCTION.findall(line):
                count += 1
                if name not in known:
                    missing.append(f"{document}:{number}: no function {name}()")
            for name in TYPE.findall(line):
                count += 1
                if name not in types:
                    missing.append(f"{document}:{number}: no type {name}")
            for name in FILE.findall(line):
                count += 1
                if not (top / name).exists():
                    missing.append(f"{document}:{number}: no file {name}")
    if not count:
        print("doc_names: the documents name nothing that could be checked", file=sys.stderr)
        return 2
    print("\n".join(missing) if missing else f"doc_names: all {count} names exist")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
