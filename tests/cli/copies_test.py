"""Copies of parts: on a sheet by their outlines, in a grid, in listed places. All are cut, none into another.

usage: copies_test.py CUSP
"""
import json
import re
import sys
import unittest

from cusp_case import CuspCase

ANGLE = [(0, 0), (60, 0), (60, 15), (15, 15), (15, 60), (0, 60)]
HOLE = (7.5, 50, 2.5)
HEAD = """units = "mm"
[[tool]]
shape = "flat"
diameter = 4
[cutting]
feed = 1000
[stock]
top = 0
bottom = -4
margin = 6
"""
PROFILE = """[[operation]]
strategy = "profile"
boundary = "angle.dxf"
loops = "outer"
side = "outside"
depth = 4
max_depth = 4
"""


def drawing(points, circle=None):
    lines = [(*a, *b) for a, b in zip(points, points[1:] + points[:1])]
    text = "".join(f"0\nLINE\n8\nl\n10\n{a}\n20\n{b}\n11\n{c}\n21\n{d}\n" for a, b, c, d in lines)
    if circle:
        text += "0\nCIRCLE\n8\nl\n10\n%g\n20\n%g\n40\n%g\n" % circle
    return f"0\nSECTION\n2\nENTITIES\n{text}0\nENDSEC\n0\nEOF\n"


def block(width, depth, height):
    """A box as STL, its lower corner at 0."""
    x, y, z = width, depth, height
    quads = [((0, 0, 0), (0, y, 0), (x, y, 0), (x, 0, 0)), ((0, 0, z), (x, 0, z), (x, y, z), (0, y, z)),
             ((0, 0, 0), (x, 0, 0), (x, 0, z), (0, 0, z)), ((x, 0, 0), (x, y, 0), (x, y, z), (x, 0, z)),
             ((x, y, 0), (0, y, 0), (0, y, z), (x, y, z)), ((0, y, 0), (0, 0, 0), (0, 0, z), (0, y, z))]
    facets = [f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))]
    corner = "vertex {} {} {}\n".format
    return "solid s\n" + "".join("facet normal 0 0 0\nouter loop\n" + "".join(corner(*p) for p in f) +
                                 "endloop\nendfacet\n" for f in facets) + "endsolid s\n"


