#!/usr/bin/env python3
"""Programs that are interrupted and resumed by cusp stream: what was cut together is the whole path.

usage: resume_test.py CUSP [unittest options]

Faults come over the control port of the virtual mill; the steps in its VCD file are what was cut. Every point of the
program's path must have been passed; and wherever the tool was below the height of travel, it was on that path.
"""
import math
import os
import pathlib
import re
import subprocess
import sys
import time
import unittest

import side_by_side
from vcd_steps import read_steps
from virtual_mill import VirtualMill

CUSP = sys.argv[1]
STEPS = 200  # a millimetre
# Homing at once, a mill that need not be waited for.
HOMES = f"$100={STEPS}\n$101={STEPS}\n$102={STEPS}\n$22=1\n$24=1000\n$25=6000\n$26=5\n"


def segments_of(moves):
    """Straight pieces of a list of points."""
    return list(zip(moves, moves[1:]))


def distance(point, segment):
    (a, b) = segment
    along = [b[i] - a[i] for i in range(3)]
    square = sum(x * x for x in along)
    t = 0.0 if square == 0 else sum((point[i] - a[i]) * along[i] for i in range(3)) / square
    t = min(1.0, max(0.0, t))
    return math.dist(point, [a[i] + t * along[i] for i in range(3)])


class Grid:
    """Points in cells of `size`: which are near one."""

    def __init__(self, points, size):
        self.size = size
        self.cells = set(self.cell(point) for point in points)

    def cell(self, point):
        return tuple(math.floor(x / self.size) for x in point)

    def near(self, point):
        x, y, z = self.cell(point)
        return any((x + i, y + j, z + k) in self.cells
                   for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1))


