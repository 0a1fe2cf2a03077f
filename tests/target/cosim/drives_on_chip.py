#!/usr/bin/env python3
"""The TMC2209 drives of a board, set over their wires by its shipping image, in the co-simulation.

usage: drives_on_chip.py --cosim COSIM --cusp CUSP --board BOARD --image IMAGE.bin [TRIAL]...

A model of the drives (drive_model.cpp) takes the bits from the pins. What the image wrote is decoded here, from
the bits of the data sheet's tables, and compared with the settings; faults are planted in the model.
Exit status: 0 all hold, 1 one does not, 2 something could not run.
"""
import argparse
import math
import sys
import time

from chip import Chip, CosimFailed

GCONF, GSTAT, IHOLD_IRUN, TPOWERDOWN, TPWMTHRS, CHOPCONF = 0x00, 0x01, 0x10, 0x11, 0x13, 0x6C
AXES = "XYZ"
SETTINGS = {140: 800, 141: 1500, 142: 300, 150: 16, 151: 64, 152: 256, 210: 50, 211: 100, 212: 25,
            840: 0, 841: 3000, 842: 600}


class Wrong(AssertionError):
    """What should hold does not."""


def bits(value, low, high):
    return value >> low & (1 << (high - low + 1)) - 1


def currents(registers):
    """mA rms in motion and at rest: section 9, with 110 mOhm of the modules and 20 of the chip."""
    full_scale = 0.180 if bits(registers[CHOPCONF], 17, 17) else 0.325
    step = full_scale / 0.130 / math.sqrt(2) / 32 * 1000
    return [(bits(registers[IHOLD_IRUN], low, low + 4) + 1) * step for low in (8, 0)], step


def check_registers(chip, drive, axis, settings, steps_per_mm=800, stores=0):
    """That the drive does what the settings ask for. Each store may have cut a request, which the drive drops."""
    registers = chip.drive_registers(drive)
    (run, hold), step = currents(registers)
    asked = settings[140 + axis]
    wanted = {"motion": (run, asked), "rest": (hold, asked * settings[210 + axis] / 100)}
    for when, (got, want) in wanted.items():
        if not want - 2 * step - 0.01 <= got <= want + 0.01:
            raise Wrong(f"drive {drive} at {when}: {got:.0f} mA, {want:.0f} are asked for")
    if bits(registers[CHOPCONF], 24, 27) != 8 - int(math.log2(settings[150 + axis])):
        raise Wrong(f"drive {drive}: microsteps {bits(registers[CHOPCONF], 24, 27)}")
    if not bits(registers[CHOPCONF], 0, 3):
        raise Wrong(f"drive {drive}: its stage is off")
    # pdn_disable and mstep_reg_select; no external reference, no internal sense resistor, direction as wired.
    if bits(registers[GCONF], 6, 7) != 3 or bits(registers[GCONF], 0, 1) or bits(registers[GCONF], 3, 3):
        raise Wrong(f"drive {drive}: GCONF {registers[GCONF]:#x}")
    silent = settings[840 + axis]
    spread = bits(registers[GCONF], 2, 2)
    if bool(silent) == bool(spread):
        raise Wrong(f"drive {drive}: spreadCycle is {spread} with a limit of {silent} mm/min")
    if silent:
        # Section 5.5: the limit as a time between 1/256 microsteps.
        clocks = 12e6 / (silent / 60 * steps_per_mm * 256 / settings[150 + axis])
        if not abs(registers[TPWMTHRS] - clocks) <= 1:
            raise Wrong(f"drive {drive}: TPWMTHRS {registers[TPWMTHRS]}, {clocks:.1f} is right")
    if registers[GSTAT] & 1 or registers["damaged"] > stores:
        raise Wrong(f"drive {drive}: GSTAT {registers[GSTAT]}, {registers['damaged']} damaged requests")
    if abs(registers["baud"] - 40000) > 400:
        raise Wrong(f"drive {drive}: {registers['baud']} baud")


def first_edge(chip, signal, level, changes):
    return next((time for time, now in chip.edges_of(signal, changes)[1:] if now == level), None)


def set_all(chip, settings):
    for number, value in settings.items():
        if "ok" not in chip.ask(f"${number}={value}"):
            raise Wrong(f"${number}={value} is refused")
    chip.run(400)


def expect_alarm(chip, heard, words):
    if "ALARM:17" not in heard or words not in heard:
        raise Wrong(f"no alarm 17 with {words!r}: {heard!r}")
    chip.run(5)
    levels = chip.levels()
    if any(not levels[pin] for pin in chip.enables):
        raise Wrong(f"after {words!r} a drive has current: {[levels[pin] for pin in chip.enables]}")
    if "error" not in chip.ask("G0X1"):
        raise Wrong("G-code is taken after alarm 17")


