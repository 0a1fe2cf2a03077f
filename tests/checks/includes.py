#!/usr/bin/env python3
"""Compares every #include of the tree with the groups of docs/architecture.md and with CMake's DEPENDS.

usage: includes.py TOP
A module is a folder with a target. A group may include those that its row of the table names, and what these may
include. An #include that the table does not allow is refused, and an arrow of the table that no #include uses or that
the other arrows of its row imply, and a way round that leads back. Between modules the DEPENDS of CMake are exactly
what is included. Modules that are linked without an #include are listed in LINKS.
Exit status: 0 they agree, 1 they do not, 2 the tree or its table can't be read.
"""
import collections
import pathlib
import re
import sys

TOP_FOLDERS = ("firmware", "hal", "boards", "host_tools")
# Headers of the standard library for firmware: none allocates, throws, or differs between libraries.
FREESTANDING_HEADERS = {
    "algorithm", "array", "atomic", "cmath", "cstddef", "cstdint", "limits", "optional",
    "string_view", "tuple", "type_traits", "utility", "variant",
}
# Folders of modules that the modules of some folders alone may include: readers of files stay out of the planners.
USERS = {"host_tools/job/import": ("host_tools/job/", "host_tools/cam/plan/", "host_tools/cam/engine/", "host_tools/cli/")}
# The core and its hardware are known to all of host_tools: no arrows.
BELOW_ALL = ("firmware", "hal", "boards")
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include\s*([<"])([^>"]+)[>"]', re.M)
ROW = re.compile(r"^\|\s*((?:%s)(?:/[\w/]+)?)\s*\|([^|]*)\|" % "|".join(TOP_FOLDERS), re.M)


def read_table(path):
    """The allowed arrows: group -> set of groups."""
    table = {}
    for group, allowed in ROW.findall(path.read_text()):
        if group in table:
            raise ValueError(f"{path}: {group} has two rows")
        table[group] = set(allowed.split())
    if not table:
        raise ValueError(f"{path}: no table of arrows")
    for group, allowed in table.items():
        for other in sorted(allowed - table.keys()):
            raise ValueError(f"{path}: {group} may include {other}, which has no row")
    refuse_cycles(table, path)
    return table


def reached(table, group):
    """The groups that following the arrows from a group leads to."""
    return table[group].union(*(reached(table, other) for other in table[group]))


def implied_arrows(table):
    """The arrows that the other arrows of their row imply."""
    for group, allowed in table.items():
        for other in sorted(allowed):
            if any(other in reached(table, between) for between in allowed - {other}):
                yield group, other


def refuse_cycles(arrows, place):
    """Raises where following the arrows leads back."""
    done = set()

    def follow(name, way):
        if name in way:
            raise ValueError(f"{place}: a way round: {' -> '.join(way[way.index(name):] + [name])}")
        if name not in done:
            for other in sorted(arrows.get(name, ())):
                follow(other, way + [name])
            done.add(name)

    for name in arrows:
        follow(name, [])


def folder_of(place, folders):
    """The one of the folders that a file lies in, or None: the longest that is above it."""
    parts = place.split("/")[:-1]
    for size in range(len(parts), 0, -1):
        name = "/".join(parts[:size])
        if name in folders:
            return name
    return None


def allows(table, group, other):
    """True if a file of the group may include one of the other."""
    below = group.startswith("host_tools/") and other.split("/")[0] in BELOW_ALL
    return other == group or below or other in reached(table, group)


def is_freestanding(module):
    return module.startswith("firmware/") or module in (
        "hal/contract", "hal/cortex_m", "hal/freestanding", "hal/qemu", "hal/rp2350", "hal/stm32f4", "hal/usb_serial")


TARGET = re.compile(r"cusp_module\(\s*NAME\s+(\w+)([^)]*)\)")
LINKED = re.compile(r"\bcusp::(\w+)")
NOT_INCLUDED = re.compile(r"\bLINKS\b[^)]*")


def modules_of(top):
    """The text without comments of the CMakeLists.txt of each module, and of the program: folder -> text.

    Images are left out: they link what the headers of boards/ need, which are no target.
    """
    texts = {}
    for folder in TOP_FOLDERS:
        for file in sorted((top / folder).rglob("CMakeLists.txt")):
            text = re.sub(r"#.*", "", file.read_text())
            if "cusp_module(" in text or "add_executable(cusp" in text:
                texts[file.parent.relative_to(top).as_posix()] = text
    return texts


def disagreements_with_cmake(modules, used):
    """Modules whose DEPENDS are not what they include."""
    target_folder = {name: module for module, text in modules.items() for name, _ in TARGET.findall(text)}
    for module, text in sorted(modules.items()):
        named = set(LINKED.findall(NOT_INCLUDED.sub("", text)))
        linked = {target_folder[name] for name in named if name in target_folder} - {module}
        included = {other for other in used[module] if other in modules} - {module}
        place = f"{module}/CMakeLists.txt"
        for other in sorted(linked - included):
            yield f"{place}: {module} includes nothing of {other}"
        for other in sorted(included - linked):
            yield f"{place}: {other} is missing, {module} includes it"


def complaints(file, place, table, modules, used):
    """used: module or group -> the modules and groups that its files include."""
    group, module = folder_of(place, table), folder_of(place, modules)
    if group is None:
        yield f"{place}: lies in no group of docs/architecture.md"
        return
    text = file.read_text()
    for match in INCLUDE.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        bracket, target = match.groups()
        if target.split("/")[0] in TOP_FOLDERS:
            other = folder_of(target, modules)
            other_group = folder_of(target, table)
            used[module].add(other)
            used[group].add(other_group)
            if other_group is None or not allows(table, group, other_group):
                yield f"{place}:{line}: {group} may not include {target}"
            if other in USERS and not place.startswith(USERS[other]):
                yield f"{place}:{line}: {target} is for {' '.join(USERS[other])} alone"
        elif bracket == '"' and "/" not in target:
            yield f"{place}:{line}: {target}: includes start at the top of the tree"
        elif is_freestanding(folder_of(place, modules) or group) and target not in FREESTANDING_HEADERS:
            yield f"{place}:{line}: <{target}> is not for firmware"


def main(arguments):
    top = pathlib.Path(arguments[1])
    try:
        table = read_table(top / "docs/architecture.md")
    except (OSError, ValueError) as error:
        print(f"includes: {error}", file=sys.stderr)
        return 2
    modules = modules_of(top)
    count, found, used = 0, [], collections.defaultdict(set)
    for folder in TOP_FOLDERS:
        for file in sorted((top / folder).rglob("*.[hc]pp")):
            count += 1
            found += complaints(file, file.relative_to(top).as_posix(), table, modules, used)
    if not count:
        print(f"includes: no sources below {top}", file=sys.stderr)
        return 2
    for group, allowed in table.items():
        found += [f"docs/architecture.md: {group} includes nothing of {other}" for other in sorted(allowed - used[group])]
    found += [f"docs/architecture.md: {group} may include {other} by its other arrows" for group, other in implied_arrows(table)]
    found += disagreements_with_cmake(modules, used)
    try:
        refuse_cycles({module: used[module] - {module, None} for module in modules}, "modules")
    except ValueError as error:
        found.append(str(error))
    print("\n".join(found) if found else f"includes: {count} files keep to the arrows")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