class Copies(CuspCase):
    def moves(self, name="p.ngc"):
        return [line for line in (self.folder / name).read_text().splitlines() if not line.startswith("(")]

    def sheet(self, status, *options):
        self.write("angle.dxf", drawing(ANGLE, HOLE))
        return self.cusp(status, "plan", "angle.dxf", "--tool", "flat:3", "drill:5", "--depth", "6", *options)

    def left(self):
        """Stock that stays beside the copies, mm^3; all bounds hold."""
        self.cusp(0, "verify", "job.toml", "p.ngc", "--stats", "v.json")
        return json.loads((self.folder / "v.json").read_text())["left_volume_mm3"]

    def test_angles_lie_in_each_other_and_all_are_cut(self):
        said = self.sheet(0, "--sheet", "300,200", "--copies", "12", "-o", "p.ngc")
        self.assertIn("300 x 200 mm, 4.5 apart", said)
        self.assertIn("12 outlines", said)
        job = self.write_job(self.sheet(0, "--sheet", "300,200", "--copies", "12", "--print-job"))
        self.cusp(0, "plan", "job.toml", "-o", "again.ngc")
        self.assertEqual(self.moves(), self.moves("again.ngc"))
        self.assertIn("180", job)  # two of them in the box of one and a half
        self.assertLess(self.left(), 1)
        for x, y in ((float(x), float(y)) for x, y in re.findall(r"X(-?[\d.]+) Y(-?[\d.]+)", "\n".join(self.moves()))):
            self.assertTrue(0 <= x <= 300 and 0 <= y <= 200, (x, y))

    def test_two_drawings_have_counts_of_their_own(self):
        self.write("strip.dxf", drawing([(0, 0), (90, 0), (90, 10), (0, 10)]))
        self.write("angle.dxf", drawing(ANGLE))
        call = ["plan", "angle.dxf", "strip.dxf", "--tool", "flat:3", "--depth", "3", "--sheet", "250,160"]
        said = self.cusp(0, *call, "--copies", "3,5", "-o", "p.ngc")
        self.assertIn("3 of angle.dxf, 5 of strip.dxf", said)
        self.assertIn("5 outlines", said)
        self.write_job(self.cusp(0, *call, "--copies", "3,5", "--print-job"))
        self.left()

    def test_what_does_not_fit_is_refused_with_what_does(self):
        said = self.sheet(2, "--sheet", "130,130", "--copies", "9", "-o", "p.ngc")
        self.assertRegex(said, r"--copies: is 9, but \d of angle.dxf fit on the sheet of 130 x 130 mm, 4.5 apart")
        self.assertIn("needs --sheet", self.sheet(2, "--copies", "2", "-o", "p.ngc"))
        self.assertIn("needs --sheet", self.sheet(2, "--gap", "2", "-o", "p.ngc"))
        self.assertIn("0 of angle.dxf fit", self.sheet(2, "--sheet", "0.3,0.2", "-o", "p.ngc"))
        self.assertIn("--copies: is 1.5", self.sheet(2, "--sheet", "99,99", "--copies", "1.5", "-o", "p.ngc"))
        self.assertIn("has 2 numbers, 1 for all", self.sheet(2, "--sheet", "99,99", "--copies", "1,2", "-o", "p.ngc"))

    def test_a_grid_of_a_job(self):
        self.write("angle.dxf", drawing(ANGLE))
        self.write("job.toml", HEAD + "[[placing]]\ngrid = [3, 2]\npitch = [70, 66]\n" + PROFILE)
        self.cusp(0, "plan", "job.toml", "-o", "p.ngc")
        self.left()
        # planted: the program of five copies leaves one uncut
        sound = (self.folder / "job.toml").read_text()
        places = [[70 * i, 66 * j] for j in range(2) for i in range(3)]
        self.write("job.toml", HEAD + f"[[placing]]\ncopies = {places[:5]}\n" + PROFILE)
        self.cusp(0, "plan", "job.toml", "-o", "five.ngc")
        self.write("job.toml", HEAD + f"[[placing]]\ncopies = {places}\n" + PROFILE)
        self.cusp(0, "plan", "job.toml", "-o", "six.ngc")
        self.assertEqual(self.moves(), self.moves("six.ngc"))
        self.write("job.toml", sound)
        self.assertIn("broken", self.cusp(1, "verify", "job.toml", "five.ngc"))

    def test_copies_that_cross_are_refused(self):
        self.write("angle.dxf", drawing(ANGLE))
        self.write("job.toml", HEAD + "[[placing]]\ngrid = [2, 1]\npitch = 30\n" + PROFILE)
        self.assertIn("angle.dxf: copies cross at x", self.cusp(2, "plan", "job.toml", "-o", "p.ngc"))

    def test_solids_are_copied_and_turned_with_their_set_up(self):
        self.write("block.stl", block(30, 20, 8))
        setups = '[[setup]]\nname = "top"\n[[setup]]\nname = "below"\nflip = "x"\n'
        job = HEAD.replace("bottom = -4\n", "bottom = -8\n").replace("margin = 6\n", "x = [-10, 90]\ny = [-10, 80]\n")
        places = '[[placing]]\norigin = "corner"\ncopies = [[0, 0], [60, 5], [10, 40]]\ncopies_rotate = [0, 90, 30]\n'
        cut = ('[[operation]]\nstrategy = "profile"\nsetup = "{}"\nboundary = "block.stl#outline"\nside = "outside"\n'
               'depth = 4\nmax_depth = 4\n')
        self.write("job.toml", job + setups + places + cut.format("top") + cut.format("below"))
        self.cusp(0, "plan", "job.toml", "-o", "p.ngc")
        self.cusp(0, "verify", "job.toml", "p-top.ngc")
        self.cusp(0, "verify", "job.toml", "p-below.ngc", "--after", "p-top.ngc")

    def test_wrong_places_are_named(self):
        self.write("angle.dxf", drawing(ANGLE))
        for keys, words in (("grid = [2, 2]", "grid: needs pitch"), ("pitch = 3", "pitch: needs grid"),
                            ("grid = [0, 2]\npitch = 3", "whole numbers"), ("grid = [2]\npitch = 3", "rows"), ("grid = [2, 2]\npitch = []", "pitch"),
                            ("copies = []", "has 0 places"), ("copies_rotate = 90", "needs copies"),
                            ("copies = [[0, 0], [70, 0]]\ncopies_rotate = [1, 2, 3]", "has 3 numbers"),
                            ("copies = [[0, 0]]\ngrid = [2, 2]\npitch = 9", "copies: is given beside grid: one of them"), ("copies = [1, 2]", "pairs")):
            self.write("job.toml", HEAD + f"[[placing]]\n{keys}\n" + PROFILE)
            said = self.cusp(2, "plan", "job.toml", "-o", "p.ngc")
            self.assertIn(words, said)
            self.assertIn("job.toml:", said)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
