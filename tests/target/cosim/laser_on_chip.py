#!/usr/bin/env python3
"""The power of a laser at the pins of the board's shipping image: against its own steps, and the simulator's.

usage: laser_on_chip.py --cosim COSIM --cusp CUSP --board BOARD --image IMAGE.bin [-k PATTERN]
"""
import argparse
import bisect
import csv
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from chip import SPINDLE_CHANNEL, Chip

options = None
SETTINGS = "$0=2\n$32=1\n$30=1000\n$33=1000\n$100=800.000\n$101=800.000\n$120=1000.000\n$800=50000.000\n"
STEPS_PER_MM = 800
FEED, SPEED = 50.0, 0.5  # mm/s, of $30
LINES = ["G21 G90 G61", f"M4 S500 F{60 * FEED:.0f}", "G1 X10", "X2", "G64 P0.05 G1 Y8", "X8 Y9", "G3 X4 Y5 J-4 I0", "G0 X0 Y0",
         "M3 S200 G1 X6", "G0 X0", "M5"]
# ms: a change of power comes with the tick, before which the frame has begun.
LATE = 0.1


def play():
    """(ns, X, Y) of each step, places in steps, and (ns, ppm) of each change of power."""
    with Chip(options.cosim, options.image, options.board) as machine:
        machine.boot()
        for line in SETTINGS.split():
            machine.ask(line)
        machine.changes()
        machine.duties()
        machine.send("\n".join(LINES) + "\n")
        heard = ""
        while heard.count("ok") < len(LINES):
            heard += machine.run(20)
        machine.run(20)
        changes = machine.changes()
        steps = []
        for axis in ("X", "Y"):
            directions = machine.edges_of(f"{axis} direction", changes)
            for time, level in machine.edges_of(f"{axis} step", changes):
                if level:
                    turned = bisect.bisect_right(directions, (time, 2)) - 1
                    steps.append((time, axis, 1 if turned >= 0 and directions[turned][1] else -1))
        channel = SPINDLE_CHANNEL[machine.pins["spindle pulses"]]
        duties = [(time, ppm) for time, at, ppm in machine.duties() if at == channel]
        return sorted(steps), duties


def simulate():
    """(us, power) of the samples, and us of the steps along X and Y."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "laser.ngc").write_text("\n".join(LINES) + "\n")
        (folder / "laser.settings").write_text(SETTINGS)
        subprocess.run([options.cusp, "sim", folder / "laser.ngc", "--settings", folder / "laser.settings",
                        "--samples", folder / "samples.csv", "--vcd", folder / "trace.vcd"], check=True,
                       stdout=subprocess.DEVNULL)
        with (folder / "samples.csv").open() as file:
            samples = [(int(row["t_us"]), int(row["power_ppm"])) for row in csv.DictReader(file)]
        text = (folder / "trace.vcd").read_text()
        marks = ["1" + re.search(r"\$var wire 1 (\S) step_" + axis, text).group(1) for axis in "xy"]
        body = text.partition("$end\n#0\n")[2].partition("$end\n")[2]
        time, steps = 0, []
        for line in body.splitlines():
            if line.startswith("#"):
                time = int(line[1:])
            elif line in marks:
                steps.append(time)
        return samples, steps


class LaserOnChip(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.steps, cls.duties = play()

    def offset_at(self, steps, time):
        """us, from the simulator's clock to the chip's: from rest the chip needs time to plan, the simulator none."""
        at = min(bisect.bisect_left(steps, time), len(steps) - 1)
        return self.steps[at][0] / 1000 - steps[at]

    def power_at(self, time):
        index = bisect.bisect_right(self.duties, (time, 1 << 30)) - 1
        return self.duties[index][1] / 1e6 if index >= 0 else 0.0

    def test_power_lies_on_the_steps_in_proportion(self):
        """On the first two moves, which are along X, in each 20 ms: starts, the turn at a sharp corner, ends."""
        ends = next(time for time, axis, _ in self.steps if axis == "Y")
        times = [time for time, axis, _ in self.steps if axis == "X" and time < ends]
        self.assertEqual(len(times), 18 * STEPS_PER_MM)
        judged, window = 0, 20 * 10 ** 6
        for begin in range(times[0] - 2 * 10 ** 6, times[-1] - window, 3 * 10 ** 6):
            travel = (bisect.bisect(times, begin + window) - bisect.bisect(times, begin)) / STEPS_PER_MM
            marks = [begin, *(time for time, _ in self.duties if begin < time < begin + window), begin + window]
            energy = sum(self.power_at(a) * (b - a) / 1e9 for a, b in zip(marks, marks[1:]))
            if travel > 0.25:  # of 200 steps one more or less is half a per cent
                self.assertAlmostEqual(energy / travel / (SPEED / FEED), 1, delta=0.01)
                judged += 1
        self.assertGreater(judged, 80)

    def test_power_is_that_of_the_simulator_in_its_millisecond(self):
        samples, steps = simulate()
        self.assertEqual(len(steps), len(self.steps))
        grain = 30 if options.board != "black_pill_f411" else 25
        wrong, seen = [], 0
        for time, power in samples:
            # In the middle of the millisecond that ends at `time`.
            on_chip = round(self.power_at((time - 500 + self.offset_at(steps, time - 500)) * 1000) * 1e6)
            seen += power > 0
            if abs(on_chip - power) > grain:
                wrong.append((time, power, on_chip))
        self.assertEqual(wrong, [])
        self.assertGreater(seen, 500)

    def test_a_change_of_power_begins_with_its_frame(self):
        samples, steps = simulate()
        changes = [time - 1000 + self.offset_at(steps, time - 1000)
                   for (time, power), (_, before) in zip(samples[1:], samples) if power != before]
        changed = [time / 1000 for (time, ppm), (_, before) in zip(self.duties[1:], self.duties) if ppm != before]
        for time in changed:
            at = bisect.bisect_right(changes, time + 20) - 1
            self.assertGreaterEqual(at, 0)
            self.assertLess(time - changes[at], LATE * 1000, "us after the frame's begin")


def main():
    global options
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("cosim", "cusp", "board", "image"):
        parser.add_argument(f"--{name}", required=True)
    options, rest = parser.parse_known_args()
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
