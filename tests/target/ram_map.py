#!/usr/bin/env python3
"""Prints where an image's flash and RAM go: sections, symbols, and members of the large objects.

usage: ram_map.py IMAGE.elf [--check DOCUMENT | --update DOCUMENT]
With --check the table in DOCUMENT, between the marks of ram_map.py, must be what would be printed,
each figure within 5 %; exit status 1 where it is not. --update writes it there. Sizes of members are
those of the debug information.
"""
import re
import subprocess
import sys

LARGE = 2048  # bytes: smaller objects are not taken apart, smaller members not named
BEGIN, END = "<!-- ram_map.py begins -->", "<!-- ram_map.py ends -->"
ALLOWED = 0.05


def run(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


class Types:
    """The types of an image, from its debug information."""

    def __init__(self, image):
        self.entries, self.full = {}, {}
        parents, entry = [], None
        for line in run("arm-none-eabi-objdump", "--dwarf=info", image).splitlines():
            head = re.match(r" <([0-9a-f]+)><([0-9a-f]+)>: Abbrev Number: \d+(?: \((\w+)\))?", line)
            if head:
                depth, place, tag = int(head[1], 16), int(head[2], 16), head[3]
                entry = {"tag": tag, "children": []}
                self.entries[place] = entry
                del parents[depth:]
                if parents and tag:
                    parents[-1]["children"].append(entry)
                parents.append(entry)
                continue
            field = re.match(r"\s+<[0-9a-f]+>\s+DW_AT_(\w+)\s*:\s*(.*)", line)
            if field and entry is not None and field[1] in (
                    "name", "byte_size", "type", "upper_bound", "declaration"):
                entry[field[1]] = field[2].strip()

    def name(self, entry):
        return entry.get("name", "").split("): ")[-1].strip()

    def type_of(self, entry):
        match = re.search(r"<0x([0-9a-f]+)>", entry.get("type", ""))
        found = self.entries.get(int(match[1], 16)) if match else None
        while found and found["tag"] in ("DW_TAG_typedef", "DW_TAG_const_type", "DW_TAG_volatile_type"):
            found = self.type_of(found)
        return found

    def size(self, entry):
        if entry is None:
            return 0
        if entry["tag"] == "DW_TAG_array_type":
            count = 1
            for bound in entry["children"]:
                count *= int(bound.get("upper_bound", "-1"), 0) + 1
            return count * self.size(self.type_of(entry))
        return int(entry.get("byte_size", "0"), 0)

    def members(self, entry):
        for child in entry["children"]:
            if child["tag"] == "DW_TAG_inheritance":
                yield from self.members(self.type_of(child))
            elif child["tag"] == "DW_TAG_member" and "declaration" not in child:
                yield self.name(child), self.type_of(child)

    def variable(self, name):
        """The type of a static object of this name that is a class."""
        for entry in self.entries.values():
            if entry["tag"] == "DW_TAG_variable" and self.name(entry) == name and "type" in entry:
                found = self.type_of(entry)
                if found and found["tag"] in ("DW_TAG_class_type", "DW_TAG_structure_type"):
                    return found
        return None

    def parts(self, path, entry, size):
        """Rows of bytes and path: the members that are large, and the rest as one."""
        large = [(name, kind, self.size(kind)) for name, kind in self.members(entry)]
        large = [row for row in large if row[2] >= LARGE]
        if size < 2 * LARGE or not large:
            yield size, path
            return
        for name, kind, bytes_ in sorted(large, key=lambda row: -row[2]):
            yield from self.parts(f"{path}.{name.rstrip('_')}".replace("._M_elems", ""), kind, bytes_)
        rest = size - sum(row[2] for row in large)
        if rest > 0:
            yield rest, f"{path}, the rest"


def rows(image):
    sections, places = {}, {}
    for line in run("arm-none-eabi-size", "-A", image).splitlines():
        words = line.split()
        if len(words) == 3 and words[0].startswith(".") and words[1].isdigit():
            sections[words[0]], places[words[0]] = int(words[1]), int(words[2])
    flash = sum(sections.get(name, 0) for name in (".vectors", ".text", ".ARM.exidx", ".data"))
    ram = {name: sections.get(name, 0) for name in (".stack", ".coupled", ".retained", ".data", ".bss")}
    coupled = sum(size for name, size in ram.items() if places.get(name, 0) >> 28 == 1)
    yield flash, "flash, all of it"
    yield sum(ram.values()) - coupled, "RAM that DMA reaches"
    if coupled:
        yield coupled, "core-coupled memory: the stack and the path ahead"
    yield ram[".stack"], "stack"
    types, named = Types(image), ram[".stack"]
    for line in run("arm-none-eabi-nm", "-C", "-S", "--size-sort", "-r", image).splitlines():
        _, size, kind, name = line.split(maxsplit=3)
        bytes_ = int(size, 16)
        if kind in "bBdD" and bytes_ >= LARGE:
            name = name.split("::")[-1]
            entry = types.variable(name)
            yield from types.parts(name, entry, bytes_) if entry else [(bytes_, name)]
            named += bytes_
    yield sum(ram.values()) - named, "smaller statics, the last fault's record"


def table(image):
    lines = ["| bytes | what |", "|---:|---|"]
    return lines + [f"| {bytes_} | {what} |" for bytes_, what in rows(image)]


def differences(document, wanted):
    text = open(document).read()
    if BEGIN not in text or END not in text:
        return [f"{document}: no table between the marks of ram_map.py"]
    there = text.split(BEGIN)[1].split(END)[0].strip().splitlines()
    found = []
    for old, new in zip(there + [""] * len(wanted), wanted + [""] * len(there)):
        if old == new:
            continue
        before, now = (re.match(r"\| (\d+) \| (.*) \|", line) for line in (old, new))
        close = before and now and before[2] == now[2] and \
            abs(int(before[1]) - int(now[1])) <= ALLOWED * int(now[1]) + 64
        if not close:
            found.append(f"{document}: has {old!r}, should have {new!r}")
    return found


def update(document, image):
    text = open(document).read()
    before, after = text.split(BEGIN)[0], text.split(END)[1]
    with open(document, "w") as file:
        file.write("\n".join([before + BEGIN, *table(image), END + after]))


def main(arguments):
    if len(arguments) not in (2, 4) or arguments[2:3] not in ([], ["--check"], ["--update"]):
        print(__doc__, file=sys.stderr)
        return 2
    try:
        if len(arguments) == 2:
            print("\n".join(table(arguments[1])))
            return 0
        if arguments[2] == "--update":
            update(arguments[3], arguments[1])
            return 0
        found = differences(arguments[3], table(arguments[1]))
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"ram_map: {error}", file=sys.stderr)
        return 2
    print("\n".join(found) or "the map holds")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
