#!/usr/bin/env python3
"""Reads a UF2 file as a boot ROM does, and compares what it would write with the image.

usage: uf2_test.py IMAGE.bin IMAGE.uf2 ADDRESS
Also tries files that such a ROM would not take. Exit status: 0 they agree, 1 they do not.
"""
import pathlib
import sys

FAMILY = 0xE48BFF59  # RP2350, secure Arm: what the drive RP2350 takes


class Refused(Exception):
    """A block that a boot ROM passes over, or a file that is not whole."""


def flash_of(file):
    """address -> byte, as written; every block has the family, its number and their count."""
    if len(file) % 512:
        raise Refused("no whole blocks")
    flash, numbers, counts = {}, set(), set()
    for at in range(0, len(file), 512):
        block = file[at:at + 512]
        word = [int.from_bytes(block[4 * i:4 * i + 4], "little") for i in range(8)]
        if word[:2] != [0x0A324655, 0x9E5D5157] or block[508:] != (0x0AB16F30).to_bytes(4, "little"):
            raise Refused(f"block {at // 512}: no mark")
        flags, address, size, number, count, family = word[2:]
        if flags != 0x2000 or family != FAMILY:
            raise Refused(f"block {at // 512}: of another family")
        if size != 256 or address % 256:
            raise Refused(f"block {at // 512}: no page")
        numbers.add(number)
        counts.add(count)
        flash.update((address + i, byte) for i, byte in enumerate(block[32:32 + size]))
    if counts != {len(numbers)} or numbers != set(range(len(numbers))):
        raise Refused("blocks are missing")
    return flash


def is_refused(file):
    try:
        flash_of(file)
    except Refused:
        return True
    return False


def main(arguments):
    image = pathlib.Path(arguments[1]).read_bytes()
    file = pathlib.Path(arguments[2]).read_bytes()
    begin = int(arguments[3], 0)
    flash = flash_of(file)
    wrong = []
    if bytes(flash[begin + i] for i in range(len(image))) != image:
        wrong.append("the file has another image")
    rest = [byte for address, byte in flash.items() if not begin <= address < begin + len(image)]
    if len(rest) > 255 or set(rest) - {0xFF}:
        wrong.append("the file writes beside the image")
    for name, bad in {"a mark": b"\0" + file[1:], "a family": file[:28] + b"\0" + file[29:], "the last block": file[:-512],
                      "a byte": file[:-1]}.items():
        if not is_refused(bad):
            wrong.append(f"without {name} it is taken all the same")
    print("\n".join(wrong) or f"uf2: {len(file) // 512} blocks are the image of {len(image)} bytes")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
