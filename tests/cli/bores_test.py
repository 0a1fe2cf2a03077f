"""Holes that are milled: to size, in few lines, and judged as such.

usage: bores_test.py CUSP
"""
import json
import math
import random
import re
import sys
import unittest

from cusp_case import CuspCase

HEAD = """units = "mm"
[[tool]]
shape = "{shape}"
diameter = {diameter}
[cutting]
feed = 1000
plunge_feed = 300
[stock]
top = 0
bottom = -20
x = [-10, 110]
y = [-10, 110]
"""


def circle(x, y, diameter):
    return f"0\nCIRCLE\n8\nholes\n10\n{x}\n20\n{y}\n40\n{diameter / 2}\n"


def drawing(*entities):
    return "0\nSECTION\n2\nENTITIES\n" + "".join(entities) + "0\nENDSEC\n0\nEOF\n"


class Bores(CuspCase):
    def job(self, circles, keys, diameter=6.0, shape="flat"):
        self.write("holes.dxf", drawing(*(circle(*one) for one in circles)))
        lines = "".join(f"{key} = {json.dumps(value)}\n" for key, value in keys.items())
        self.write("job.toml", HEAD.format(shape=shape, diameter=diameter) +
                   f'[[operation]]\nstrategy = "bore"\nboundary = "holes.dxf#holes"\n{lines}')

    def planned(self, status=0):
        return self.cusp(status, "plan", "job.toml", "-o", "p.ngc", "--stats", "p.json")

    def program(self):
        return (self.folder / "p.ngc").read_text()

    def holds(self):
        self.cusp(0, "verify", "job.toml", "p.ngc")

    def test_a_hole_a_little_wider_than_the_mill_takes_some_lines_and_seconds(self):
        self.job([(50, 50, 6.1)], {"depth": 6, "output": "arcs"})
        self.planned()
        self.assertLess(len(self.program().splitlines()), 45)
        self.assertLess(json.loads((self.folder / "p.json").read_text())["estimated_s"], 20)
        self.assertGreater(len(re.findall(r"^G3.* Z", self.program(), re.M)), 3)
        self.holds()

    def test_random_holes_are_bored_to_size(self):
        seed = 54
        draw = random.Random(seed)
        for case in range(12):
            mill = draw.choice((3.0, 6.0, 10.0))
            circles = [(25 * (k % 4) + 10, 25 * (k // 4) + 10, round(mill + draw.uniform(0.02, 22 - mill), 3))
                       for k in range(draw.randint(1, 6))]
            keys = {"depth": round(draw.uniform(1, 12), 2), "output": draw.choice(("lines", "arcs")),
                    "direction_of_cut": draw.choice(("climb", "conventional"))}
            if draw.random() < 0.5:
                keys["allowance"] = round(draw.uniform(0.05, 0.5), 2)
            if draw.random() < 0.3:
                keys["pitch"] = round(draw.uniform(0.3, 2), 2)
            if draw.random() < 0.3:
                keys["step_over"] = round(draw.uniform(0.3, 4), 2)
            shape = draw.choice(("flat", "flat", "bull"))
            self.job(circles, keys, mill, shape + ('"\ncorner_radius = 0.5\nname = "b' if shape == "bull" else ""))
            with self.subTest(seed=seed, case=case, keys=keys, circles=circles, mill=mill):
                self.planned()
                self.holds()
                self.ends_are_reached(circles, keys["depth"], mill)

    def ends_are_reached(self, circles, depth, mill):
        """The way of the axis at the bottom, apart from verify: as far from each centre as the hole is wider."""
        at, far = {"X": 0.0, "Y": 0.0, "Z": 5.0}, {}
        for line in self.program().splitlines():
            words = re.findall(r"([XYZ])(-?[\d.]+)", re.sub(r"\(.*?\)", "", line))
            at.update({axis: float(value) for axis, value in words})
            if abs(at["Z"] + depth) < 1e-4 and re.search("[XY]", line):
                near = min(circles, key=lambda c: math.hypot(c[0] - at["X"], c[1] - at["Y"]))
                away = math.hypot(near[0] - at["X"], near[1] - at["Y"])
                far[near] = max(far.get(near, 0), away)
        self.assertEqual(set(circles), set(far))
        for (x, y, diameter), away in far.items():
            self.assertAlmostEqual((diameter - mill) / 2, away, delta=2e-3, msg=f"x {x} y {y}")

    def test_planted_faults_are_found(self):
        self.job([(20, 20, 14), (60, 60, 9)], {"depth": 6, "output": "arcs", "allowance": 0.2})
        self.planned()
        sound, job = self.program(), (self.folder / "job.toml").read_text()
        for name, program, text in (
                ("too deep", sound, job.replace("depth = 6", "depth = 5.5")),
                ("too shallow", sound, job.replace("depth = 6", "depth = 6.5")),
                ("too wide", sound.replace("flat diameter 6 ", "flat diameter 6.5 "),
                 job.replace("diameter = 6.0", "diameter = 6.5")),
                ("too narrow", sound.replace("flat diameter 6 ", "flat diameter 5.6 "),
                 job.replace("diameter = 6.0", "diameter = 5.6")),
                ("beside", re.sub(r"(?m)^G0", "G10 L2 P1 X0.3\nG0", sound, count=1), job)):
            self.write("p.ngc", program)
            self.write("job.toml", text)
            self.assertIn("broken", self.cusp(1, "verify", "job.toml", "p.ngc"), name)

    def test_a_wall_within_another_hole_is_none(self):
        draw = random.Random(256)
        for _ in range(8):
            wide, apart, turn = draw.uniform(6.2, 11), draw.uniform(2, 5), draw.uniform(0, 2 * math.pi)
            self.job([(50, 50, 8), (50 + apart * math.cos(turn), 50 + apart * math.sin(turn), wide)], {"depth": 4})
            self.planned()
            self.holds()
        sound = self.program()
        self.write("p.ngc", re.sub(r"(?m)^G0", "G10 L2 P1 X0.3\nG0", sound, count=1))
        self.assertIn("wall_gouge_max_mm 0.3", self.cusp(1, "verify", "job.toml", "p.ngc"))

    def test_holes_without_room_are_left_out_or_refused(self):
        self.job([(20, 20, 6), (60, 60, 9), (80, 80, 3)], {"depth": 6})
        self.assertEqual(2, self.planned().count("is narrower than tool 1"))
        self.holds()
        self.job([(20, 20, 6)], {"depth": 6})
        self.assertIn("is smaller than tool 1 of 6 mm with room to move", self.planned(2))
        self.job([(20, 20, 9)], {})
        self.assertIn("bore needs how deep it cuts", self.planned(2))
        self.job([(20, 20, 9)], {"depth": 3}, shape="ball")
        self.assertIn("bore needs a flat or a bull end", self.planned(2))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]], verbosity=2)
