"""Reads an image for a Cortex-M: its functions, their calls, and the stack that each takes.

The calls come from the linked image, so they are what the core does, whatever the sources say. The
stack comes from the compiler (-fcallgraph-info=su) where it compiled the function, and from the
instructions that move the stack pointer everywhere; the larger one counts.
"""
import pathlib
import re
import subprocess

FUNCTION = re.compile(r"^([0-9a-f]{8}) <(.+)>:$")
INSTRUCTION = re.compile(r"^\s*([0-9a-f]+):\t(\S+)(?:\t(.*))?$")
TARGET = re.compile(r"\b([0-9a-f]{4,8}) <([^>+]+)(\+0x[0-9a-f]+)?>")
BRANCH = re.compile(r"^(?:bl|blx|b(?:eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le)?|cbn?z)(?:\.[nw])?$")
CALL_BY_REGISTER = re.compile(r"^(?:blx|bx)(?:\.[nw])?$")
CI_NODE = re.compile(r'^node: \{ title: "([^"]*)" label: "([^"]*)"')
CI_SIZE = re.compile(r"(\d+) bytes \((\w+)")


class Unreadable(Exception):
    """The image or its call graph can't be read."""


def run(*command):
    try:
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout
    except (OSError, subprocess.CalledProcessError) as error:
        raise Unreadable(f"{command[0]}: {getattr(error, 'stderr', '') or error}") from error


class Function:
    def __init__(self, name, address=0):
        self.name = name
        self.address = address
        self.calls = set()
        self.indirect = []  # instructions that call by register
        self.floats = []  # instructions of the floating-point unit
        self.stack = 0
        self.dynamic = False


def register_count(operands):
    """Number of registers in a list such as {r4, r5-r7, lr}."""
    count = 0
    for part in re.search(r"\{(.*)\}", operands).group(1).split(","):
        ends = re.findall(r"[rsd](\d+)", part)
        count += int(ends[1]) - int(ends[0]) + 1 if len(ends) == 2 else 1
    return count


def stack_taken(mnemonic, operands):
    """Bytes that an instruction takes from the stack; None where it is known at run time only."""
    name = mnemonic.split(".")[0]
    if name == "push" or (name.startswith("stmdb") and operands.startswith("sp!")):
        return 4 * register_count(operands)
    if name == "vpush" or (name.startswith("vstmdb") and operands.startswith("sp!")):
        return (8 if "{d" in operands else 4) * register_count(operands)
    down = re.search(r"\[sp, #-(\d+)\]!", operands)
    if down and name.startswith(("str", "vstr")):
        return int(down.group(1))
    if name in ("sub", "subw", "subs") and re.match(r"sp, (sp, )?#", operands):
        return int(re.search(r"#(\d+)", operands).group(1))
    if name in ("sub", "subw", "mov", "subs") and operands.startswith("sp,"):
        return None
    return 0


def read_functions(image):
    """The functions of a linked image by name."""
    if not pathlib.Path(image).is_file():
        raise Unreadable(f"no image {image}")
    functions, current = {}, None
    for line in run("arm-none-eabi-objdump", "-d", "--no-show-raw-insn", image).splitlines():
        head = FUNCTION.match(line)
        if head:
            current = functions.setdefault(
                head.group(2), Function(head.group(2), int(head.group(1), 16)))
            continue
        match = INSTRUCTION.match(line)
        if not match or current is None:
            continue
        mnemonic, operands = match.group(2), (match.group(3) or "").split("\t")[0]
        take_instruction(current, mnemonic, operands, line)
    if not functions:
        raise Unreadable(f"{image}: no functions")
    return functions


def take_instruction(function, mnemonic, operands, line):
    if mnemonic.startswith("v"):
        function.floats.append(line.strip())
    taken = stack_taken(mnemonic, operands)
    if taken is None:
        function.dynamic = True
    else:
        function.stack += taken
    target = TARGET.search(operands)
    if BRANCH.match(mnemonic) and target:
        # A branch to the function's own start is a loop, a call of it is recursion.
        if target.group(2) != function.name or mnemonic.split(".")[0] == "bl":
            function.calls.add(target.group(2))
    elif CALL_BY_REGISTER.match(mnemonic) and operands.strip() != "lr":
        function.indirect.append(line.strip())
    elif mnemonic.startswith(("ldr", "mov")) and operands.startswith("pc,"):
        # From the stack: a return. From a table by an index times four: a switch. Calls by pointer
        # that end a function are bx.
        if not re.match(r"pc, \[sp\]|pc, \[r\d+, r\d+, lsl #2\]", operands):
            function.indirect.append(line.strip())


