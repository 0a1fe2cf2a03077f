#!/usr/bin/env python3
"""Checked lines through cusp stream on a line that damages bytes: the same path as on a clean line.

usage: checked_test.py CUSP [--lines N] [--rate R] [--seed S]

The program runs twice over `cusp sim --serve`, once clean and once with bytes corrupted, dropped,
doubled and delayed at the rate R each, both ways. The exact path (G61) makes the path independent of
the time at which lines arrive: each axis makes the same steps in the same order in both runs, and the
places after as many steps differ by at most a step of an axis, or the damaged run must have ended in a
hold with its reason. Two axes that step within a microsecond may change their order: the ticks fall on
other points of the path when lines arrive later. CI runs it bounded; docs/sending.md has the full size.
"""
import argparse
import math
import pathlib
import subprocess
import sys
import tempfile
import time

from vcd_steps import read_steps
from virtual_mill import VirtualMill, say


def program(lines):
    text = ["G21 G90 G61"]
    for i in range(lines - 1):
        angle = 0.31 * i
        radius = 0.3 + 0.2 * math.sin(0.011 * i)
        text.append(f"G1 X{radius * math.cos(angle) - 0.3:.3f} Y{radius * math.sin(angle):.3f} F6000")
    return "\n".join(text) + "\n"


def run(cusp, file, vcd, options, *faults):
    with VirtualMill(cusp, "--vcd", str(vcd), "--seed", str(options.seed), *faults, tap=False,
                     settings="$100=200\n$101=200\n$102=200\n$120=5000\n$121=5000\n$800=300000\n$801=300000\n",
                     steps_per_mm=200) as mill:
        start = time.monotonic()
        done = subprocess.run([cusp, "stream", mill.port, str(file), "--checked", "--no-estimate"],
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True,
                              stderr=subprocess.STDOUT, timeout=options.lines + 60, check=False)
        seconds = time.monotonic() - start
        time.sleep(0.5)
        mill.process.terminate()
        mill.process.wait(10)
    last = [line for line in done.stdout.splitlines() if "lines sent" in line or "cusp stream:" in line]
    say(f"{' '.join(faults) or 'clean'}: status {done.returncode}, {seconds:.1f} s, {'; '.join(last)}")
    return done, read_steps(vcd)


def axis_steps(places, axis):
    """The places of one axis, one a step of its own."""
    return [b[axis] for a, b in zip(places, places[1:]) if a[axis] != b[axis]]


def first_difference(places, others):
    """The step from which on two paths differ, or none; a shorter first path is compared as far as it goes."""
    for step, (a, b) in enumerate(zip(places, others)):
        if max(abs(x - y) for x, y in zip(a, b)) > 1:
            return step
    for axis in range(3):
        mine, theirs = axis_steps(places, axis), axis_steps(others, axis)
        if mine != theirs[:len(mine)]:
            return next(i for i, (a, b) in enumerate(zip(mine + [None], theirs + [None])) if a != b)
    return None


def judge_the_judge():
    """Faults that must be seen, and an exchange of neighbours that must not."""
    sound = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (2, 1, 0), (2, 2, 0)]
    exchanged = [(0, 0, 0), (0, 1, 0), (1, 1, 0), (2, 1, 0), (2, 2, 0)]
    to_and_fro = [(0, 0, 0), (1, 0, 0), (0, 0, 0), (1, 0, 0), (1, 1, 0)]
    elsewhere = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0), (3, 1, 0)]
    assert first_difference(exchanged, sound) is None and first_difference(sound[:3], sound) is None
    assert first_difference(to_and_fro, sound) is not None
    assert first_difference(elsewhere, sound) is not None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("cusp")
    parser.add_argument("--lines", type=int, default=600)
    parser.add_argument("--rate", type=float, default=1 / 200)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    judge_the_judge()
    with tempfile.TemporaryDirectory() as scratch:
        file = pathlib.Path(scratch) / "part.ngc"
        file.write_text(program(options.lines))
        done, clean = run(options.cusp, file, pathlib.Path(scratch) / "clean.vcd", options)
        if done.returncode != 0:
            say(done.stdout)
            return 1
        faults = ",".join(f"{kind}={options.rate:.6f}" for kind in ("noise", "loss", "doubling", "delay"))
        done, bad = run(options.cusp, file, pathlib.Path(scratch) / "bad.vcd", options,
                        "--line-faults", faults)
    differs = first_difference(bad, clean)
    if done.returncode != 0:
        say("stopped: " + done.stdout[-300:])
        return 0 if differs is None and "cusp stream:" in done.stdout else 1
    if differs is not None or len(bad) != len(clean):
        say(f"{len(bad)} steps instead of {len(clean)}; they differ from step {differs} on")
        return 1
    say(f"{len(clean)} steps, the same path")
    return 0


if __name__ == "__main__":
    sys.exit(main())
