#!/usr/bin/env python3
"""Threads that are milled: sizes by the standards, helices judged by an oracle of their own, and by cusp verify.

usage: threads_milled_test.py CUSP
"""
import json
import math
import random
import re
import subprocess
import sys
import unittest

from cusp_case import CUSP, CuspCase, share_of

# Nominal size and pitch in mm, and the minor diameter of the nut as tables have it (ISO 724; ASME B1.1 in inches).
SIZES = {"M3": (3, 0.5, 2.459), "M6": (6, 1, 4.917), "M6x0.75": (6, 0.75, 5.188), "M8": (8, 1.25, 6.647), "M10": (10, 1.5, 8.376),
         "M12": (12, 1.75, 10.106), "M16": (16, 2, 13.835), "M20x1.5": (20, 1.5, 18.376), "M24": (24, 3, 20.752),
         "1/4-20": (6.35, 1.27, 4.978), "#10-32": (4.826, 0.79375, 3.967), "3/8-16": (9.525, 1.5875, 7.805), "1 1/8-7": (28.575, 25.4 / 7, 24.648)}
HEAD = """units = "mm"
[[tool]]
shape = "flat"
diameter = {mill}
[[tool]]
shape = "flat"
diameter = {bore_mill}
[cutting]
feed = 600
plunge_feed = 200
[stock]
top = 0
bottom = -30
x = [-10, 110]
y = [-10, 110]
"""
PLACES = ((20, 30), (70, 60))


def circle(x, y, diameter):
    return f"0\nCIRCLE\n8\nholes\n10\n{x}\n20\n{y}\n40\n{diameter / 2}\n"


def drawing(diameter):
    return "0\nSECTION\n2\nENTITIES\n" + "".join(circle(x, y, diameter) for x, y in PLACES) + "0\nENDSEC\n0\nEOF\n"


def positions(text):
    """(x, y, z) along the feed moves of tool 1, arcs at every 3 degrees."""
    out, at, motion, tool = [], [0.0, 0.0, 50.0], 0, 1
    for line in text.splitlines():
        line = re.sub(r"\(.*?\)|;.*", "", line)
        words = dict((word, float(value)) for word, value in re.findall(r"([A-Z])(-?[0-9.]+)", line))
        tool = int(words.get("T", tool))
        found = re.findall(r"G0*([0-3])(?![0-9.])", line)
        motion = int(found[-1]) if found else motion
        to = [words.get(axis, at[k]) for k, axis in enumerate("XYZ")]
        if "I" in words or "J" in words:
            centre = at[0] + words.get("I", 0), at[1] + words.get("J", 0)
            start = math.atan2(at[1] - centre[1], at[0] - centre[0])
            turn = math.atan2(to[1] - centre[1], to[0] - centre[0]) - start
            turn = turn % (2 * math.pi) if motion == 3 else -(-turn % (2 * math.pi))
            turn = turn or (2 * math.pi if motion == 3 else -2 * math.pi)
            radius = math.hypot(at[0] - centre[0], at[1] - centre[1])
            steps = max(1, int(abs(turn) / math.radians(3)))
            points = [(centre[0] + radius * math.cos(start + turn * k / steps), centre[1] + radius * math.sin(start + turn * k / steps),
                       at[2] + (to[2] - at[2]) * k / steps) for k in range(1, steps + 1)]
        else:
            steps = max(1, int(math.dist(at, to) / 0.2))
            points = [tuple(a + (b - a) * k / steps for a, b in zip(at, to)) for k in range(1, steps + 1)]
        if motion > 0 and tool == 1:
            out += points
        at = to
    return out


