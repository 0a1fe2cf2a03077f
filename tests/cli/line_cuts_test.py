"""Slots and profiles along lines, and reliefs at corners: cut to size, judged as such, without lifts between levels.

usage: line_cuts_test.py CUSP
"""
import json
import math
import random
import re
import sys
import unittest

from cusp_case import CuspCase, share_of

HEAD = """units = "mm"
[[tool]]
shape = "flat"
diameter = {diameter}
[cutting]
feed = 1000
plunge_feed = 300
[stock]
top = 0
bottom = -10
x = [-30, 130]
y = [-30, 130]
[[operation]]
boundary = "lines.dxf#l"
"""
BENT = [(10, 10), (50, 10), (50, 40), (80, 60)]
VEE = [(20, 20), (40, 50), (60, 20)]
SQUARE = [(10, 10), (60, 10), (60, 45), (10, 45)]
ANGLE = [(10, 10), (70, 10), (70, 30), (40, 30), (40, 60), (10, 60)]
TRIANGLE = [(10, 10), (70, 10), (30, 60)]


def polyline(points, closed, bulges=()):
    bulges = list(bulges) + [0] * len(points)
    return f"0\nLWPOLYLINE\n8\nl\n90\n{len(points)}\n70\n{closed}\n" + "".join(
        f"10\n{x:.4f}\n20\n{y:.4f}\n42\n{b:.4f}\n" for (x, y), b in zip(points, bulges))