def trial_set_before_motion(chip):
    """A jog sent with the banner waits until every drive is set; no enable line before."""
    chip.run(1000, "help]\r\n")
    chip.changes()
    heard = chip.ask("$J=G91X5Y5Z5F600")
    if "ok" not in heard:
        raise Wrong(f"the jog at power-up is refused: {heard!r}")
    chip.wait_for("Idle")
    changes = chip.changes()
    last = max(chip.drive_registers(drive)["written_ns"] for drive in range(3))
    for signal, level in [(f"{axis} step", 1) for axis in AXES] + [("drives enable X", 0)]:
        at = first_edge(chip, signal, level, changes)
        if at is None or at < last:
            raise Wrong(f"{signal} at {at} ns, the drives were set at {last}")
    standard = {140: 500, 150: 16, 210: 50, 840: 0}
    for drive in range(3):
        check_registers(chip, drive, drive, {number + axis: value for number, value in standard.items()
                                             for axis in range(3)})
    print(f"all set {last / 1e6:.0f} ms after power-up")


def trial_settings(chip):
    """Current, hold current, microsteps, stealthChop: each drive gets its own, and keeps it over a power cycle."""
    chip.boot()
    set_all(chip, SETTINGS)
    for drive in range(3):
        check_registers(chip, drive, drive, SETTINGS, stores=len(SETTINGS))
    for text, error in (("$150=17", 3), ("$150=512", None), ("$140=49", None), ("$338=8", None)):
        heard = chip.ask(text)
        if "error" not in heard or (error and f"error:{error}" not in heard):
            raise Wrong(f"{text} is taken: {heard!r}")
    chip.command("power cycle")
    chip.boot()
    for drive in range(3):
        check_registers(chip, drive, drive, SETTINGS, stores=len(SETTINGS))


def trial_second_motor(chip):
    """The second motor's drive has the settings of its axis."""
    if len(chip.drives) < 4:
        return
    chip.boot()
    if chip.drive_registers(3)["answers"]:
        raise Wrong("the drive of a second motor is asked though there is none")
    set_all(chip, {**SETTINGS, 793: 2})
    check_registers(chip, 3, 1, SETTINGS, stores=len(SETTINGS) + 1)
    chip.command("drive 3 status 2")
    expect_alarm(chip, chip.run(300), "Drive of the second motor is too hot")


def trial_missing(chip):
    """A socket without a module: alarm 17 with its axis, no motion; $338 leaves it out."""
    chip.command("drive 1 missing")
    heard = chip.boot()
    expect_alarm(chip, heard, "Drive Y does not answer")
    chip.send("\x18")
    expect_alarm(chip, chip.run(400), "Drive Y does not answer")
    chip.ask("$338=5")
    chip.send("\x18")
    heard = chip.run(400)
    if "ALARM" in heard:
        raise Wrong(f"with $338=5: {heard!r}")
    chip.ask("$X")
    chip.ask("$J=G91X1F600")
    chip.wait_for("Idle")


def trial_answers(chip):
    """Two wrong checksums in a row are borne; more are a fault, and so are another chip and lost writes."""
    chip.command("drive 0 garbled 2")
    heard = chip.boot()
    if "ALARM" in heard:
        raise Wrong(f"two damaged answers: {heard!r}")
    check_registers(chip, 0, 0, {140: 500, 150: 16, 210: 50, 840: 0})
    for fault, cure, words in (("garbled 1000", "garbled 0", "Drive X answers with a wrong checksum"),
                               ("version 32", "version 33", "Drive X is no TMC2209"),
                               ("deaf 1", "deaf 0", "Drive X does not keep its settings")):
        chip.command(f"drive 0 {fault}")
        chip.command("power cycle")
        expect_alarm(chip, chip.boot(), words)
        chip.command(f"drive 0 {cure}")
        chip.send("\x18")
        heard = chip.run(500)
        if "ALARM" in heard:
            raise Wrong(f"{words}, cured: {heard!r}")


def trial_clocks(chip):
    """Answers by clocks 2 % off are read without a wrong bit; at rest the board drives the wires high."""
    for drive, drift in enumerate((-20, 20, 10)):
        chip.command(f"drive {drive} drift {drift}")
    heard = chip.boot()
    before = [chip.drive_registers(drive)["answers"] for drive in range(3)]
    wires = {chip.pins[drive] for drive in chip.drives}
    for _ in range(40):
        heard += chip.run(10)
        levels = chip.levels()
        driven = [levels[wire] for wire in wires if wire in levels]
        if len(driven) < len(wires) - 1 or driven.count(0) > 1:
            raise Wrong(f"{len(driven)} of {len(wires)} wires are driven, {driven.count(1)} of them high")
    for drive in range(3):
        answers = chip.drive_registers(drive)["answers"] - before[drive]
        if not 5 <= answers <= 14:  # each second one is asked for again where bits are misread
            raise Wrong(f"drive {drive}: {answers} answers in 0.4 s")
    if "ALARM" in heard:
        raise Wrong(f"clocks 2 % off: {heard!r}")


