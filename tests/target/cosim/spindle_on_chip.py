#!/usr/bin/env python3
"""A spindle's drive at the RS-485 line of a board, spoken to by its shipping image, in the co-simulation.

usage: spindle_on_chip.py --cosim COSIM --cusp CUSP --board BOARD --image IMAGE.bin [TRIAL]...

A model of the drive (tests/support/spindle_slave.hpp) takes the bytes from the pins and turns its motor.
Exit status: 0 all hold, 1 one does not, 2 something could not run.
"""
import argparse
import sys
import time

from chip import Chip, CosimFailed

HUANYANG, P2A, PLAIN = 1, 2, 3
TOLERANCE = 0.05


class Wrong(AssertionError):
    """What should hold does not."""


def motor(chip):
    """direction, rpm and refused of the model."""
    return {words[0]: int(words[1]) for words in map(str.split, chip.command("spindle tell"))}


def use(chip, kind):
    chip.boot()
    for line in (f"$395={kind}", "$394=8", "$30=24000"):
        if "ok" not in chip.ask(line):
            raise Wrong(f"{line} is refused")
    chip.run(300)


def first_step(chip, lines, milliseconds=9000):
    """The motor at the moment of the first step after these lines."""
    chip.changes()
    chip.send(lines)
    for _ in range(milliseconds // 5):
        chip.run(5)
        if chip.steps(chip.changes()):
            return motor(chip)
    raise Wrong(f"no step within {milliseconds} ms after {lines!r}")


def expect_stopped(chip, within, what):
    chip.run(within)
    if motor(chip)["direction"] != 0:
        raise Wrong(f"{what}: the drive was not told to stop within {within} ms")


def trial_at_speed(chip, kind):
    """Motion begins at speed, in either direction, at each new speed; M5 stops."""
    use(chip, kind)
    for lines, direction, rpm in (("M3S12000\nG91G1X1F600\n", 1, 12000), ("S20000M3\nX1\n", 1, 20000),
                                  ("M4S8000\nX1\n", -1, 8000)):
        now = first_step(chip, lines)
        if now["direction"] != direction or abs(now["rpm"] - rpm) > TOLERANCE * rpm + 200:
            raise Wrong(f"{lines!r}: motion begins with {now}")
        chip.wait_for("Idle")
    chip.ask("M5")
    expect_stopped(chip, 60, "M5")
    if motor(chip)["refused"]:
        raise Wrong("the drive did not understand something")


def trial_silence(chip, kind):
    """Two lost or damaged answers are borne; a drive that falls silent amid a cut is alarm 14, and is stopped."""
    use(chip, kind)
    first_step(chip, "M3S12000\nG91G1X150F600\n")
    for fault in ("lose 2", "garble 2"):
        chip.command(f"spindle {fault}")
        heard = chip.run(600)
        if "ALARM" in heard or chip.status()[0] != "Run":
            raise Wrong(f"{fault}: {heard!r}")
    chip.command("spindle lose 8")
    heard = chip.run(1000)
    if "ALARM:14" not in heard or "Spindle does not answer" not in heard:
        raise Wrong(f"a silent drive: {heard!r}")
    chip.changes()
    expect_stopped(chip, 1200, "once it answers again")
    if chip.steps(chip.changes()):
        raise Wrong("steps after the alarm")


def trial_stops(chip, kind):
    """Door, reset and emergency stop reach it, also with a sender that does not read."""
    use(chip, kind)
    for mute in (False, True):
        for what in ("door", "emergency stop", "reset"):
            first_step(chip, "M3S12000\nG91G1X100F600\n")
            if mute:
                chip.command("serial mute")
                chip.send("?" * 200)
                chip.run(150)
            chip.pin(chip.pins[what], 1)
            expect_stopped(chip, 120, f"{what}, {'mute' if mute else 'read'}")
            chip.pin(chip.pins[what], 0)
            if mute:
                chip.command("serial reads")
            chip.run(300)
            chip.send("\x18")
            chip.run(300)
            chip.ask("$X")


def trial_missing(chip, kind):
    """Without an answer there is an alarm, and no step."""
    use(chip, kind)
    chip.command("spindle lose 100000")
    chip.changes()
    chip.send("M3S12000\nG91G1X1F600\n")
    heard = chip.run(3000)
    if "ALARM:14" not in heard:
        raise Wrong(f"nobody answers: {heard!r}")
    if chip.steps(chip.changes()):
        raise Wrong("steps without a spindle")


def trial_rates(chip, kind):
    """Each rate of $374; with another than the drive's nothing is understood."""
    use(chip, kind)
    for number, baud in enumerate((2400, 4800, 9600, 19200, 38400, 115200)):
        chip.command(f"spindle baud {baud}")
        chip.ask(f"$375={200 if baud < 9600 else 50}")
        chip.ask(f"$374={number}")
        chip.send("\x18")
        chip.run(700)
        now = first_step(chip, "M3S9000\nG91G1X1F600\n")
        if now["direction"] != 1:
            raise Wrong(f"{baud} baud: {now}")
        chip.wait_for("Idle")
        chip.ask("M5")
        chip.run(1500)


def trial_erases(chip, kind):
    """Settings stored amid messages, with erases of 0.8 s: nobody speaks at the same time, no alarm."""
    use(chip, kind)
    chip.command("flash 800 0.1")
    for value in range(40):
        chip.ask("M3S3000" if value % 2 == 0 else "M5")
        chip.run(0.37 * (value % 9))
        if "ok" not in chip.ask(f"G10L2P2X{value}"):
            raise Wrong("an offset is refused")
    if not chip.state()["erases"]:
        raise Wrong("no sector was erased")
    if "ALARM" in chip.run(500):
        raise Wrong("an erase ends in an alarm")


TRIALS = {name[6:]: function for name, function in list(globals().items()) if name.startswith("trial_")}


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    for name in ("cosim", "cusp", "board", "image"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("trials", nargs="*", metavar="TRIAL")
    options = parser.parse_args()
    failed = 0
    for name in options.trials or TRIALS:
        # Each protocol comes up; what the line does is the same for all.
        for kind in (HUANYANG, P2A, PLAIN) if name in ("at_speed", "silence") else (PLAIN,):
            begin = time.monotonic()
            try:
                with Chip(options.cosim, options.image, options.board, spindle=kind) as chip:
                    TRIALS[name](chip, kind)
                print(f"{name}_{kind}: holds ({time.monotonic() - begin:.1f} s)")
            except AssertionError as error:
                failed += 1
                print(f"{name}_{kind}: {error}")
            except CosimFailed as error:
                print(f"{name}_{kind}: {error}")
                return 2
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