class LineCuts(CuspCase):
    def plan(self, entities, keys, diameter=6.0, status=0):
        self.write("lines.dxf", "0\nSECTION\n2\nENTITIES\n" + "".join(entities) + "0\nENDSEC\n0\nEOF\n")
        self.write("job.toml", HEAD.format(diameter=diameter) +
                   "".join(f"{key} = {json.dumps(value)}\n" for key, value in keys.items()))
        return self.cusp(status, "plan", "--estimate-times", "job.toml", "-o", "p.ngc", "--stats", "p.json")

    def holds(self):
        self.cusp(0, "verify", "job.toml", "p.ngc")

    def broken(self, change, job=lambda text: text):
        sound, text = (self.folder / "p.ngc").read_text(), (self.folder / "job.toml").read_text()
        self.write("p.ngc", change(sound))
        self.write("job.toml", job(text))
        said = self.cusp(1, "verify", "job.toml", "p.ngc")
        self.write("p.ngc", sound)
        self.write("job.toml", text)
        return said

    def test_profiles_run_on_either_side_of_open_lines(self):
        for points, bulges in ((BENT, ()), (VEE, ()), ([(10, 50), (40, 60), (60, 90)], (0.4, -0.5))):
            for side in ("left", "right", "on"):
                for output in ("lines", "arcs"):
                    with self.subTest(points=points, side=side, output=output):
                        self.plan([polyline(points, 0, bulges)],
                                  {"strategy": "profile", "side": side, "depth": 4, "max_depth": 2, "output": output})
                        self.assertEqual(1, json.loads((self.folder / "p.json").read_text())["retracts"])
                        self.holds()

    def test_lines_on_the_wrong_side_or_too_near_are_found(self):
        keys = {"strategy": "profile", "side": "left", "depth": 4, "output": "arcs"}
        self.plan([polyline(BENT, 0)], keys)
        other = lambda text: text.replace('"left"', '"right"')
        self.assertIn("broken", self.broken(lambda program: program, other))
        near = lambda program: re.sub(r"(?m)^G0", "G10 L2 P1 Y-0.3\nG0", program, count=1)
        self.assertIn("wall_gouge_max_mm", self.broken(near))
        far = lambda program: re.sub(r"(?m)^G0", "G10 L2 P1 Y0.3\nG0", program, count=1)
        self.assertIn("broken", self.broken(far))

    def test_random_slots_are_as_wide_as_asked_for(self):
        seed = 55
        draw = random.Random(seed)
        taken = share_of(range(10))
        for case in range(10):
            mill = draw.choice((3.0, 6.0))
            count = draw.randint(2, 5)
            points = [(draw.uniform(0, 25) + 25 * k, draw.uniform(0, 100)) for k in range(count)]
            bulges = [draw.choice((0, 0, draw.uniform(-0.6, 0.6))) for _ in range(count - 1)]
            keys = {"strategy": "slot", "depth": 3, "output": draw.choice(("lines", "arcs")),
                    "direction_of_cut": draw.choice(("climb", "conventional"))}
            if draw.random() < 0.8:
                keys["width"] = round(mill + draw.uniform(0, 3 * mill), 2)
            if draw.random() < 0.5:
                keys["max_depth"] = 1
            if case not in taken:
                continue
            with self.subTest(seed=seed, case=case, keys=keys, points=points, bulges=bulges, mill=mill):
                self.plan([polyline(points, 0, bulges)], keys, mill)
                self.assertEqual(1, json.loads((self.folder / "p.json").read_text())["retracts"])
                self.holds()

    def test_slots_along_closed_lines_and_their_faults(self):
        self.plan([polyline(SQUARE, 1)], {"strategy": "slot", "depth": 3, "width": 9, "output": "arcs"})
        self.holds()
        wider = lambda text: text.replace("width = 9", "width = 10")
        self.assertIn("left", self.broken(lambda program: program, wider))
        narrower = lambda text: text.replace("width = 9", "width = 8")
        self.assertIn("wall_gouge_max_mm", self.broken(lambda program: program, narrower))
        self.assertIn("is 5 mm, tool 1 is 6 mm wide",
                      self.plan([polyline(SQUARE, 1)], {"strategy": "slot", "depth": 3, "width": 5}, status=2))

    def test_square_corners_fit_into_reliefs(self):
        for points in (SQUARE, ANGLE, TRIANGLE):
            for relief in ("dogbone", "t_bone"):
                for more in ({"strategy": "pocket"}, {"strategy": "profile", "side": "inside"},
                             {"strategy": "profile", "side": "outside"}):
                    with self.subTest(points=points, relief=relief, more=more):
                        self.plan([polyline(points, 1)], {**more, "depth": 2, "relief": relief, "output": "arcs"})
                        self.holds()
                        self.corners_are_cut(points, more.get("side") != "outside")

    def corners_are_cut(self, points, inside):
        """The axis comes to each inner corner as near as the tool's radius, 0.1 mm of room allowed."""
        at, way = {"X": 0.0, "Y": 0.0}, []
        for line in (self.folder / "p.ngc").read_text().splitlines():
            words = re.findall(r"([XY])(-?[\d.]+)", re.sub(r"\(.*?\)", "", line))
            at.update({axis: float(value) for axis, value in words})
            if words and not line.startswith("G0"):
                way.append((at["X"], at["Y"]))
        for k, corner in enumerate(points):
            (ax, ay), (bx, by) = points[k - 1], points[(k + 1) % len(points)]
            turn = (corner[0] - ax) * (by - corner[1]) - (corner[1] - ay) * (bx - corner[0])
            if (turn > 0) == inside:
                self.assertLess(min(math.dist(corner, p) for p in way), 3.1, corner)

    def test_a_pocket_without_reliefs_is_told_from_one_with(self):
        self.plan([polyline(SQUARE, 1)], {"strategy": "pocket", "depth": 2})
        with_relief = lambda text: text + 'relief = "dogbone"\n'
        self.assertIn("broken", self.broken(lambda program: program, with_relief))
        self.plan([polyline(SQUARE, 1)], {"strategy": "pocket", "depth": 2, "relief": "dogbone"})
        without = lambda text: text.replace('relief = "dogbone"\n', "")
        self.assertIn("wall_gouge_max_mm", self.broken(lambda program: program, without))

    def test_what_can_not_be_is_refused_in_words(self):
        line = [polyline(BENT, 0)]
        for keys, words in (({"side": "outside"}, "open"),
                            ({"side": "left", "relief": "dogbone"}, "outside or inside closed loops"),
                            ({"side": "left", "allowance": 0.2}, "tabs and allowance are of closed loops")):
            self.assertIn(words, self.plan(line, {"strategy": "profile", "depth": 2, **keys}, status=2))
        small = [polyline([(0, 0), (13, 0), (13, 13), (0, 13)], 1)]
        said = self.plan(small, {"strategy": "pocket", "depth": 1, "relief": "dogbone"}, status=0)
        self.assertNotIn("too short", said)
        small = [polyline([(0, 0), (8, 0), (8, 30), (0, 30)], 1)]
        said = self.plan(small, {"strategy": "pocket", "depth": 1, "relief": "dogbone"}, status=0)
        self.assertIn("4 corners have sides too short for a relief", said)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]], verbosity=2)
