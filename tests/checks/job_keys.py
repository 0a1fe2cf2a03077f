#!/usr/bin/env python3
"""Checks that docs/job_file.md documents every key that the reader of jobs knows, and no other.

usage: job_keys.py TOP
Exit status: 0 the same keys, 1 not, 2 a file can't be read or knows no keys.
"""
import pathlib
import re
import sys

# The reader refuses keys outside its lists, and tests fail on keys that are not read.
KEYS = "host_tools/job/import/known_keys.cpp"
DOCUMENT = "docs/job_file.md"
TABLES = {"cutting", "fixture", "operation", "placing", "stock"}
LISTED = re.compile(r'\{"(\w+)", (?:""|k\w+|"[^"]*")(?:, (?:k\w+|"[^"]*"))?\}')  # of operations, with their strategies
LIST = re.compile(r'return \{(("\w+"(?:,\s*)?)+)\}')
ROW = re.compile(r"^\| ((?:`\w+`(?:, )?)+) \|", re.MULTILINE)


def main(arguments):
    top = pathlib.Path(arguments[1])
    try:
        code = (top / KEYS).read_text()
        known = set(LISTED.findall(code))
        known |= {key for found in LIST.finditer(code) for key in re.findall(r"\w+", found[1])} - TABLES
        documented = {key for row in ROW.findall((top / DOCUMENT).read_text()) for key in re.findall(r"\w+", row)}
    except OSError as error:
        print(f"job_keys: {error}", file=sys.stderr)
        return 2
    if not known or not documented:
        print("job_keys: no keys found", file=sys.stderr)
        return 2
    for key in sorted(known - documented):
        print(f"{DOCUMENT}: does not tell the key {key} of {KEYS}")
    for key in sorted(documented - known):
        print(f"{DOCUMENT}: documents a key {key} that {KEYS} does not know")
    if known == documented:
        print(f"job_keys: all {len(known)} keys are documented")
    return 0 if known == documented else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv))
