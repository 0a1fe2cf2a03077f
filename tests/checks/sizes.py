#!/usr/bin/env python3
"""Checks that files and functions of the tree keep their size, and that classes show first what is public.

usage: sizes.py TOP
A file has at most 500 lines. A function of the product has at most 60, unless the comment above it says "Over 60 lines:" and why.
A function is what lies between a line that is an opening brace alone and the closing brace below it, with the lines of its
declaration: the layout that tests/checks/format.sh holds. No header has `private:` or `protected:` before the first `public:` of a class.
Exit status: 0 all do, 1 some do not, 2 there are no sources.
"""
import pathlib
import re
import sys

MOST_LINES = 500
MOST_OF_A_FUNCTION = 60
REASON = "Over 60 lines:"
PRODUCT = ("firmware", "hal", "boards", "host_tools")
ACCESS = re.compile(r"^(\s*)(public|protected|private):")
CLASS = re.compile(r"^(\s*)(?:template <.*> )?class [A-Z]\w*(?: final)?(?: :.*)? \{$")


def functions(lines):
    """First line of the declaration and last line of each function, counted from 1."""
    for begin, line in enumerate(lines):
        if line.strip() != "{":
            continue
        indent = line[:line.index("{")]
        end = next((k for k in range(begin, len(lines)) if lines[k].startswith(indent + "}")), begin)
        first = begin
        while first > 0 and lines[first - 1].strip() and not re.match(r"\s*(//|#|\}|\w+:$)|.*[;{]$", lines[first - 1]):
            first -= 1
        yield first + 1, end + 1


def has_reason(lines, first):
    above = first - 2
    while above >= 0 and lines[above].strip().startswith("//"):
        if REASON in lines[above]:
            return True
        above -= 1
    return False


def first_access(lines):
    """Classes whose first label of access is not `public:`, with their lines."""
    for begin, line in enumerate(lines):
        found = CLASS.match(line)
        if not found:
            continue
        for access in map(ACCESS.match, lines[begin + 1:]):
            if access and access.group(1) == found.group(1):
                if access.group(2) != "public":
                    yield begin + 1
                break


def complaints(file, place):
    """Tests are judged by the length of the file only: a test may be one long dialogue."""
    lines = file.read_text().split("\n")
    if len(lines) - 1 > MOST_LINES:
        yield f"{place}: {len(lines) - 1} lines; limit {MOST_LINES}"
    if place.startswith("tests/"):
        return
    for first, last in functions(lines):
        if last - first + 1 > MOST_OF_A_FUNCTION and not has_reason(lines, first):
            yield (f"{place}:{first}: a function of {last - first + 1} lines; limit {MOST_OF_A_FUNCTION}, "
                   f"or a comment above it: {REASON} ...")
    if file.suffix == ".hpp":
        for line in first_access(lines):
            yield f"{place}:{line}: a class that does not show first what is public"


def main(arguments):
    top = pathlib.Path(arguments[1])
    files = [file for folder in (*PRODUCT, "tests") for file in sorted((top / folder).rglob("*.[hc]pp"))]
    if not files:
        print(f"sizes: no sources below {top}", file=sys.stderr)
        return 2
    found = [text for file in files for text in complaints(file, file.relative_to(top).as_posix())]
    print("\n".join(found) if found else f"sizes: {len(files)} files within {MOST_LINES} lines, their functions within {MOST_OF_A_FUNCTION} or with a reason")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
