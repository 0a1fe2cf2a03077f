#!/usr/bin/env python3
"""Runs programs on a board's shipping image in the co-simulation and in the simulator: equal pins.

usage: on_chip.py --cosim COSIM --cusp CUSP --board BOARD --image IMAGE.bin [--programs N] [--seed N]
                  [--keep FOLDER] [--usb] [--rotary] [PROGRAM [--settings FILE] [--script FILE]]

With a program, that one; otherwise N random programs with random settings and scripts, as
random_programs.py makes them. The edges are compared at the pins, through the wiring table of the
board's README and the inversion of $2 and $3, microsecond by microsecond. --usb: bytes come through its plug. --rotary: random programs turn A, on the fourth motor.
Exit status: 0 all are equal, 1 one is not, 2 something could not run.
"""
import argparse
import pathlib
import random
import re
import sys
import tempfile
import time

sys.path[0:0] = [str(pathlib.Path(__file__).resolve().parents[1]), str(pathlib.Path(__file__).resolve().parents[2] / "support")]
import golden  # noqa: E402
import random_programs  # noqa: E402
from chip import Chip, CosimFailed  # noqa: E402
from property_cases import property_cases  # noqa: E402
from qemu import RunFailed  # noqa: E402
from usb import Usb  # noqa: E402


FOURTH = ("second motor step", "second motor direction")


def inversion(settings):
    """The mask of the lines that $2 and $3 invert."""
    values = dict(re.findall(r"\$(\d+)=(\d+)", settings))
    steps, directions = int(values.get("2", 0)), int(values.get("3", 0))
    return steps & 7 | (directions & 7) << 3 | (steps & 8) << 3 | (directions & 8) << 4


def play(options, folder):
    """Status, edges, chip time and host time of the run on the chip."""
    settings = pathlib.Path(options.settings).read_text() if options.settings else ""
    program, trace = folder / "chip.ngc", folder / "chip.trace"
    if options.as_it_is:
        text = pathlib.Path(options.program).read_bytes().decode("latin-1")
        lines = re.split(r"\r\n|\r|\n", text)
        lines = lines[:-1] if lines[-1] == "" else lines
    else:
        lines = list(golden.bare_lines(options.program))
    program.write_bytes("".join(f"{line}\n" for line in lines).encode("latin-1"))
    began = time.monotonic()
    with Chip(options.cosim, options.image, options.board) as chip:
        chip.command("flash 20 0.001")
        chip.boot()
        if options.usb:
            plug = Usb(chip)
            plug.plug_in()
            plug.open()
        for line in settings.split():
            answer = chip.ask(line)
            if "ok" not in answer:
                raise RunFailed(f"{line}: {answer}")
        chip.run(20)
        start = chip.state()["now"]
        script = pathlib.Path(options.script).resolve() if options.script else "-"
        answer = chip.command(f"golden {program} {script} {trace} {inversion(settings)} {options.most_ticks} "
                              + " ".join(chip.lines + [chip.pins[line] for line in FOURTH if "$793=4" in settings]))
        state = chip.state()
    passed = (state["now"] - start) / 1e6
    return int(answer[-1].split()[1]), golden.read_trace(trace), passed, time.monotonic() - began


def compare(options, folder):
    host_status, host, _ = golden.simulate(options, folder)
    status, edges, chip_seconds, seconds = play(options, folder)
    name = pathlib.Path(options.program).name
    print(f"{name}: {len(host)} edges, {chip_seconds:.1f} s of the chip in {seconds:.1f} s")
    options.chip_seconds += chip_seconds
    options.seconds += seconds
    found = []
    if not options.may_stand_still and not host:
        found.append("the program moves nothing: nothing is compared")
    if host != edges:
        found.append(f"simulator and pins differ: {golden.first_difference(host, edges)}")
    if host_status != status:
        found.append(f"the simulator ended with status {host_status}, the chip with {status}")
    for line in found:
        print(f"{name}: {line}")
    return not found


def run_random(options, seed):
    chance = random.Random(seed)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        options.program = folder / f"random_{seed}.ngc"
        options.program.write_bytes(random_programs.random_program(chance, options.rotary).encode())
        options.settings = folder / f"random_{seed}.settings"
        settings = random_programs.random_settings(chance)
        most = 15 if options.rotary else 7
        settings += f"$2={chance.randint(0, most)}\n$3={chance.randint(0, most)}\n"
        settings += random_programs.rotary_settings(chance) if options.rotary else ""
        if seed % 3 == 0:
            settings += "$160=0.05\n$161=0.3\n$162=0.008\n"
        options.settings.write_text(settings)
        options.as_it_is = seed % 2 == 0
        options.script = folder / f"random_{seed}.script" if chance.random() < 0.7 else None
        if options.script:
            options.script.write_text(random_programs.random_script(chance))
        try:
            equal = compare(options, folder)
        except (RunFailed, AssertionError, CosimFailed) as error:
            print(f"random_{seed}.ngc: {error}")
            equal = False
        if not equal and options.keep:
            pathlib.Path(options.keep).mkdir(parents=True, exist_ok=True)
            for file in folder.glob("*"):
                (pathlib.Path(options.keep) / f"{seed}_{file.name}").write_bytes(file.read_bytes())
    return equal


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", nargs="?")
    for name in ("cosim", "cusp", "board", "image"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--settings")
    parser.add_argument("--script")
    parser.add_argument("--usb", action="store_true")
    parser.add_argument("--rotary", action="store_true")
    parser.add_argument("--as-it-is", action="store_true")
    parser.add_argument("--programs", type=int, default=6)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep")
    parser.add_argument("--most-ticks", type=int, default=3600000, help="a program that lasts longer has no end")
    parser.add_argument("--least-speed", type=float, default=0.0,
                        help="chip seconds a second that must be reached")
    options = parser.parse_args()
    options.chip_seconds = options.seconds = 0.0
    options.may_stand_still = options.program is None
    try:
        if options.program:
            with tempfile.TemporaryDirectory() as folder:
                equal = compare(options, pathlib.Path(folder))
        else:
            seeds = range(options.seed, options.seed + property_cases(options.programs))
            wrong = [seed for seed in seeds if not run_random(options, seed)]
            print(f"{len(seeds)} programs from seed {options.seed} on; "
                  f"different: {wrong or 'none'}")
            equal = not wrong
    except (OSError, RunFailed, CosimFailed) as error:
        print(f"on_chip: {error}", file=sys.stderr)
        return 2
    except AssertionError as error:
        print(f"on_chip: {error}")
        return 1
    speed = options.chip_seconds / max(options.seconds, 1e-9)
    print(f"{speed:.2f} chip seconds a second")
    if speed < options.least_speed:
        print(f"slower than the {options.least_speed} that are asked for")
        equal = False
    return 0 if equal else 1


if __name__ == "__main__":
    sys.exit(main())
