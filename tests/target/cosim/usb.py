"""A host's view of the plug of a board in the co-simulation: enumeration, requests, the port.

Written from USB 2.0 and CDC 1.2 alone: what the device says is taken apart, not compared with its source.
"""
import struct

DEVICE, CONFIGURATION, TEXT = 1, 2, 3


class Stalled(Exception):
    """The device refused a request."""


class Usb:
    """The plug of a `chip.Chip`."""

    def __init__(self, chip):
        self.chip = chip
        self.device = self.configuration = None
        self.texts = {}

    def command(self, text):
        return self.chip.command(f"usb {text}")

    def raw(self, kind, request, value=0, index=0, length=0, data=b""):
        """How the transfer ended, and the data of the device."""
        setup = struct.pack("<BBHHH", kind, request, value, index, length)
        words = self.command(f"control {setup.hex()} {data.hex()}")[-1].split(" ")
        return words[1], bytes.fromhex(words[2])

    def ask(self, kind, request, value=0, index=0, length=0, data=b""):
        stage, answer = self.raw(kind, request, value, index, length, data)
        if stage == "stall":
            raise Stalled(f"{kind:#x} {request:#x} {value:#x}")
        assert stage == "ack", f"{kind:#x} {request:#x} {value:#x}: {stage}"
        assert len(answer) <= length
        return answer

    def descriptor(self, kind, number=0, length=255, language=0):
        return self.ask(0x80, 6, kind << 8 | number, language, length)

    def text(self, number):
        found = self.descriptor(TEXT, number, language=0x409)
        assert found[0] == len(found) and found[1] == TEXT
        return found[2:].decode("utf-16-le")

    def plug_in(self, address=5):
        """Enumerates the device as Linux does, and configures it."""
        self.command("plug")
        self.chip.run(1)
        self.command("address 0")
        first = self.descriptor(DEVICE, length=64)
        assert len(first) == 18 == first[0] and first[7] == 64, first.hex()
        self.command("plug")  # Linux resets the bus a second time
        self.chip.run(1)
        self.ask(0x00, 5, address)
        self.command(f"address {address}")
        self.device = self.descriptor(DEVICE, length=18)
        assert self.device == first
        head = self.descriptor(CONFIGURATION, length=9)
        total = struct.unpack("<H", head[2:4])[0]
        self.configuration = self.descriptor(CONFIGURATION, length=total)
        assert len(self.configuration) == total and self.configuration[:9] == head
        languages = self.descriptor(TEXT, 0)
        assert languages[2:] == b"\x09\x04"
        self.texts = {name: self.text(self.device[place])
                      for name, place in (("maker", 14), ("name", 15), ("serial", 16))}
        self.ask(0x00, 9, head[5])
        assert self.ask(0x80, 8, length=1) == head[5:6]

    def open(self):
        """A program opens the port: line coding, then DTR and RTS."""
        self.ask(0x21, 0x20, length=7, data=struct.pack("<IBBB", 115200, 0, 0, 8))
        assert self.ask(0xA1, 0x21, length=7) == struct.pack("<IBBB", 115200, 0, 0, 8)
        self.ask(0x21, 0x22, 3)
        self.command("open")
        self.chip.command("line usb")

    def close(self):
        self.ask(0x21, 0x22, 0)
        self.command("close")

    def pieces(self):
        """The descriptors of the configuration, one by one."""
        at = 0
        while at < len(self.configuration):
            size = self.configuration[at]
            assert size >= 2 and at + size <= len(self.configuration)
            yield self.configuration[at:at + size]
            at += size
