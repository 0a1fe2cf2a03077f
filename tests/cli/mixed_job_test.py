"""A job of 3-D and 2.5-D operations: verified as planned, and with a fault planted in each of them.

usage: mixed_job_test.py CUSP
"""
import json
import re
import sys
import unittest

from cusp_case import CuspCase


# 30 x 20 mm, from z = -1 down to -3
SLOPE = {"shape": {"type": "surface", "count": 1, "data": [{
    "degree_u": 1, "degree_v": 1, "size_u": 2, "size_v": 2, "knotvector_u": [0, 0, 1, 1], "knotvector_v": [0, 0, 1, 1],
    "control_points": {"points": [[0, 0, -1], [0, 20, -1], [30, 0, -3], [30, 20, -3]], "weights": [1, 1, 1, 1]}}]}}

JOB = """
post = "mach3"
[[tool]]
shape = "ball"
diameter = 6
[[tool]]
shape = "drill"
diameter = 3
[[tool]]
shape = "flat"
diameter = 4
[[tool]]
shape = "vee"
diameter = 6
tip_angle = 60
[cutting]
feed = 1000
[stock]
top = 0
bottom = -6
x = [-6, 36]
y = [-6, 26]
[[operation]]
strategy = "parallel_planes"
floor = ["slope.json"]
scallop = 0.1
tool = 1
[[operation]]
strategy = "drill"
boundary = "plate.dxf#holes"
depth = 8
tool = 2
[[operation]]
strategy = "v_carve"
boundary = "plate.dxf#mark"
top = -1.5
depth = 1
scallop = 0.3
tool = 4
[[operation]]
strategy = "profile"
boundary = "plate.dxf#outline"
depth = 6
max_depth = 3
tabs = { count = 2, width = 5, height = 1 }
tool = 3
"""


# The same tool finishes the slope without a boundary and clears a pocket beside it.
ONE_TOOL = """
post = "mach3"
[[tool]]
shape = "{shape}"
diameter = 4
[cutting]
feed = 1000
[stock]
top = 0
bottom = -6
x = [-6, 66]
y = [-6, 26]
[[operation]]
strategy = "parallel_planes"
floor = ["slope.json"]
scallop = 0.3
[[operation]]
boundary = "plate.dxf#pocket"
{pocket}
"""
POCKETS = (("flat", 'strategy = "pocket"\ndepth = 2'),
           ("ball", 'strategy = "contour_pocket"\nfloor = ["level.json"]\nscallop = 0.1'))


def rectangle(layer, x0, y0, x1, y1):
    corners = "".join(f"10\n{x}\n20\n{y}\n" for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1)))
    return f"0\nLWPOLYLINE\n8\n{layer}\n90\n4\n70\n1\n{corners}"


class MixedJob(CuspCase):
    def setUp(self):
        super().setUp()
        entities = rectangle("outline", 0, 0, 30, 20) + rectangle("mark", 12, 8, 18, 12)
        entities += rectangle("pocket", 44, 4, 60, 16)
        entities += rectangle("near", 30.5, 3, 46, 17)
        entities += "0\nCIRCLE\n8\nholes\n10\n5\n20\n5\n40\n1.5\n"
        self.write("plate.dxf", f"0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n")
        self.write("slope.json", json.dumps(SLOPE))
        self.write("job.toml", JOB)
        self.cusp(0, "plan", "job.toml", "-o", "p.ngc")
        self.program = (self.folder / "p.ngc").read_text()

    def spoiled(self, old, new):
        self.assertIn(old, self.program)
        self.write("spoiled.ngc", self.program.replace(old, new, 1))
        return self.cusp(1, "verify", "job.toml", "spoiled.ngc", "--grid", "0.3")

    def test_holds_its_bounds(self):
        said = self.cusp(0, "verify", "job.toml", "p.ngc", "--grid", "0.3")
        self.assertIn("all bounds hold", said)
        self.assertIn("tabs_standing: 2", said)

    def test_is_found_spoiled_in_each_operation(self):
        self.assertIn("gouge_max_mm", self.spoiled("X30.3516 Z-3.0086", "X30.3516 Z-3.2086"))
        self.assertIn("wall_gouge_max_mm", self.spoiled("G98 G81 X5 Y5 ", "G98 G81 X5.3 Y5 "))
        self.assertIn("of operation 2 (drill)", self.spoiled("Z-8 R1", "Z-2 R1"))
        self.assertIn("gouge_max_mm", self.spoiled("Y8.5774 Z-2.5 F322.757\n", "Y8.5774 Z-2.8 F322.757\n"))

    def test_a_finish_elsewhere_excuses_no_cut_through_a_wall(self):
        level = json.dumps(SLOPE).replace("[0, 0, -1], [0, 20, -1], [30, 0, -3], [30, 20, -3]",
                                          "[42, 2, -2], [42, 18, -2], [62, 2, -2], [62, 18, -2]")
        self.assertIn("[42, 2, -2]", level)
        self.write("level.json", level)
        for shape, pocket in POCKETS:
            with self.subTest(shape=shape):
                self.write("job.toml", ONE_TOOL.format(shape=shape, pocket=pocket))
                self.cusp(0, "plan", "job.toml", "-o", "p.ngc")
                self.cusp(0, "verify", "job.toml", "p.ngc", "--grid", "0.3")
                lines = (self.folder / "p.ngc").read_text().splitlines()
                at_wall = max((k for k, line in enumerate(lines) if re.search(r" X(57\.9\d+|58)\b", line)))
                lines[at_wall] = re.sub(r"X(57\.9\d+|58)\b", "X58.3", lines[at_wall])
                self.write("spoiled.ngc", "\n".join(lines) + "\n")
                said = self.cusp(1, "verify", "job.toml", "spoiled.ngc", "--grid", "0.3")
                self.assertRegex(said, rf"broken: wall_gouge_max_mm 0\.(29|3)\d* by tool 1 .*, line {at_wall + 1}")

    def test_a_finish_excuses_no_cut_of_others_beside_its_ground(self):
        for strategy in ("parallel_planes", "steep_shallow"):
            with self.subTest(strategy=strategy):
                self.write("job.toml", ONE_TOOL.format(shape="flat", pocket=POCKETS[0][1]).replace(
                    "parallel_planes", strategy).replace("#pocket", "#near"))
                self.cusp(0, "plan", "job.toml", "-o", "p.ngc")
                self.cusp(0, "verify", "job.toml", "p.ngc", "--grid", "0.3")
                lines = (self.folder / "p.ngc").read_text().splitlines()
                at_wall = max(k for k, line in enumerate(lines) if re.search(r" X(32\.5\d*)\b", line))
                lines[at_wall] = re.sub(r"X32\.5\d*", "X32.2", lines[at_wall])
                self.write("spoiled.ngc", "\n".join(lines) + "\n")
                said = self.cusp(1, "verify", "job.toml", "spoiled.ngc", "--grid", "0.3")
                self.assertRegex(said, rf"broken: wall_gouge_max_mm 0\.(29|3)\d* by tool 1 .*, line {at_wall + 1}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
