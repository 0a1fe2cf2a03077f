#!/usr/bin/env python3
"""Writes an image as a UF2 file, for the drive that the boot ROM of an RP2350 shows.

usage: uf2.py IMAGE.bin ADDRESS IMAGE.uf2
Blocks of 512 bytes, each with 256 of the image and its address; the family is that of programs for the secure state of
the RP2350's Arm cores.
"""
import pathlib
import struct
import sys

MAGIC = (0x0A324655, 0x9E5D5157)
END = 0x0AB16F30
HAS_FAMILY = 0x2000
FAMILY = 0xE48BFF59
PAYLOAD = 256


def blocks(image, address):
    count = -(-len(image) // PAYLOAD)
    for number in range(count):
        part = image[number * PAYLOAD:(number + 1) * PAYLOAD].ljust(PAYLOAD, b"\xff")
        head = struct.pack("<8I", *MAGIC, HAS_FAMILY, address + number * PAYLOAD, PAYLOAD, number, count, FAMILY)
        yield head + part.ljust(476, b"\0") + struct.pack("<I", END)


def main(arguments):
    if len(arguments) != 4:
        print(__doc__, file=sys.stderr)
        return 2
    image = pathlib.Path(arguments[1]).read_bytes()
    pathlib.Path(arguments[3]).write_bytes(b"".join(blocks(image, int(arguments[2], 0))))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
