#!/usr/bin/env python3
"""Proves what must hold of a firmware image. usage: image.py IMAGE.elf CALL_GRAPH_FOLDER [RAM_LIMIT] [FIRMWARE.bin]

  symbols   no heap, no exceptions, no type information, no C library's files
  double    no arithmetic of doubles below the servo tick and the interrupts
  float     no instruction of the floating-point unit below the player's interrupt
  calls     no call through a pointer below the servo tick and the interrupts; no recursion
  stack     the deepest chain of each priority, one upon the other, leaves 1 KB of the stack; a call through a
            pointer counts as the deepest function whose address is kept anywhere
  memory    flash and RAM within the chip's and the project's
  settings  nothing of the image lies in their two sectors, and neither lies before its vectors
  copied    of an image that is copied to RAM: it begins with what the boot ROM of an RP2350 looks for, and only what copies
            it runs in the flash; what cusp_rest() calls and reads is copied first
  loader    with FIRMWARE.bin: the vectors are at 0x08008000, behind the maker's boot loader, and begin that file

Exit status: 0 all hold, 1 some do not, 2 the image can't be read.
"""
import re
import subprocess
import sys

from disassembly import Unreadable, add_calls_by_pointer, add_compiler_sizes, addresses_in, read_functions, run

# From the least to the most urgent: each may be interrupted by those after it.
CONTEXTS = ("cusp_reset", "cusp_usb_interrupt", "cusp_servo_tick", "cusp_serial_interrupt", "cusp_player_interrupt")
NOT_EVERYWHERE = "cusp_usb_interrupt"  # kept by the vectors of a board that has it
# Words that the core saves at an interrupt: 26 words with the float registers, and one to align.
EXCEPTION_FRAME = 27 * 4
FORBIDDEN = re.compile(
    r"^_?(malloc|free|calloc|realloc|sbrk)(_r)?$|^_sbrk$|^_Zn[wa]|^_Zd[la]|^__cxa_|^__gxx_"
    r"|^_Unwind_|^__aeabi_unwind|^_ZT[IS]|^_?v?s?n?f?i?printf(_r)?$|^puts$|^_impure_ptr$|^setlocale")
DOUBLE = re.compile(
    r"^__(aeabi_(d(add|sub|rsub|mul|div|cmp\w*|2\w+)|c[dr]\w*cmp\w*|[filu]+2d|ul2d|l2d)"
    r"|(add|sub|mul|div|neg|cmp|eq|ne|lt|le|gt|ge|unord)df[23]|adddf3|fixdf\w+|fixunsdf\w+"
    r"|float\w+df|extendsfdf2|truncdfsf2)$|^(sqrt|floor|fabs|sin|cos|atan2)$")
STACK_LEFT = 1024
RAM_LIMIT = 96 * 1024  # unless the call says otherwise
BOOT_ROM_STARTS = 0x10000000  # the head of an image for an RP2350
# A program for the secure state of its Arm cores, the only block (data sheet, 5.9.5.1).
PROGRAM_BLOCK = [0xFFFFDED3, 0x10210142, 0x000001FF, 0, 0xAB123579]
IN_FLASH = {"cusp_boot", "cusp_boot_clocks", "cusp_boot_copy"}
LOADED_AT = 0x08008000  # where the makers' boot loaders start what they have loaded


def contexts(functions):
    return [name for name in CONTEXTS if name in functions or name != NOT_EVERYWHERE]


def reached(functions, root):
    """The functions that a function reaches, each with its first caller."""
    found, waiting = {root: None}, [root]
    while waiting:
        name = waiting.pop(0)
        for callee in sorted(functions[name].calls):
            if callee not in found and callee in functions:
                found[callee] = name
                waiting.append(callee)
    return found


def way(found, name):
    """The chain of calls that reaches a function, with names as in the sources."""
    chain = [name]
    while found[chain[0]]:
        chain.insert(0, found[chain[0]])
    return " > ".join(plain(chain))


