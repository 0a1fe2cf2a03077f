#!/usr/bin/env python3
"""An image behind a boot loader that leaves much behind (tests/target/loader), in the co-simulation.

usage: loader_on_chip.py --cosim COSIM --cusp CUSP --board BOARD_sd --image FOLDER/firmware.bin

It starts, moves, keeps its settings over power cycles, erases of 2 s and power cuts, and writes nowhere but into
the two sectors of its settings: the flash's model forbids all else.
Exit status: 0 all hold, 1 one does not, 2 something could not run.
"""
import argparse
import sys

from chip import Chip, CosimFailed


def starts_and_moves(chip):
    heard = chip.boot()
    assert "Grbl 1.1h" in heard and "ALARM" not in heard, heard
    chip.changes()
    chip.ask("$J=G91X2Y1Z1F1200")
    chip.wait_for("Idle")
    changes = chip.changes()
    steps = [chip.steps(changes, axis) for axis in "XYZ"]
    assert steps == [1600, 800, 800], steps


def keeps_settings(chip):
    """More stores than a sector holds."""
    chip.boot()
    for value in range(80):
        assert "ok" in chip.ask(f"$1={value + 1}"), value
        chip.run(5)
    state = chip.state()
    assert state["erases"] >= 2, state
    assert not state["resets"], "the watchdog does not outlast an erase"
    chip.command("power cycle")
    heard = chip.boot()
    assert "$1=80\r\n" in chip.ask("$$"), heard


def bears_power_cuts(chip):
    """Amid a record: the one before is in force."""
    chip.boot()
    kept = 25
    for writes in (1, 7, 60, 200, 230):
        chip.ask(f"$1={kept + 1}")
        kept += 1
        chip.command(f"power fails_after {writes}")
        chip.send("$1=200\n")
        chip.run(200)
        assert not chip.state()["powered"], writes
        chip.command("power cycle")
        heard = chip.boot()
        assert "interrupted write" in heard, (writes, heard)
        assert f"$1={kept}\r\n" in chip.ask("$$"), writes


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("cosim", "cusp", "board", "image"):
        parser.add_argument(f"--{name}", required=True)
    options = parser.parse_args()
    failed = 0
    for trial in (starts_and_moves, keeps_settings, bears_power_cuts):
        try:
            with Chip(options.cosim, options.image, options.board) as chip:
                trial(chip)
            print(f"{trial.__name__}: holds")
        except AssertionError as error:
            failed += 1
            print(f"{trial.__name__}: {error}")
        except CosimFailed as error:
            print(f"{trial.__name__}: {error}")
            return 2
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
