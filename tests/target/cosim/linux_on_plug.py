#!/usr/bin/env python3
"""Linux's own cdc_acm runs a program on a board's shipping image, through its plug: every byte, and the simulator's edges.

usage: linux_on_plug.py --cosim COSIM --cusp CUSP --board BOARD --image IMAGE.bin

Debian's kernel runs in QEMU; its USB port is the plug of the board in the co-simulation (usb_redirection.py). Each move of the
program begins at rest, so that a host's pauses move whole moves alone.
Exit status: 0 all is as it must be, 1 it is not, 77 QEMU, the kernel or busybox is not here.
"""
import argparse
import pathlib
import sys
import tempfile
import time
import types

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import golden  # noqa: E402
from chip import Chip  # noqa: E402
from linux_guest import READY, Guest, Missing, find  # noqa: E402
from usb import Usb  # noqa: E402
from usb_redirection import PACKET, Redirection  # noqa: E402

SKIPPED = 77
BOOT_SECONDS, RUN_SECONDS, ANSWER_SECONDS = 240, 240, 60
MOVES = ("G1 X3 Y1 F1500", "G2 X1 Y3 I-1 J1", "G0 Z-1", "G3 X0 Y0 Z0 I-2 J-1 F900", "G1 X-2.5 F2000", "G0 X0", "G1 Z0.7 Y-1.3 F600", "G0 Z0 Y0")
PROGRAM = ["G21 G90 G94", *(line for move in MOVES for line in (move, "G4 P0.1")), "M2"]
WINDOW = 120  # bytes that the controller's buffer surely takes
REST_US = 50000


class Wrong(Exception):
    """What the board or the guest does is not what it must be."""


def moves_of(edges):
    """The edges between two rests, each with its microseconds since the first of them: tick << 8 | levels."""
    moves, last = [], None
    for edge in edges:
        tick, levels = edge >> 8, edge & 255
        if last is None or tick - last > REST_US:
            moves.append([])
            first = tick
        moves[-1].append((tick - first, levels))
        last = tick
    return moves


def edges_at_pins(chip, changes):
    """As the simulator's: tick << 8 | levels, of changes of the six lines."""
    events = sorted((nanoseconds, 1 << line, level) for line, pin in enumerate(chip.lines)
                    for nanoseconds, level in chip.edges_of(pin, changes))
    levels = before = 0
    edges = []
    for at, (now, bit, level) in enumerate(events):
        levels = levels | bit if level else levels & ~bit
        if levels != before and (at + 1 == len(events) or events[at + 1][0] != now):
            edges.append(now // 1000 << 8 | levels)
            before = levels
    return edges


class Session:
    """The guest's end of the line, with the chip's time going on beside it."""

    def __init__(self, chip, bridge, guest):
        self.chip, self.bridge, self.guest = chip, bridge, guest

    def until(self, there, seconds, what, milliseconds=1):
        end = time.monotonic() + seconds
        while not there():
            self.bridge.serve(0.001)
            self.chip.run(milliseconds)
            self.guest.listen()
            if time.monotonic() > end:
                raise Wrong(f"no {what} within {seconds} s; heard {self.guest.heard[-300:]!r}; the guest: "
                            + self.guest.console.read_text(errors="replace")[-1500:])

    def ask(self, line):
        """The answer to one line."""
        self.guest.heard = b""
        self.guest.send(line.encode() + b"\n")
        self.until(lambda: self.guest.heard.endswith(b"ok\r\n"), ANSWER_SECONDS, f"answer to {line}")
        return self.guest.heard

    def ask_any_length(self):
        """Answers whose last packet has any size: Linux waits for the end of one that is full."""
        for length in range(1, PACKET + 1):
            text = "A" * length
            self.ask(f"$I={text}")
            heard = self.ask("$I")
            if f":{text}]\r\n".encode() not in heard:
                raise Wrong(f"the user's text is {text}, $I says {heard!r}")
        self.ask("$I=")

    def run(self, lines):
        """Streams lines by the bytes that are not answered yet, and waits until the last is."""
        self.guest.heard, sent, waiting = b"", 0, list(lines)

        def step():
            nonlocal sent
            answered = self.guest.heard.count(b"ok\r\n")
            while waiting and sum(len(line) + 1 for line in lines[answered:sent + 1]) < WINDOW:
                self.guest.send(waiting.pop(0).encode() + b"\n")
                sent += 1
            return answered >= len(lines)

        self.until(step, RUN_SECONDS, "end of the program")
        return self.guest.heard


def run(options, folder):
    program = folder / "program.ngc"
    program.write_text("\n".join(PROGRAM) + "\n")
    wanted = types.SimpleNamespace(cusp=options.cusp, program=program, settings=None, script=None, as_it_is=False)
    _, simulated, _ = golden.simulate(wanted, folder)
    with Chip(options.cosim, options.image, options.board) as chip:
        chip.command("flash 20 0.001")
        chip.boot()
        plug = Usb(chip)
        plug.plug_in()
        # Another host has used it before: one packet to the device.
        plug.open()
        chip.ask("$G")
        plug.close()
        chip.command("line uart")
        with Guest(folder) as guest:
            bridge = Redirection(plug, guest.plug)
            session = Session(chip, bridge, guest)
            session.until(lambda: READY in guest.heard, BOOT_SECONDS, "port in the guest", 0.2)
            told = session.ask("$$")
            session.ask_any_length()
            chip.changes()
            answers = session.run(PROGRAM)
            session.until(lambda: chip.status()[0] == "Idle", 60, "rest", 20)
            again = session.ask("$$")
            changes = chip.changes()
            count = bridge.count
        by_wire = chip.ask("$$").encode("latin-1")
    if told != by_wire or again != by_wire:
        raise Wrong(f"$$ through the guest is {told!r}, then {again!r}; over the serial line it is {by_wire!r}")
    if answers.replace(b"[MSG:Pgm End]\r\n", b"") != b"ok\r\n" * len(PROGRAM):
        raise Wrong(f"the answers are {answers!r}")
    here, there = moves_of(edges_at_pins(chip, changes)), moves_of(simulated)
    if len(there) != len(MOVES) or here != there:
        pairs = [number for number, (a, b) in enumerate(zip(here, there), 1) if a != b]
        raise Wrong(f"{len(here)} moves at the pins, {len(there)} simulated; these differ: {pairs}")
    print(f"{sum(map(len, here))} edges of {len(here)} moves are the simulator's; {dict(count)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("cosim", "cusp", "board", "image"):
        parser.add_argument(f"--{name}", required=True)
    options = parser.parse_args()
    try:
        find()
        with tempfile.TemporaryDirectory() as folder:
            run(options, pathlib.Path(folder))
    except Missing as error:
        print(f"skipped: {error}")
        return SKIPPED
    except (Wrong, AssertionError) as error:
        print(error)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
