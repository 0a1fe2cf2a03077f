#!/usr/bin/env python3
"""Applies the code blocks of a page to a copy of the tree.

usage: page_blocks.py PAGE TOP FOLDER [FILE...]
A block ```LANGUAGE file=PATH is the whole of a new file; a block ```diff file=PATH replaces its lines with ' ' and '-' by
those with ' ' and '+'. The changed files, or only those named, are written below FOLDER.
Exit status: 0 done, 1 a block does not fit its file.
"""
import pathlib
import re
import sys

BLOCK = re.compile(r"^```(\w+) file=(\S+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


class PageFault(Exception):
    pass


def applied(page, top):
    """The changed files, as {path: text}."""
    text, changed = page.read_text(), {}
    for match in BLOCK.finditer(text):
        language, name, body = match.groups()
        place = f"{page.name}:{text.count(chr(10), 0, match.start()) + 1}"
        if language != "diff":
            if (top / name).exists():
                raise PageFault(f"{place}: {name} exists already")
            changed[name] = body
            continue
        lines = body.splitlines()
        old = "\n".join(line[1:] for line in lines if line[:1] in (" ", "-"))
        new = "\n".join(line[1:] for line in lines if line[:1] in (" ", "+"))
        before = changed.get(name) or (top / name).read_text()
        if before.count(old) != 1:
            raise PageFault(f"{place}: what is to be replaced occurs {before.count(old)} times in {name}, not once:\n{old}")
        changed[name] = before.replace(old, new)
    return changed


def main(page, top, folder, names):
    try:
        changed = applied(page, top)
    except PageFault as fault:
        print(fault, file=sys.stderr)
        return 1
    for name in names or changed:
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(changed[name])
    return 0


if __name__ == "__main__":
    sys.exit(main(*map(pathlib.Path, sys.argv[1:4]), sys.argv[4:]))