class ResumeTest(unittest.TestCase):
    faults = ()
    settings = HOMES
    options = ()

    def serve_with_steps(self):
        self.vcd = pathlib.Path(f"/tmp/resume_{os.getpid()}_{id(self)}.vcd")
        self.addCleanup(lambda: self.vcd.unlink(missing_ok=True))
        self.mill = VirtualMill(CUSP, "--vcd", str(self.vcd), *self.faults, settings=self.settings,
                                tap=False, steps_per_mm=STEPS)
        self.addCleanup(lambda: self.mill.__exit__(None, None, None))
        self.program = self.mill.folder / "part.ngc"

    def start(self, *words):
        return subprocess.Popen([CUSP, "stream", self.mill.port, str(self.program), "--no-estimate",
                                 *self.options, *words], stdin=subprocess.DEVNULL, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def finish(self, process, status, seconds=60):
        try:
            text, _ = process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            process.kill()
            text, _ = process.communicate()
            self.fail("cusp stream does not end:\n" + text)
        self.assertEqual(process.returncode, status, text)
        return text

    def send(self, *lines):
        """Commands and preparations, by a transfer of their own."""
        file = self.mill.folder / "setup.ngc"
        file.write_text("\n".join(lines) + "\n")
        done = subprocess.run([CUSP, "stream", self.mill.port, str(file), "--no-estimate"],
                              stdin=subprocess.DEVNULL, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=60)
        self.assertEqual(done.returncode, 0, done.stdout)

    def home(self):
        from port import Port
        with Port(self.mill.port) as port:
            port.wait_for("^Grbl")
            if "Alarm" in port.state():
                port.ask("$H", 60)

    def iron_at_rest(self):
        before = None
        while before != self.mill.where():
            before = self.mill.where()
            time.sleep(0.3)
        return before


# After homing the tool is at -1,-1,-1; work zero lies amid the travel.
WORK_ZERO = (-150.0, -100.0, -40.0)
TRAVEL_Z = 6.0


def spiral_program(words="G21 G90 G54"):
    """Short lines, long lines, an arc, a G2 that leans on the line before, a drilled hole, in two depths."""
    lines = [words, "M3 S8000", f"G0 Z{TRAVEL_Z}"]
    points = [(None, None, TRAVEL_Z)]

    def go(motion, x, y, z, rest=""):
        lines.append(f"{motion} X{x:.4f} Y{y:.4f} Z{z:.4f}{rest}")
        points.append((x, y, z))

    for depth in (-0.5, -1.0):
        go("G0", 10, 0, TRAVEL_Z)
        go("G1", 10, 0, depth, " F900")
        lines.append("F3600")
        for i in range(1, 241):
            angle, radius = math.radians(3 * i), 10 - i / 60
            go("G1" if i == 1 else "", radius * math.cos(angle), radius * math.sin(angle), depth)
        go("G1", 25, 0, depth)
        go("G1", 25, 20, depth)
        go("G1", -20, 20, depth)
        go("", -20, -20, depth)
        go("G0", -20, -20, TRAVEL_Z)
    lines += ["M5", "G0 X0 Y0", "M30"]
    points.append((0, 0, TRAVEL_Z))
    return lines, points


class Interrupted(ResumeTest):
    def setUp(self):
        self.serve_with_steps()
        self.home()
        self.send("$110=9000", "$111=9000", "G10 L2 P1 X{:.3f} Y{:.3f} Z{:.3f}".format(*WORK_ZERO))
        lines, self.points = spiral_program()
        self.program.write_text("\n".join(lines) + "\n")
        self.assertEqual(self.iron_at_rest(), self.mill.where())
        self.homed = self.mill.where()

    def interrupt(self, at, fault):
        process = self.start()
        time.sleep(at)
        fault(process)
        return process

    def judge(self):
        """All of the path was passed, and below the height of travel nothing else was."""
        self.mill.process.terminate()
        self.mill.process.wait(10)
        # The iron when homed is machine -1,-1,-1: to program coordinates.
        shift = [-1.0 - self.homed[i] - WORK_ZERO[i] for i in range(3)]
        passed = [tuple(step / STEPS + shift[i] for i, step in enumerate(place))
                  for place in read_steps(self.vcd)]
        low = [place for place in passed if place[2] < TRAVEL_Z - 0.01]
        segments = [segment for segment in segments_of([p for p in self.points if p[0] is not None])]
        path = []
        for a, b in segments:
            count = max(1, math.ceil(math.dist(a, b) / 0.02))
            path += [tuple(a[i] + (b[i] - a[i]) * k / count for i in range(3)) for k in range(count + 1)]
        tolerance = 0.03
        cut = Grid(passed, tolerance)
        missing = [point for point in path if point[2] < TRAVEL_Z - 0.01 and not cut.near(point)]
        self.assertEqual(missing[:3], [], f"{len(missing)} of {len(path)} points were not cut")
        meant = Grid(path, tolerance)
        # During the descent the tool is above the place where it resumes.
        columns = {}
        for x, y, z in path:
            cell = (math.floor(x / tolerance), math.floor(y / tolerance))
            columns[cell] = min(z, columns.get(cell, z))

        def above(place):
            x, y = (math.floor(place[i] / tolerance) for i in range(2))
            return any(columns.get((x + i, y + j), math.inf) <= place[2] + tolerance
                       for i in (-1, 0, 1) for j in (-1, 0, 1))

        wrong = [place for place in low if not meant.near(place) and not above(place)]
        self.assertEqual(wrong[:3], [], f"{len(wrong)} of {len(low)} steps are off the path")

    def test_unplugged_and_plugged_again(self):
        process = self.interrupt(3.0, lambda _: self.mill.command("unplug"))
        text = self.finish(process, 1, 20)
        self.assertIn("link", text)
        self.assertIn("--resume", text)
        self.mill.command("plug")
        text = self.finish(self.start("--resume", "--yes"), 0)
        self.assertIn("was executing; resuming at line", text)
        self.judge()

    def test_power_lost_and_homed_again(self):
        process = self.interrupt(4.5, lambda _: self.mill.command("power off"))
        text = self.finish(process, 1, 20)
        self.assertIn("nothing heard", text)
        self.mill.command("power on")
        text = self.finish(self.start("--resume", "--yes"), 0)
        self.assertIn("homes the machine", text)
        self.judge()

    def test_power_that_comes_back_at_once(self):
        def blink(_):
            self.mill.command("power off")
            self.mill.command("power on")
        text = self.finish(self.interrupt(5.5, blink), 1, 20)
        self.assertIn("restarted", text)
        self.finish(self.start("--resume", "--yes"), 0)
        self.judge()

    def test_stopped_by_the_person_and_resumed_thrice(self):
        import signal
        self.finish(self.interrupt(2.5, lambda process: process.send_signal(signal.SIGINT)), 1, 20)
        for seconds in (7.5, 8.5):
            process = self.start("--resume", "--yes")
            time.sleep(seconds)
            process.send_signal(signal.SIGINT)
            self.finish(process, 1, 20)
        self.finish(self.start("--resume", "--yes"), 0)
        self.judge()

    def test_the_host_dies_and_checked_lines_go_on(self):
        self.options = ("--checked",)
        process = self.interrupt(4.0, lambda process: process.kill())
        process.communicate()
        time.sleep(1)
        self.finish(self.start("--resume", "--yes"), 0)
        self.judge()

    def test_a_person_may_say_no(self):
        import signal
        self.finish(self.interrupt(2.5, lambda process: process.send_signal(signal.SIGINT)), 1, 20)
        place = self.iron_at_rest()
        text = self.finish(self.start("--resume"), 1)
        self.assertIn("resume? [y/N]", text)
        self.assertEqual(self.mill.where(), place)
        changed = self.program.read_text().replace("S8000", "S9000")
        self.program.write_text(changed)
        self.assertIn("is not the program", self.finish(self.start("--resume"), 2))


if __name__ == "__main__":
    side_by_side.main(6)