def trial_erases(chip):
    """Settings stored, with erases of 0.8 s, never amid an answer."""
    chip.boot()
    chip.command("flash 800 0.1")
    wires = {chip.pins[drive] for drive in chip.drives}
    for value in range(60):
        for _ in range(1000):  # until a request begins: it lasts a millisecond, the setting comes within it
            levels = chip.levels()
            if any(not levels.get(wire, 1) for wire in wires):
                break
            chip.run(0.02)
        if "ok" not in chip.ask(f"$1={value + 1}"):
            raise Wrong(f"$1={value + 1} is refused")
    if not chip.state()["erases"]:
        raise Wrong("no sector was erased")
    if "ALARM" in chip.run(300):
        raise Wrong("an erase ends in an alarm")


def stop_at_faults(chip, faults, most):
    """Plants faults amid moves: (drive, fault, cure, words of its alarm). Motion ends within `most` ms of each."""
    worst = 0.0
    for drive, fault, cure, words in faults:
        chip.ask("$J=G91X60F1500")
        chip.run(200)
        chip.changes()
        begin = chip.state()["now"] * 1000
        chip.command(f"drive {drive} {fault}")
        heard = chip.run(2 * most)
        last = (chip.edges_of("X step", chip.changes())[-1][0] - begin) / 1e6
        worst = max(worst, last)
        if last > most:
            raise Wrong(f"{words}: steps until {last:.1f} ms after it")
        expect_alarm(chip, heard, words)
        chip.command(f"drive {drive} {cure}")
        chip.send("\x18")
        chip.run(500)
        chip.ask("$X")
    print(f"the last step comes at most {worst:.0f} ms after the fault")


def trial_faults_in_motion(chip):
    """Over-temperature, a short, a supply that fails, a wire that breaks, amid a move: motion ends at once."""
    chip.boot()
    stop_at_faults(chip, ((1, "status 2", "status 0", "Drive Y is too hot"),
                          (0, "status 4", "status 0", "Drive X has a short"),
                          (2, "status 32", "status 0", "Drive Z has a short"),
                          (2, "restart", "there", "Drive Z was without power"),
                          (0, "missing", "there", "Drive X does not answer")), 150)


def trial_emergency_stop(chip):
    """An emergency stop that takes the drives' supply: alarm 10 alone; after the reset they are set anew."""
    chip.boot()
    chip.pin(chip.pins["emergency stop"], 1)
    for drive in range(3):
        chip.command(f"drive {drive} missing")
    heard = chip.run(500)
    if "ALARM:10" not in heard or "ALARM:17" in heard:
        raise Wrong(f"at the emergency stop: {heard!r}")
    for drive in range(3):
        chip.command(f"drive {drive} there")
    chip.pin(chip.pins["emergency stop"], 0)
    chip.run(20)
    chip.send("\x18")
    heard = chip.run(500)
    if "ALARM:17" in heard:
        raise Wrong(f"after it: {heard!r}")
    for drive in range(3):
        check_registers(chip, drive, drive, {number + drive: value for number, value
                                             in ((140, 500), (150, 16), (210, 50), (840, 0))})


def trial_load(chip):
    """Polled all along, under the heaviest pulse load and a flood of queries; never damaged, never late."""
    chip.boot()
    before = chip.drive_registers(0)["answers"]
    chip.ask("$J=G91X40Y40Z10F6000")
    for _ in range(60):
        chip.send("?")
        chip.run(10)
    answers = chip.drive_registers(0)["answers"] - before
    if answers < 8:
        raise Wrong(f"only {answers} answers in 0.6 s")
    for drive in range(3):
        if chip.drive_registers(drive)["damaged"]:
            raise Wrong(f"drive {drive} got damaged requests")
    state = chip.status()
    if state[0] not in ("Jog", "Idle"):
        raise Wrong(f"state {state}")


TRIALS = {name[6:]: function for name, function in list(globals().items()) if name.startswith("trial_")}


def run_trials(usage, trials, chip_of):
    """The exit status. `chip_of`: of the options and a trial's name."""
    parser = argparse.ArgumentParser(usage=usage)
    for name in ("cosim", "cusp", "board", "image"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("trials", nargs="*", metavar="TRIAL")
    options = parser.parse_args()
    failed = 0
    for name in options.trials or trials:
        begin = time.monotonic()
        try:
            with chip_of(options, name) as chip:
                trials[name](chip)
            print(f"{name}: holds ({time.monotonic() - begin:.1f} s)")
        except AssertionError as error:
            failed += 1
            print(f"{name}: {error}")
        except CosimFailed as error:
            print(f"{name}: {error}")
            return 2
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(run_trials(__doc__, TRIALS, lambda options, name: Chip(options.cosim, options.image, options.board)))
