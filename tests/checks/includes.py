#!/usr/bin/env python3
"""Compares the arrows of docs/architecture.md with every #include of the tree and with CMake's DEPENDS.

usage: includes.py TOP
The table holds exactly the arrows that exist: an #include without an arrow, an arrow without an #include, and a module
whose DEPENDS are not its row are refused. Modules that are linked without an #include are listed in LINKS.
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
# Modules that one module alone may include, so that readers of files stay out of planning.
SOLE_USER = {"host_tools/job/import": "host_tools/cli"}
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include\s*([<"])([^>"]+)[>"]', re.M)
ROW = re.compile(r"^\|\s*((?:%s)/[\w/]+)\s*\|([^|]*)\|" % "|".join(TOP_FOLDERS), re.M)


def read_table(path):
    """The allowed arrows: module -> set of modules."""
    table = {}
    for module, allowed in ROW.findall(path.read_text()):
        if module in table:
            raise ValueError(f"{path}: {module} has two rows")
        table[module] = set(allowed.split())
    if not table:
        raise ValueError(f"{path}: no table of arrows")
    for module, allowed in table.items():
        for other in sorted(allowed - table.keys()):
            raise ValueError(f"{path}: {module} may include {other}, which has no row")
        for other in sorted(allowed):
            if SOLE_USER.get(other, module) != module:
                raise ValueError(f"{path}: {module} may include {other}, which is for {SOLE_USER[other]} alone")
    return table


def module_of(place, table):
    """The module that a file lies in, or None: the longest row that is a folder above it."""
    folders = place.split("/")[:-1]
    for size in range(len(folders), 0, -1):
        name = "/".join(folders[:size])
        if name in table:
            return name
    return None


def is_freestanding(module):
    return module.startswith("firmware/") or module in (
        "hal/contract", "hal/freestanding", "hal/qemu", "hal/stm32f4")


TARGET = re.compile(r"cusp_module\(\s*NAME\s+(\w+)([^)]*)\)")
LINKED = re.compile(r"\bcusp::(\w+)")
NOT_INCLUDED = re.compile(r"\bLINKS\b[^)]*")


def cmake_lists(top, table):
    """The text without comments of each CMakeLists.txt that declares a module, or the program of host_tools/cli.

    Images are left out: they link what the headers of boards/ need, which are no target.
    """
    files = {module: top / module / "CMakeLists.txt" for module in table}
    texts = {module: re.sub(r"#.*", "", file.read_text()) for module, file in files.items() if file.exists()}
    return {module: text for module, text in texts.items() if "cusp_module(" in text or "add_executable(" in text}


def disagreements_with_cmake(top, table):
    """Modules whose DEPENDS are not their row. A row without a target (headers only) is not linked."""
    lists = cmake_lists(top, table)
    target_folder = {name: module for module, text in lists.items() for name, _ in TARGET.findall(text)}
    for module, text in sorted(lists.items()):
        named = set(LINKED.findall(NOT_INCLUDED.sub("", text)))
        linked = {target_folder[name] for name in named if name in target_folder} - {module}
        allowed = {other for other in table[module] if other in target_folder.values()}
        place = f"{module}/CMakeLists.txt"
        for other in sorted(linked - allowed):
            yield f"{place}: {other} is not in the row of {module} in docs/architecture.md"
        for other in sorted(allowed - linked):
            yield f"{place}: {other} is missing, {module} includes it"


def complaints(file, place, table, used):
    module = module_of(place, table)
    if module is None:
        yield f"{place}: lies in no module of docs/architecture.md"
        return
    text = file.read_text()
    for match in INCLUDE.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        bracket, target = match.groups()
        if target.split("/")[0] in TOP_FOLDERS:
            other = module_of(target, table)
            used[module].add(other)
            if other != module and other not in table[module]:
                yield f"{place}:{line}: {module} may not include {target}"
        elif bracket == '"' and "/" not in target:
            yield f"{place}:{line}: {target}: includes start at the top of the tree"
        elif is_freestanding(module) and target not in FREESTANDING_HEADERS:
            yield f"{place}:{line}: <{target}> is not for firmware"


def main(arguments):
    top = pathlib.Path(arguments[1])
    try:
        table = read_table(top / "docs/architecture.md")
    except (OSError, ValueError) as error:
        print(f"includes: {error}", file=sys.stderr)
        return 2
    count, found, used = 0, [], collections.defaultdict(set)
    for folder in TOP_FOLDERS:
        for file in sorted((top / folder).rglob("*.[hc]pp")):
            count += 1
            found += complaints(file, file.relative_to(top).as_posix(), table, used)
    if not count:
        print(f"includes: no sources below {top}", file=sys.stderr)
        return 2
    for module, allowed in table.items():
        found += [f"docs/architecture.md: {module} includes nothing of {other}" for other in sorted(allowed - used[module])]
    found += disagreements_with_cmake(top, table)
    print("\n".join(found) if found else f"includes: {count} files keep to the arrows")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