def add_compiler_sizes(functions, folder):
    """Raises each function's stack to what the compiler says; marks dynamic stacks."""
    files = list(pathlib.Path(folder).rglob("*.ci"))
    if not files:
        raise Unreadable(f"no call graphs (.ci) below {folder}")
    for file in files:
        for line in file.read_text().splitlines():
            node = CI_NODE.match(line)
            size = CI_SIZE.search(node.group(2)) if node else None
            function = functions.get(node.group(1).split(":")[-1]) if size else None
            if function:
                # Several files may compile one inline function: the linker keeps one of them.
                function.stack = max(function.stack, int(size.group(1)))
                function.dynamic = function.dynamic or size.group(2) != "static"


RELOCATION = re.compile(r"^([0-9a-f]{8})\s+[0-9a-f]+\s+(R_ARM_\w+)\s+([0-9a-f]{8})\s+(\S+)")
# Relocations that put an address into a word (R_ARM_TARGET1: of a table of constructors), or into two instructions.
WORDS = {"R_ARM_ABS32", "R_ARM_TARGET1"}
HALVES = {"R_ARM_THM_MOVW_ABS_NC", "R_ARM_THM_MOVT_ABS", "R_ARM_MOVW_ABS_NC", "R_ARM_MOVT_ABS"}
# Sections that are not in the chip's memory.
NOT_LOADED = (".debug", ".comment", ".ARM.attributes")


def read_words(image):
    """The loaded sections' bytes, as address -> word at each multiple of 4."""
    words = {}
    loaded = True
    for line in run("arm-none-eabi-objdump", "-s", image).splitlines():
        if line.startswith("Contents of section "):
            loaded = not line[20:].startswith(NOT_LOADED)
        match = loaded and re.match(r"^ ([0-9a-f]+) ((?:[0-9a-f]{2,8} ){1,4})", line)
        for place, word in enumerate(match.group(2).split() if match else ()):
            if len(word) == 8:
                words[int(match.group(1), 16) + 4 * place] = int.from_bytes(bytes.fromhex(word), "little")
    return words


def addresses_in(image, first, end):
    """(where, the address that is there) of each word and pair of halves between two places that the linker has filled."""
    words = read_words(image)
    for line in run("arm-none-eabi-readelf", "-rW", image).splitlines():
        match = RELOCATION.match(line)
        if match and first <= int(match.group(1), 16) < end:
            place, kind, value = int(match.group(1), 16), match.group(2), int(match.group(3), 16)
            if kind in WORDS and place in words:
                yield place, words[place]
            elif kind in HALVES:
                yield place, value


def kept_functions(image, functions):
    """Names of the functions whose address is kept: those of the table of constructors, and all others.

    The linker's relocations say which words are addresses (-Wl,--emit-relocs): a number that happens to
    equal one is none.
    """
    by_address = {function.address | 1: function.name for function in functions.values()}
    words = read_words(image)
    table = {parts[2]: int(parts[0], 16) for parts in map(str.split, run("arm-none-eabi-nm", image).splitlines())
             if len(parts) == 3}
    constructor_table = range(table["cusp_constructors_begin"], table["cusp_constructors_end"])
    constructors, others, section = set(), set(), None
    for line in run("arm-none-eabi-readelf", "-rW", image).splitlines():
        head = re.match(r"Relocation section '\.rel(\S+)'", line)
        if head:
            section = head.group(1)
        match = RELOCATION.match(line)
        if not match or section.startswith(NOT_LOADED):
            continue
        place, kind, value, symbol = match.groups()
        name = None
        if kind in WORDS:
            name = by_address.get(words.get(int(place, 16)))
        elif kind in HALVES:
            # The addend of a section's symbol is spread over the instruction.
            if symbol.startswith("."):
                raise Unreadable(f"{image}: {line}: an address in halves, of a section")
            name = by_address.get(int(value, 16) | 1)
        if name:
            (constructors if int(place, 16) in constructor_table else others).add(name)
    if section is None:
        raise Unreadable(f"{image}: no relocations: link with -Wl,--emit-relocs")
    return constructors, others


def add_calls_by_pointer(image, functions):
    """Lets each function that calls by pointer call every function whose address is kept somewhere.

    The one call by pointer of cusp_reset is that of the constructors; no other function reads their table.
    """
    constructors, others = kept_functions(image, functions)
    others -= {"cusp_boot", "cusp_rest", "cusp_reset", "cusp_servo_tick", "cusp_serial_interrupt", "cusp_player_interrupt", "cusp_exception"}
    for function in functions.values():
        if function.name == "cusp_reset" and len(function.indirect) == 1:
            function.calls |= constructors
        elif function.indirect:
            function.calls |= others
