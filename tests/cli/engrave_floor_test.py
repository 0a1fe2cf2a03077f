"""Engraving along curves on surfaces, by the formulas of a plane and of a cylinder, and by cusp verify.

usage: engrave_floor_test.py CUSP
"""
import json
import math
import re
import sys
import unittest

from cusp_case import CuspCase

WORD = re.compile(r"([A-Z])(-?[\d.]+)")
R = 60.0  # mm, of the cylinder along y, its top at z = 0 over x = 30

JOB = """
[[tool]]
shape = "taper"
diameter = 6
taper_angle = 15
corner_radius = 0.5
[[tool]]
shape = "vee"
diameter = 6
tip_angle = 60
[cutting]
feed = 1000
[stock]
x = [0, 60]
y = [0, 40]
bottom = -20
[[operation]]
strategy = "engrave"
floor = ["floor.json"]
boundary = "lines.dxf#mark"
depth = 0.4
floor_tolerance = 0.004
"""


def surface(points, weights, degree_u, knots_u):
    return {"shape": {"type": "surface", "count": 1, "data": [{
        "degree_u": degree_u, "degree_v": 1, "size_u": len(points) // 2, "size_v": 2, "knotvector_u": knots_u,
        "knotvector_v": [0, 0, 1, 1], "control_points": {"points": points, "weights": weights}}]}}


PLANE = surface([[0, 0, -1], [0, 40, -3], [60, 0, -7], [60, 40, -9]], [1] * 4, 1, [0, 0, 1, 1])
# an arc of +-30 degrees, exact
TIP = R / math.cos(math.pi / 6) - R
ARC = surface([[0, 0, R * math.cos(math.pi / 6) - R], [0, 40, R * math.cos(math.pi / 6) - R], [30, 0, TIP], [30, 40, TIP],
               [60, 0, R * math.cos(math.pi / 6) - R], [60, 40, R * math.cos(math.pi / 6) - R]],
              [1, 1, math.cos(math.pi / 6), math.cos(math.pi / 6), 1, 1], 2, [0, 0, 0, 1, 1, 1])


def polyline(layer, *points):
    return (f"0\nLWPOLYLINE\n8\n{layer}\n90\n{len(points)}\n70\n0\n" +
            "".join(f"10\n{x}\n20\n{y}\n" for x, y in points))


class EngraveFloor(CuspCase):
    def setUp(self):
        super().setUp()
        marks = polyline("mark", (10, 8), (50, 30)) + polyline("mark", (12, 30), (12, 12), (40, 12))
        marks += "0\nCIRCLE\n8\nmark\n10\n30\n20\n20\n40\n8\n"
        self.write("lines.dxf", f"0\nSECTION\n2\nENTITIES\n{marks}0\nENDSEC\n0\nEOF\n")

    # Places of the tip after each feed move but the plunges.
    def places(self):
        at, found, feed, last = {"X": 0.0, "Y": 0.0, "Z": 99.0}, [], False, None
        for line in re.sub(r"\(.*?\)", "", (self.folder / "p.ngc").read_text()).splitlines():
            words = WORD.findall(line)
            feed = next((n == "1" for letter, n in words if letter == "G" and n in ("0", "1")), feed)
            at.update({letter: float(n) for letter, n in words if letter in at})
            here = (at["X"], at["Y"], at["Z"])
            if feed and last and here[:2] != last[:2]:
                found.append((last, here))
            last = here
        return found

    # The tip's z over a floor, of a ball of the radius r at the tip.
    def judge(self, floor, height, tool, r, shifts=(), tolerance=0.004):
        self.write("floor.json", json.dumps(floor))
        self.write("job.toml", JOB + f"tool = {tool}\n")
        self.cusp(0, "plan", "--estimate-times", "job.toml", "-o", "p.ngc", "--stats", "p.json")
        planned = json.loads((self.folder / "p.json").read_text())["operations"][0]
        self.assertAlmostEqual(0.004, planned["gouge_bound_mm"], delta=2e-4)  # and the rounding of positions
        moves = self.places()
        self.assertGreater(len(moves), 10)
        length = 0
        for a, b in moves:
            length += math.dist(a[:2], b[:2])
            for share in (0, 0.3, 0.5, 0.8, 1):
                x, y, z = (p + share * (q - p) for p, q in zip(a, b))
                self.assertAlmostEqual(height(x, y, r) - 0.4, z, delta=tolerance, msg=f"x {x} y {y}")
        wanted = math.hypot(40, 22) + 18 + 28 + 16 * math.pi
        self.assertAlmostEqual(wanted, length, delta=0.01 * wanted)
        said = self.cusp(0, "verify", "job.toml", "p.ngc")
        self.assertIn("all bounds hold", said)
        # two hundredths too deep or too high, all along, are found
        text = (self.folder / "p.ngc").read_text()
        for by, words in shifts:
            self.write("off.ngc", "\n".join(
                line if "G0" in line or "(" in line else
                re.sub(r"Z(-?[\d.]+)", lambda m, by=by: f"Z{float(m[1]) + by:.4f}", line) for line in text.splitlines()))
            self.assertIn(words, self.cusp(1, "verify", "job.toml", "off.ngc"))

    def test_on_a_plane(self):
        slope = math.hypot(0.1, 0.05)
        height = lambda x, y, r: -1 - 0.1 * x - 0.05 * y + r * (math.hypot(1, slope) - 1)
        self.judge(PLANE, height, 1, 0.5, ((-0.02, "gouge_max_mm"), (0.02, "over the level of operation 1 (engrave)")))
        self.judge(PLANE, height, 2, 0)

    def test_on_a_cylinder(self):
        height = lambda x, y, r: math.sqrt((R + r) ** 2 - (x - 30) ** 2) - R - r
        self.judge(ARC, height, 1, 0.5)
        self.judge(ARC, height, 2, 0)

    def test_a_ball_ended_taper_cuts_its_profile_on_a_level(self):
        level = JOB.replace('floor = ["floor.json"]\n', "top = 0\n").replace("bottom = -20", "top = 0")
        self.write("job.toml", level)
        self.cusp(0, "plan", "--estimate-times", "job.toml", "-o", "p.ngc")
        self.assertIn("(tool 1 taper diameter 6 mm ball radius 0.5 mm tip angle 30)", (self.folder / "p.ngc").read_text())
        self.assertIn("all bounds hold", self.cusp(0, "verify", "job.toml", "p.ngc"))
        # the volume of 0.4 mm depth under a ball of 0.5 mm: its segment's area by the length
        said = self.cusp(0, "verify", "job.toml", "p.ngc", "--stats", "v.json", "--grid", "0.08") and \
            json.loads((self.folder / "v.json").read_text())
        h, r, a = 0.4, 0.5, math.radians(15)
        join, joined = r * math.cos(a), r * (1 - math.sin(a))
        # up to the join by the circle, then the flank
        area = (r * r * math.acos(1 - joined / r) - (r - joined) * join) + (h - joined) * (2 * join + (h - joined) * math.tan(a))
        length = math.hypot(40, 22) + 18 + 28 + 16 * math.pi
        self.assertAlmostEqual(area * length, said["removed_mm3"], delta=0.05 * area * length)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