def depth(functions, root):
    """Deepest stack below a function, its chain, and complaints about what can't be bounded."""
    done, complaints = {}, []

    def visit(name, chain):
        if name in chain:
            complaints.append("recursion: " + " > ".join(plain(chain[chain.index(name):] + [name])))
            return 0, [name]
        if name not in done:
            function = functions.get(name)
            if function is None:
                complaints.append(f"{chain[-1] if chain else root} calls {name}, not in the image")
                return 0, [name]
            if function.dynamic:
                complaints.append(f"{name} takes stack that only the run can tell")
            deepest = max((visit(callee, chain + [name]) for callee in sorted(function.calls)),
                          default=(0, []))
            done[name] = (function.stack + deepest[0], [name] + deepest[1])
        return done[name]

    sys.setrecursionlimit(10000)
    size, chain = visit(root, [])
    return size, chain, complaints


def symbols(image):
    """Value of each symbol of the image."""
    table = {}
    for line in run("arm-none-eabi-nm", image).splitlines():
        parts = line.split()
        if len(parts) == 3:
            table[parts[2]] = int(parts[0], 16)
    return table


def plain(names):
    """Names as in the sources, for reports."""
    text = subprocess.run(["arm-none-eabi-c++filt", "-p", *names], capture_output=True,
                          text=True).stdout
    return text.split("\n")[:len(names)]


def check_symbols(table):
    for name in sorted(table):
        if FORBIDDEN.search(name):
            yield f"symbols: {name} is in the image"


def check_real_time(functions):
    for root in contexts(functions)[1:]:
        found = reached(functions, root)
        for name in sorted(found):
            if DOUBLE.match(name):
                yield f"double: {way(found, name)}"
    found = reached(functions, "cusp_player_interrupt")
    for name in sorted(found):
        for line in functions[name].floats[:1]:
            yield f"float: {way(found, name)}: {line}"


def check_calls(functions):
    for root in contexts(functions)[1:]:
        found = reached(functions, root)
        for name in sorted(found):
            for line in functions[name].indirect[:1]:
                yield f"calls: {way(found, name)} calls by pointer: {line}"


def check_stack(functions, table):
    total = 0
    for root in contexts(functions):
        size, chain, complaints = depth(functions, root)
        yield from (f"stack: {complaint}" for complaint in complaints)
        frame = 0 if root == CONTEXTS[0] else EXCEPTION_FRAME
        total += size + frame
        print(f"{root}: {size} bytes of stack: " + " > ".join(plain(chain)))
    room = table["cusp_stack_size"]
    print(f"stack: {total} of {room} bytes")
    if total + STACK_LEFT > room:
        yield f"stack: {total} bytes are needed and {STACK_LEFT} to spare, {room} are there"


def sections(image):
    """(name, size, place, where it is loaded from, whether it is) of each section."""
    pattern = r"^\s*\d+ (\S+)\s+([0-9a-f]{8})\s+([0-9a-f]{8})\s+([0-9a-f]{8}).*\n\s+(.*)$"
    for name, size, place, load, flags in re.findall(pattern, run("arm-none-eabi-objdump", "-h", image), re.M):
        yield name, int(size, 16), int(place, 16), int(load, 16), "LOAD" in flags.split(", ")


def loaded_sections(image):
    """(name, first, end) of what is written into the flash."""
    for name, size, _, load, loaded in sections(image):
        if loaded and size:
            yield name, load, load + size


def check_memory(image, limit):
    flash = sum(end - begin for _, begin, end in loaded_sections(image))
    ram = sum(size for _, size, place, _, _ in sections(image) if place >> 28 == 2)
    print(f"memory: {flash} bytes of flash, {ram} of RAM")
    if not flash or not ram:
        yield "memory: no sections"
    if ram > limit:
        yield f"memory: {ram} bytes of RAM, {limit} are allowed"
    if flash > (1024 - 32) * 1024:
        yield f"memory: {flash} bytes of flash"


def check_early(image, functions, table):
    """Code and data that are used while the rest of the image is still in the flash alone. Variables have no values yet."""
    places = {name: place for name, _, place, _, _ in sections(image)}
    end = table["cusp_early_end"]
    for name in sorted(reached(functions, "cusp_rest")):
        if functions[name].address >= end:
            yield f"copied: {plain([name])[0]} is called by cusp_rest, but copied later"
    for place, address in addresses_in(image, places[".early"], end):
        if end <= address < places[".data"]:
            yield f"copied: {place:#x} of what is copied first names {address:#x}, which is copied later"


