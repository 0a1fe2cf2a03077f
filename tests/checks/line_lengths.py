#!/usr/bin/env python3
"""Checks that no line of the documents is too long to be read in a diff or a terminal.

usage: line_lengths.py TOP LIMIT DOCUMENT...    (documents relative to TOP, LIMIT in characters)
A paragraph may be broken after any sentence: Markdown joins its lines.
Exit status: 0 all lines are within LIMIT, 1 some are not, 2 a document can't be read.
"""
import pathlib
import sys


def main(arguments):
    top, limit, documents = pathlib.Path(arguments[1]), int(arguments[2]), arguments[3:]
    found, count = [], 0
    for document in documents:
        try:
            lines = (top / document).read_text().splitlines()
        except OSError as error:
            print(f"line_lengths: {error}", file=sys.stderr)
            return 2
        count += len(lines)
        found += [f"{document}:{number}: {len(line)} characters; limit {limit}"
                  for number, line in enumerate(lines, 1) if len(line) > limit]
    if not count:
        print("line_lengths: no line to check", file=sys.stderr)
        return 2
    print("\n".join(found) if found else f"line_lengths: {count} lines within {limit} characters")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