class Threads(CuspCase):
    def job(self, thread, keys, mill, outside=False, bored=True):
        keys = {"output": "arcs", **keys}
        size, pitch, minor = SIZES[thread]
        self.write("holes.dxf", drawing(size))
        lines = "".join(f"{key} = {json.dumps(value)}\n" for key, value in keys.items())
        before = ""
        if outside:  # the ground round the bolt, cut to its size
            self.write("round.dxf", "0\nSECTION\n2\nENTITIES\n" + "".join(
                circle(x, y, d) for x, y in PLACES for d in (size, size + 4 * mill + 6)) + "0\nENDSEC\n0\nEOF\n")
            before = f'[[operation]]\nstrategy = "pocket"\nboundary = "round.dxf"\ntool = 2\ndepth = {keys["depth"] + pitch + 1}\nmax_depth = 4\n'
        elif bored:
            self.write("bores.dxf", drawing(minor))
            before = f'[[operation]]\nstrategy = "bore"\nboundary = "bores.dxf#holes"\ntool = 2\ndepth = {keys["depth"] + pitch + 1}\n'
        self.write("job.toml", HEAD.format(mill=mill, bore_mill=round(max(0.8, min(6, 0.6 * minor)), 2)) + before +
                   f'[[operation]]\nstrategy = "thread_mill"\nthread = "{thread}"\nboundary = "holes.dxf#holes"\n'
                   f'tool = 1\n{lines}')

    def planned(self, status=0):
        return self.cusp(status, "plan", "job.toml", "-o", "p.ngc", "--stats", "p.json")

    def program(self):
        return (self.folder / "p.ngc").read_text()

    def assert_thread(self, thread, keys, mill, outside):
        """Where the teeth are at full depth, they are on one helix, and pass each pitch of the depth on all sides."""
        size, pitch, _ = SIZES[thread]
        wall = (size - 1.226869 * pitch + mill) / 2 if outside else (size - mill) / 2
        hand = -1 if keys.get("left_handed") else 1
        for x, y in PLACES:
            on_wall = [(math.atan2(b - y, a - x), z) for a, b, z in positions(self.program()) if abs(math.hypot(a - x, b - y) - wall) < 0.012]
            self.assertTrue(on_wall)
            phases = [z / pitch - hand * turn / (2 * math.pi) for turn, z in on_wall]
            off = max(abs((phase - phases[0] + 0.5) % 1 - 0.5) for phase in phases) * pitch
            self.assertLess(off, 0.012)
            nearest = max(math.hypot(a - x, b - y) for a, b, _ in positions(self.program()) if math.hypot(a - x, b - y) < wall + 0.5) \
                if not outside else min(math.hypot(a - x, b - y) for a, b, _ in positions(self.program()))
            self.assertAlmostEqual(nearest, wall, delta=0.012)
            for sector in range(12):
                zs = sorted(z + tooth * pitch for turn, z in on_wall if int((turn + math.pi) / (2 * math.pi) * 12) % 12 == sector
                            for tooth in range(keys.get("teeth", 1)))
                ends = [-keys["depth"] + pitch / 4, *[z for z in zs if z < 0], 0]
                self.assertLess(max(b - a for a, b in zip(ends, ends[1:])), pitch * 1.13)
                self.assertGreater(zs[0], -keys["depth"] - 0.001)

    def test_random_threads(self):
        draw = random.Random(54)
        for case in share_of(range(26)):
            thread = sorted(SIZES)[case % len(SIZES)]
            size, pitch, minor = SIZES[thread]
            outside = draw.random() < 0.4
            mill = round(draw.uniform(0.45, 0.93) * minor if not outside else draw.uniform(3, 5), 2)
            keys = {"depth": round(draw.uniform(1.2, 3) * max(pitch, 2), 2), "direction_of_cut": draw.choice(("climb", "conventional")),
                    "output": draw.choice(("arcs", "arcs", "lines")), "teeth": draw.choice((1, 1, 3, 8)), "passes": draw.choice((1, 1, 2, 3)),
                    "left_handed": draw.random() < 0.3}
            if outside:
                keys["side"] = "outside"
            with self.subTest(seed=54, case=case, thread=thread, mill=mill, keys=keys):
                self.job(thread, keys, mill, outside)
                self.assertNotIn("no operation before", self.planned())
                self.assert_thread(thread, keys, mill, outside)
                self.cusp(0, "verify", "job.toml", "p.ngc")

    def test_a_thread_is_cut_whole_where_an_earlier_program_has_been(self):
        self.job("M10", {"depth": 8}, 6)
        self.planned()
        whole = self.program().split("T1")[-1]
        self.job("M10", {"depth": 8}, 6)
        job = (self.folder / "job.toml").read_text()
        self.write("slot.ngc", "(tool 1 flat diameter 6 mm)\nG21 G90 G94\nT1 M6\nM3 S9000\nG0 X10 Y28 Z5\nG1 Z-3 F200\n"
                   "G1 X30 F600\nG0 Z5\nM5\nM2\n")
        self.write("job.toml", job.replace("[stock]", '[stock]\nprogram = "slot.ngc"'))
        self.planned()
        self.assertEqual(whole.split("M5")[0], self.program().split("T1")[-1].split("M5")[0])
        self.cusp(0, "verify", "job.toml", "p.ngc")

    def test_climb_is_up_against_the_clock_in_a_right_hand_hole(self):
        self.job("M10", {"depth": 8}, 6)
        self.planned()
        turns = re.findall(r"^(G[23]) .*Z", self.program().split("T1")[-1], re.M)
        self.assertEqual({"G3"}, set(turns))

    def test_a_wrong_program_is_found(self):
        self.job("M10", {"depth": 8}, 6)
        self.planned()
        self.cusp(0, "verify", "job.toml", "p.ngc")
        good = self.program()
        end = good.rindex("\nM5")
        # over the hole, at the thread's radius
        self.write("more.ngc", good[:end] + "\nG0 Z5\nG0 X22 Y30\nG0 Z1\nG1 Z0.1 F200\nG0 Z5" + good[end:])
        self.assertIn("all bounds hold", self.cusp(0, "verify", "job.toml", "more.ngc"))
        # across the wall of the thread, as another operation by the same tool
        self.write("more.ngc", good[:end] + "\nG0 Z5\nG0 X17 Y32\nG0 Z1\nG1 Z-0.3 F200\nG1 X23\nG0 Z5" + good[end:])
        self.assertNotIn("off its helix", self.cusp_of_any_status("verify", "job.toml", "more.ngc").stdout)
        head, thread = good[:good.index("\nT1\n")], good[good.index("\nT1\n"):]
        lines = thread.splitlines(keepends=True)
        arcs = [k for k, line in enumerate(lines) if line.startswith("G3") or (re.match(r"[XYIJZ]", line) and "I" in line)]
        faults = {
            "another pitch": (re.sub(r"Z(-?[0-9.]+)", lambda m: f"Z{float(m[1]) * (1.04 if float(m[1]) < 0 else 1):.4f}", thread), "off its helix"),
            "the other hand": (thread.replace("G3 ", "G2 "), "thread M10"),
            "half of it": ("".join(lines[:arcs[len(arcs) // 2]]) + "G0 Z5\nM5\nM30\n", "has no groove"),
            "too wide": (re.sub(r"(I|J)(-?[0-9.]+)", r"\1\2", thread).replace("X22", "X22.1"), "broken"),
        }
        for name, (text, words) in faults.items():
            with self.subTest(fault=name):
                self.assertNotEqual(text, thread)
                self.write("p.ngc", head + text)
                run = self.cusp_of_any_status("verify", "job.toml", "p.ngc")
                self.assertNotEqual(0, run.returncode, run.stdout)
                if run.returncode == 1:
                    self.assertIn(words, run.stdout)

    def cusp_of_any_status(self, *arguments):
        return subprocess.run([CUSP, *arguments], cwd=self.folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def test_a_hole_that_nothing_makes_is_a_warning_and_a_narrow_one_refused(self):
        self.job("M10", {"depth": 8}, 6, bored=False)
        self.write("job.toml", (self.folder / "job.toml").read_text().replace("[stock]\ntop = 0\n", "[stock]\ntop = 0\n"))
        said = self.cusp_of_any_status("plan", "job.toml", "-o", "p.ngc").stdout
        self.assertIn("no operation before it makes 2 holes of 8.376 mm for M10", said)
        self.job("M10", {"depth": 8}, 6)
        job = (self.folder / "job.toml").read_text()
        self.write("bores.dxf", drawing(5.5))
        self.write("job.toml", job)
        self.assertIn("the hole at x 20 y 30 is 5.5 mm wide by then, tool 1 is 6 mm", self.planned(2))

    def test_feeds_are_those_of_the_teeth(self):
        self.job("M10", {"depth": 8}, 6)
        self.planned()
        feeds = {float(f) for f in re.findall(r"F([0-9.]+)", self.program().split("\nT1\n")[-1])}
        self.assertIn(240, feeds)  # 600 x (10 - 6) / 10
        self.assertNotIn(600, feeds)

    def test_refusals(self):
        for keys, mill, words in (({"thread": "M6.1"}, 4, 'thread: is "M6.1", it must be a designation'),
                                  ({"thread": "M6x1.25"}, 4, "no coarser than the coarse series"), ({"thread": "1/4"}, 4, "it must be a designation"),
                                  ({"thread": "1/4-18"}, 4, "it must be a designation"), ({"thread": "M6"}, 5, "does not go into the bore of M6, 4.917 mm"),
                                  ({"teeth": 0}, 4, "teeth: is 0"), ({"side": "on"}, 4, 'side: is "on"')):
            with self.subTest(keys=keys):
                self.job("M6", {"depth": 5}, mill)
                job = (self.folder / "job.toml").read_text()
                for key, value in keys.items():
                    line = f"{key} = {json.dumps(value)}\n"
                    job = job.replace('thread = "M6"\n', line) if key == "thread" else job + line
                self.write("job.toml", job)
                self.assertIn(words, self.planned(2))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