def check_copied(image, functions, table):
    if "cusp_boot" not in table:
        return
    for name, function in sorted(functions.items()):
        if function.address >> 28 != 2 and function.address != BOOT_ROM_STARTS and name not in IN_FLASH:
            yield f"copied: {plain([name])[0]} runs at {function.address:#x}, in the flash"
    yield from check_early(image, functions, table)
    for name in sorted(IN_FLASH):
        for callee in sorted(functions[name].calls - IN_FLASH):
            yield f"copied: {name} calls {plain([callee])[0]} before it is there"
    dump = run("arm-none-eabi-objdump", "-s", "-j", ".boot", image)
    text = "".join(re.findall(r"^ [0-9a-f]{8} ((?:[0-9a-f]+ ){1,4})", dump, re.M)).replace(" ", "")
    words = [int.from_bytes(bytes.fromhex(text[at:at + 8]), "little") for at in range(0, 56, 8)]
    begin = next((begin for name, begin, _ in loaded_sections(image) if name == ".boot"), None)
    if begin != BOOT_ROM_STARTS or words != [table["cusp_stack_top"], table["cusp_boot"] | 1, *PROGRAM_BLOCK]:
        yield f"copied: the image begins at {begin and hex(begin)} with " + " ".join(map(hex, words))


def check_settings(image, table):
    if any("3hal4qemu" in name for name in table):
        return  # kept in memory there
    if "cusp_settings" not in table or "cusp_vectors" not in table:
        yield "settings: the image does not say where they are"
        return
    first, end = table["cusp_settings"], table["cusp_settings"] + 2 * table["cusp_settings_sector"]
    vectors = BOOT_ROM_STARTS if "cusp_boot" in table else table["cusp_vectors"]
    print(f"settings: {first:#x} to {end:#x}, vectors at {vectors:#x}")
    if first < vectors:
        yield f"settings: they lie before the vectors, at {first:#x}"
    for name, begin, after in loaded_sections(image):
        if begin < end and after > first:
            yield f"settings: {name} lies in their sectors, {begin:#x} to {after:#x}"
        if begin < vectors:
            yield f"settings: {name} lies before the vectors, at {begin:#x}"


def check_firmware(firmware, image, table):
    if firmware is None:
        return
    with open(firmware, "rb") as file:
        content = file.read()
    words = [int.from_bytes(content[at:at + 4], "little") for at in (0, 4)]
    if table["cusp_vectors"] != LOADED_AT:
        yield f"loader: the vectors are at {table['cusp_vectors']:#x}"
    if words != [table["cusp_stack_top"], table["cusp_reset"] | 1]:
        yield f"loader: {firmware} begins with {words[0]:#x} {words[1]:#x}"
    end = max(after for _, _, after in loaded_sections(image))
    if len(content) != end - LOADED_AT:
        yield f"loader: {firmware} has {len(content)} bytes, the image {end - LOADED_AT}"


def main(arguments):
    firmware = arguments.pop() if arguments[-1].endswith(".bin") else None
    if len(arguments) not in (3, 4):
        print(__doc__, file=sys.stderr)
        return 2
    image, folder = arguments[1], arguments[2]
    limit = int(arguments[3]) if len(arguments) == 4 else RAM_LIMIT
    try:
        functions, table = read_functions(image), symbols(image)
        add_compiler_sizes(functions, folder)
        missing = [name for name in contexts(functions) if name not in functions]
        if missing or "cusp_stack_size" not in table:
            raise Unreadable(f"{image}: no {', '.join(missing) or 'cusp_stack_size'}")
        found = [*check_symbols(table), *check_real_time(functions), *check_calls(functions),
                 *check_memory(image, limit), *check_settings(image, table),
                 *check_copied(image, functions, table),
                 *check_firmware(firmware, image, table)]
        add_calls_by_pointer(image, functions)
        found += check_stack(functions, table)
    except Unreadable as error:
        print(f"image: {error}", file=sys.stderr)
        return 2
    print("\n".join(found) if found else f"image: all proofs hold for {image}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
