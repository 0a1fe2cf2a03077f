#!/usr/bin/env python3
"""TMC5160 drives of a board, set over SPI by its shipping image, in the co-simulation.

usage: bus_drives_on_chip.py --cosim COSIM --cusp CUSP --board BOARD --image IMAGE.bin [TRIAL]...

A model of the drives (tests/support/tmc5160_model.hpp) takes the bits from the pins, and judges their times. What the
image wrote is decoded here, from the bits of the data sheet's tables, and compared with the settings; faults are
planted in the model. Exit status: 0 all hold, 1 one does not, 2 something could not run.
"""
import math
import sys

import drives_on_chip
from chip import Chip
from drives_on_chip import AXES, Wrong, bits, expect_alarm, first_edge, run_trials, set_all, stop_at_faults

GCONF, GSTAT, GLOBALSCALER, IHOLD_IRUN, TPWMTHRS, CHOPCONF = 0x00, 0x01, 0x0B, 0x10, 0x13, 0x6C
ALL = (0, 1, 2, 3)
STANDARD = {number + axis: value for number, value in ((140, 500), (150, 16), (210, 50), (840, 0))
            for axis in range(3)}
SETTINGS = {798: 7, 140: 800, 141: 3000, 142: 60, 150: 16, 151: 64, 152: 256, 210: 50, 211: 100, 212: 25,
            840: 0, 841: 3000, 842: 600}


def check_registers(chip, drive, axis, settings, steps_per_mm=800):
    """That the drive does what the settings ask for."""
    registers = chip.drive_registers(drive)
    # Section 9: 75 mOhm of the modules.
    step = (registers[GLOBALSCALER] or 256) / 256 * 0.325 / 0.075 / math.sqrt(2) / 32 * 1000
    run, hold = ((bits(registers[IHOLD_IRUN], low, low + 4) + 1) * step for low in (8, 0))
    asked = settings[140 + axis]
    rest = asked * settings[210 + axis] / 100
    if not asked - 12 <= run <= asked + 0.01:
        raise Wrong(f"drive {drive} in motion: {run:.0f} mA, {asked} are asked for")
    if not rest - step - 12 <= hold <= max(rest, step) + 0.01:
        raise Wrong(f"drive {drive} at rest: {hold:.0f} mA, {rest:.0f} are asked for")
    if bits(registers[CHOPCONF], 24, 27) != 8 - int(math.log2(settings[150 + axis])):
        raise Wrong(f"drive {drive}: microsteps {bits(registers[CHOPCONF], 24, 27)}")
    if not bits(registers[CHOPCONF], 0, 3) or bits(registers[CHOPCONF], 30, 31):
        raise Wrong(f"drive {drive}: its stage or its protection is off: CHOPCONF {registers[CHOPCONF]:#x}")
    silent = settings[840 + axis]
    # en_pwm_mode, and multistep_filt; nothing else: direction as wired, no test mode.
    if registers[GCONF] != 8 + (4 if silent else 0):
        raise Wrong(f"drive {drive}: GCONF {registers[GCONF]:#x} with a limit of {silent} mm/min")
    if silent:
        clocks = 12e6 / (silent / 60 * steps_per_mm * 256 / settings[150 + axis])
        if not abs(registers[TPWMTHRS] - clocks) <= 1:
            raise Wrong(f"drive {drive}: TPWMTHRS {registers[TPWMTHRS]}, {clocks:.1f} is right")
    if registers[GSTAT] or registers["damaged"]:
        raise Wrong(f"drive {drive}: GSTAT {registers[GSTAT]}, {registers['damaged']} damaged requests")
    if not 1e5 < registers["baud"] <= 4e6:
        raise Wrong(f"drive {drive}: {registers['baud']} bits a second")


def ready(chip, settings="$798=7"):
    """With the drives told to be TMC5160, from a power cycle on."""
    chip.boot()
    for line in settings.split():
        if "ok" not in chip.ask(line):
            raise Wrong(f"{line} is refused")
    chip.command("power cycle")
    return chip.boot()


def trial_set_before_motion(chip):
    """A jog sent with the banner waits until every drive is set; no enable line before."""
    chip.boot()
    chip.ask("$798=7")
    began = chip.state()["now"] * 1000
    chip.command("power cycle")
    chip.changes()
    chip.run(1000, "help]\r\n")
    if "ok" not in chip.ask("$J=G91X5Y5Z5F600"):
        raise Wrong("the jog at power-up is refused")
    chip.wait_for("Idle")
    changes = chip.changes()
    last = max(chip.drive_registers(drive)["written_ns"] for drive in range(3))
    for signal, level in [(f"{axis} step", 1) for axis in AXES] + [("drives enable X", 0)]:
        at = first_edge(chip, signal, level, changes)
        if at is None or at < last:
            raise Wrong(f"{signal} at {at} ns, the drives were set at {last}")
    for drive in range(3):
        check_registers(chip, drive, drive, STANDARD)
    print(f"all set {(last - began) / 1e6:.0f} ms after power-up, at {chip.drive_registers(0)['baud'] / 1e6:.2f} MHz")


