#!/usr/bin/env python3
"""Checks that docs/job_file.md tells every key that the reader of jobs knows, and no other.

usage: job_keys.py TOP
Exit status: 0 the same keys, 1 not, 2 a file can't be read or knows no keys.
"""
import pathlib
import re
import sys

READERS = ("host_tools/import/job_reader.cpp", "host_tools/import/tool_reader.cpp")
DOCUMENT = "docs/job_file.md"
# table.number("key", ...), length(table, "key", ...), read_interval(stock, "key")
READ = re.compile(r'(?:\b(?:number|numbers|required_number|whole_number|one_of|text|texts|flag)\(|\b(?:length|read_interval)\(\w+, )"(\w+)"')
ROW = re.compile(r"^\| ((?:`\w+`(?:, )?)+) \|", re.MULTILINE)


def main(arguments):
    top = pathlib.Path(arguments[1])
    try:
        known = {key for reader in READERS for key in READ.findall((top / reader).read_text())}
        told = {key for row in ROW.findall((top / DOCUMENT).read_text()) for key in re.findall(r"\w+", row)}
    except OSError as error:
        print(f"job_keys: {error}", file=sys.stderr)
        return 2
    if not known or not told:
        print("job_keys: no keys found", file=sys.stderr)
        return 2
    for key in sorted(known - told):
        print(f"{DOCUMENT}: does not tell the key {key} of {' and '.join(READERS)}")
    for key in sorted(told - known):
        print(f"{DOCUMENT}: tells a key {key} that {' and '.join(READERS)} do not know")
    if known == told:
        print(f"job_keys: all {len(known)} keys are told")
    return 0 if known == told else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv))