def trial_settings(chip):
    """Current, hold current, microsteps, stealthChop: each drive gets its own, and keeps it over a power cycle."""
    chip.boot()
    set_all(chip, SETTINGS)
    chip.send("\x18")  # until $798 was set they were no TMC2209
    chip.run(500)
    for _ in range(2):
        for drive in range(3):
            check_registers(chip, drive, drive, SETTINGS)
        chip.command("power cycle")
        chip.boot()
    for text in ("$798=8", "$140=3001", "$140=49"):
        if "error" not in chip.ask(text):
            raise Wrong(f"{text} is taken")
    chip.ask("$141=700")
    chip.run(300)
    check_registers(chip, 1, 1, {**SETTINGS, 141: 700})


def trial_second_motor(chip):
    """The second motor's drive is of the kind of its axis, and has its settings."""
    ready(chip, "$798=7 $793=2 $141=1200")
    check_registers(chip, 3, 1, {**STANDARD, 141: 1200})
    chip.command(f"drive 3 status {1 << 25}")
    expect_alarm(chip, chip.run(400), "Drive of the second motor is too hot")


def trial_other_kind(chip):
    """A TMC5160 that the settings take for a TMC2209, and the other way round."""
    expect_alarm(chip, chip.boot(), "Drive X does not answer. If it is of another kind see $798")
    chip.ask("$798=7")
    chip.send("\x18")
    if "ALARM" in (heard := chip.run(500)):
        raise Wrong(f"with $798=7: {heard!r}")
    chip.command("drive 1 version 33")
    expect_alarm(chip, chip.run(300), "Drive Y is no TMC5160")


def trial_missing(chip):
    """A socket without a module: alarm 17 with its axis, no motion; $338 leaves it out."""
    chip.command("drive 1 missing")
    expect_alarm(chip, ready(chip), "Drive Y does not answer")
    chip.ask("$338=5")
    chip.send("\x18")
    if "ALARM" in (heard := chip.run(500)):
        raise Wrong(f"with $338=5: {heard!r}")
    chip.ask("$X")
    chip.ask("$J=G91X1F600")
    chip.wait_for("Idle")


def trial_answers(chip):
    """Two wrong answers in a row are borne; lost writes are not."""
    if "ALARM" in (heard := ready(chip)):
        raise Wrong(f"at first: {heard!r}")
    for drive in range(3):
        chip.command(f"drive {drive} garbled 1")
        if "ALARM" in (heard := chip.run(300)):
            raise Wrong(f"a damaged answer: {heard!r}")
    chip.command("drive 0 deaf 1")
    chip.command("power cycle")
    expect_alarm(chip, chip.boot(), "Drive X does not keep its settings")
    chip.command("drive 0 deaf 0")
    chip.send("\x18")
    if "ALARM" in (heard := chip.run(500)):
        raise Wrong(f"cured: {heard!r}")
    check_registers(chip, 0, 0, STANDARD)


def trial_faults_in_motion(chip):
    """Over-temperature, shorts, a supply that fails or sinks, amid a move: motion ends at once."""
    ready(chip)
    stop_at_faults(chip, ((1, f"status {1 << 25}", "status 0", "Drive Y is too hot"),
                          (0, f"status {1 << 27}", "status 0", "Drive X has a short"),
                          (2, f"status {1 << 13}", "status 0", "Drive Z has a short"),
                          (2, "starve", "there", "Drive Z had too little voltage"),
                          (1, "restart", "there", "Drive Y was without power"),
                          (0, "missing", "there", "Drive X does not answer")), 200)


def trial_cut_short(chip):
    """Power that fails amid datagrams: the drives are set all the same once it is back."""
    ready(chip)
    for part in range(20):
        chip.command("power cycle")
        chip.run(80 + 1.0137 * part)
    chip.command("power cycle")
    chip.boot()
    for drive in range(3):
        check_registers(chip, drive, drive, STANDARD)


def trial_mixed(chip):
    """A TMC2209 between two TMC5160: each is set as its kind asks for."""
    if "ALARM" in (heard := ready(chip, "$798=5 $140=2000")):
        raise Wrong(f"with $798=5: {heard!r}")
    settings = {**STANDARD, 140: 2000}
    for drive in (0, 2):
        check_registers(chip, drive, drive, settings)
    drives_on_chip.check_registers(chip, 1, 1, settings, stores=2)
    chip.command("drive 1 status 2")
    expect_alarm(chip, chip.run(300), "Drive Y is too hot")


def trial_load(chip):
    """Polled all along, under the heaviest pulse load, a flood of queries and erases; never damaged, never late."""
    ready(chip)
    chip.command("flash 800 0.1")
    for value in range(60):
        if "ok" not in chip.ask(f"$1={value + 1}"):
            raise Wrong(f"$1={value + 1} is refused")
    if not chip.state()["erases"]:
        raise Wrong("no sector was erased")
    before = chip.drive_registers(0)["answers"]
    chip.ask("$J=G91X40Y40Z10F6000")
    for _ in range(60):
        chip.send("?")
        chip.run(10)
    if (answers := chip.drive_registers(0)["answers"] - before) < 24:
        raise Wrong(f"only {answers} datagrams in 0.6 s")
    for drive in range(3):
        if chip.drive_registers(drive)["damaged"]:
            raise Wrong(f"drive {drive} got damaged requests")
    if (state := chip.status())[0] not in ("Jog", "Idle"):
        raise Wrong(f"state {state}")


TRIALS = {name[6:]: function for name, function in list(globals().items()) if name.startswith("trial_")}


if __name__ == "__main__":
    sys.exit(run_trials(__doc__, TRIALS, lambda options, name: Chip(
        options.cosim, options.image, options.board, on_bus=(0, 2) if name == "mixed" else ALL)))
