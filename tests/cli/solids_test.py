#!/usr/bin/env python3
"""Solids as the source of 2.5-D operations: regions as boundaries, jobs of one line.

usage: solids_test.py CUSP [--without-cad]; CUSP_PROPERTY_CASES and CUSP_PROPERTY_FIRST set the random plates

A program is cut again by stock_walk.py: nothing may be lower than the solid, and what the tool reaches is at its height.
"""
import json
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

for folder in ("judges", "support"):
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / folder))
from property_cases import property_cases, property_seed  # noqa: E402
from plate_mesh import PITCH, plate, stl  # noqa: E402
from stock_walk import StockWalk, rapid_in_stock  # noqa: E402

CUSP = str(pathlib.Path(sys.argv[1]).resolve())
WITH_CAD = "--without-cad" not in sys.argv
CASES = property_cases(2)
FIRST = property_seed(1)
BRACKET = pathlib.Path(__file__).resolve().parents[2] / "examples/bracket/bracket.step"


def random_plate(seed):
    """Heights of squares in blocks of three, so that a flat end of 4 mm reaches most of them."""
    r = random.Random(seed)
    blocks = [[r.choice((0, 2, 4.5, 7)) for _ in range(3)] for _ in range(3)]
    blocks[r.randrange(3)][r.randrange(3)] = 7
    return [[blocks[i // 3][j // 3] for j in range(9)] for i in range(9)]


class Solids(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name)

    def run_cusp(self, *arguments, status=0):
        done = subprocess.run([CUSP, *map(str, arguments)], cwd=self.folder, text=True, timeout=300, capture_output=True)
        self.assertEqual(status, done.returncode, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def write_plate(self, heights):
        (self.folder / "plate.stl").write_text(stl(plate(heights)))

    def job(self, operations, diameter=4, stock=(0, 36, 0, 36, 7)):
        x0, x1, y0, y1, top = stock
        (self.folder / "job.toml").write_text(
            f'post = "linuxcnc"\n[[tool]]\nshape = "flat"\ndiameter = {diameter}\n[cutting]\nfeed = 800\n'
            f"[stock]\ntop = {top}\nbottom = 0\nx = [{x0}, {x1}]\ny = [{y0}, {y1}]\n" +
            "".join(f"[[operation]]\n{text}\n" for text in operations))

    def one_line(self, *arguments):
        """Plans a part without a job, verifies it by the printed job; what is said, and the program."""
        arguments = (*arguments, "--post", "linuxcnc")
        said = self.run_cusp("plan", "--estimate-times", *arguments, "-o", "p.ngc")
        printed = subprocess.run([CUSP, "plan", *map(str, arguments), "--print-job"], cwd=self.folder, text=True,
                                 timeout=300, capture_output=True, check=True)
        (self.folder / "job.toml").write_text(printed.stdout)
        self.assertIn("all bounds hold", self.run_cusp("verify", "job.toml", "p.ngc"))
        return said, (self.folder / "p.ngc").read_text()

    def check_cut(self, heights, program, top=7.0, radius=2.0):
        wide, deep = PITCH * len(heights), PITCH * len(heights[0])
        stock = StockWalk((0, wide), (0, deep), top, 0.0)
        self.assertEqual("", rapid_in_stock(stock, program))
        reached = 0
        for i, column in enumerate(stock.heights):
            for j, z in enumerate(column):
                x, y = stock.x0 + 0.5 * i, stock.y0 + 0.5 * j
                wanted = heights[int(x / PITCH)][int(y / PITCH)]
                around = [heights[int(a / PITCH)][int(b / PITCH)]
                          for a in (x - 2 * radius, x, x + 2 * radius) for b in (y - 2 * radius, y, y + 2 * radius)
                          if 0 <= a < wide and 0 <= b < deep]
                self.assertGreaterEqual(z, wanted - 0.003, f"at x {x} y {y}")
                if all(height <= wanted for height in around):  # a disc around the point fits there
                    reached += 1
                    self.assertAlmostEqual(z, wanted, delta=0.003, msg=f"at x {x} y {y}")
        self.assertGreater(reached, 200)

    def test_random_plates_are_cut_to_size_by_a_flat_end(self):
        for seed in range(FIRST, FIRST + CASES):
            with self.subTest(seed=seed):
                heights = random_plate(seed)
                self.write_plate(heights)
                _, program = self.one_line("plate.stl", "--tool", "flat:4")
                self.check_cut(heights, program)

    def test_stock_over_the_part_is_faced_first(self):
        heights = random_plate(4)
        self.write_plate(heights)
        said, program = self.one_line("plate.stl", "--tool", "flat:4", "--stock-top", 8.5)
        self.assertIn("top: face, flat 4 mm, 1.5 mm deep", said)
        self.check_cut(heights, program, top=8.5)

    def test_a_hole_of_the_mesh_is_closed_and_not_milled_through(self):
        heights = [[7] * 9 for _ in range(9)]
        for i in range(3, 6):
            for j in range(3, 6):
                heights[i][j] = 3
        (self.folder / "plate.stl").write_text(stl(plate(heights, {(4, 4)})))
        said, program = self.one_line("plate.stl", "--tool", "flat:4")
        self.assertIn("plate.stl: facets are missing: 1 hole of the part open above: 4 x 4 mm", said)
        self.check_cut(heights, program)

    def test_a_ball_is_not_used_where_all_ground_is_level(self):
        self.write_plate(random_plate(5))
        said, program = self.one_line("plate.stl", "--tool", "flat:4", "ball:3", "--scallop", 0.05)
        self.assertIn("all ground is level: the ball is not used", said)
        self.assertFalse("T2" in program)

    def test_slanted_ground_without_a_ball_is_told(self):
        facets = plate([[4] * 4] * 4)
        for k, facet in enumerate(facets):  # the top rises along x
            facets[k] = tuple((x, y, z + 0.1 * x if z > 0 else z) for x, y, z in facet)
        (self.folder / "ramp.stl").write_text(stl(facets))
        said = self.run_cusp("plan", "ramp.stl", "--tool", "flat:4", "-o", "p.ngc", status=2)
        self.assertIn("ramp.stl: a flat end has nothing to cut: 256 mm2 of slanted ground", said)
        (self.folder / "ramp.stl").write_text(stl(facets + [
            tuple((x + 20, y, z) for x, y, z in facet) for facet in plate([[2] * 4] * 4)]))
        said, _ = self.one_line("ramp.stl", "--tool", "flat:4")
        self.assertIn("slanted ground stays, 256 mm2 seen from above", said)

    def test_the_walls_of_a_sculptured_part_are_finished_by_the_flat_end(self):
        """A ramp between upright walls: the ball can't go along them."""
        facets = plate([[7] * 9 if i in (0, 8) else [7, 2, 2, 2, 2, 2, 2, 2, 7] for i in range(9)])
        tilted = [tuple((x, y, z + 0.02 * x if z == 2 else z) for x, y, z in facet) for facet in facets]
        (self.folder / "tray.stl").write_text(stl(tilted))
        said, program = self.one_line("tray.stl", "--tool", "flat:4", "ball:3", "--scallop", 0.05, "--allowance", 0.6)
        self.assertIn("keep the allowance", said)  # the walls along the ramp: their feet rise
        self.assertIn("along the upright walls", said)
        stock = StockWalk((0, 36), (0, 36), 7.0, 0.0)
        self.assertEqual("", rapid_in_stock(stock, program))
        # beside the wall at the low end, where roughing leaves all
        row = [stock.heights[int((4.25 - stock.x0) / 0.5 + 0.5)][j] for j in range(20, 50)]
        self.assertLess(max(row), 2.65)

    def test_regions_are_boundaries(self):
        heights = [[7] * 9 for _ in range(9)]
        for i in range(2, 7):
            for j in range(3, 6):
                heights[i][j] = 3
        self.write_plate(heights)
        for text in ('strategy = "pocket"\nboundary = "plate.stl#below:3"\ndepth = 4',
                     'strategy = "pocket"\nboundary = "plate.stl#level:3"\ndepth = 4',
                     'strategy = "pocket"\nboundary = "plate.stl#level:3"\ndepth = 4\noutput = "arcs"'):
            self.job([text])
            self.run_cusp("plan", "job.toml", "-o", "p.ngc")
            self.assertIn("all bounds hold", self.run_cusp("verify", "job.toml", "p.ngc"))
            self.check_cut(heights, (self.folder / "p.ngc").read_text())
        self.job(['strategy = "profile"\nboundary = "plate.stl#outline"\ndepth = 7'], stock=(-9, 45, -9, 45, 7))
        self.run_cusp("plan", "job.toml", "-o", "p.ngc")
        self.assertIn("all bounds hold", self.run_cusp("verify", "job.toml", "p.ngc"))
        self.assertTrue("X-2" in (self.folder / "p.ngc").read_text())

    def test_a_region_is_that_of_the_part_as_it_is_placed(self):
        heights = [[7] * 9 for _ in range(9)]
        heights[3][3] = heights[3][4] = heights[4][3] = heights[4][4] = 3
        self.write_plate(heights)
        self.job(['strategy = "pocket"\nboundary = "plate.stl#level:-4"\ndepth = 4'], stock=(0, 36, 0, 36, 0))
        path = self.folder / "job.toml"
        path.write_text(path.read_text().replace("bottom = 0", "bottom = -7") + '[placing]\norigin = "corner"\n')
        self.run_cusp("plan", "job.toml", "-o", "p.ngc")
        self.assertIn("all bounds hold", self.run_cusp("verify", "job.toml", "p.ngc"))
        self.assertTrue(" Z-3.99" in (self.folder / "p.ngc").read_text())

    def test_wrong_regions_are_refused_with_what_there_is(self):
        self.write_plate(random_plate(1))
        for region, words in (("#walls", 'a part has no "walls"; its regions are #outline, #above:Z'),
                              ("#above", '"" is no height: a number is needed'),
                              ("#level:x", '"x" is no height'), ("#level:1e999", "is no height"),
                              ("#level:3", "no level ground at z 3 mm; it is at z"),
                              ("#above:7", "nothing stands above z 7 mm; the part reaches from z 0 to 7 mm"),
                              ("#below:-1", "nothing is to be cut down to z -1 mm")):
            self.job([f'strategy = "pocket"\nboundary = "plate.stl{region}"\ndepth = 1'])
            self.assertIn(words, self.run_cusp("plan", "job.toml", "-o", "p.ngc", status=2))

    def test_requests_that_can_not_be_met_name_the_option(self):
        self.write_plate(random_plate(1))
        for options, words in ((("drill:3",), "--tool: level ground and upright walls need a flat end"),
                               (("flat:80",), "--tool flat:80: its diameter is 80 mm, the part is only 36 x 36"),
                               (("ball:4", "vee:6:60", "--scallop", "0.1"), "--tool vee:6:60: is for drawings"),
                               (("flat:4", "--stock-top", "5"), "--stock-top: is 5 mm, but plate.stl rises to z = 7"),
                               (("flat:4", "--depth", "5"), "--depth: is for drawings")):
            self.assertIn(words, self.run_cusp("plan", "plate.stl", "--tool", *options, "-o", "p.ngc", status=2))
            self.assertFalse((self.folder / "p.ngc").exists())

    def test_inches(self):
        self.write_plate(random_plate(6))
        said, program = self.one_line("plate.stl", "--tool", "flat:0.15", "--units", "inch", "--scale", 1 / 25.4)
        self.assertTrue("G20" in program)
        self.assertIn("inch from above", said)

    @unittest.skipUnless(WITH_CAD, "no Open CASCADE")
    def test_a_step_part_has_its_holes_drilled_and_its_levels_cleared(self):
        (self.folder / "bracket.step").write_bytes(BRACKET.read_bytes())
        said, program = self.one_line("bracket.step", "--tool", "flat:5", "drill:6", "drill:6.6")
        self.assertIn("4 holes of 6 mm, all through: drill, drill 6 mm", said)
        self.assertIn("1 hole of 12 mm, none through: bore, flat 5 mm", said)
        self.assertIn("z 15 to 9: cleared, flat 5 mm", said)
        cycle = program.split("\nT2 ")[1].split("G80")[0].splitlines()
        self.assertEqual(4, sum("G81" in line or "G83" in line or line.startswith("X") for line in cycle))
        _, program = self.one_line("bracket.step", "--tool", "flat:5")  # against the part's surfaces
        (self.folder / "surface.toml").write_text(
            '[[tool]]\nshape = "flat"\ndiameter = 5\n[[tool]]\n'
            'number = 4\nshape = "ball"\ndiameter = 4\n[cutting]\n'
            "feed = 800\n[stock]\ntop = 15\nbottom = 0\nx = [0, 80]\ny = [0, 50]\n[[operation]]\n"
            'strategy = "adaptive_isocurve"\nfloor = "bracket.step"\ntool = 4\nscallop = 0.05\n')
        subprocess.run([CUSP, "verify", "surface.toml", "p.ngc", "--stats", "v.json"], cwd=self.folder, check=False,
                       timeout=300, capture_output=True)
        figures = json.loads((self.folder / "v.json").read_text())
        self.assertLess(figures["gouge_max_mm"], 0.01)
        self.assertEqual(0, figures["rapid_cut_max_mm"])

    @unittest.skipUnless(WITH_CAD, "no Open CASCADE")
    def test_holes_are_left_out_of_the_pockets(self):
        (self.folder / "bracket.step").write_bytes(BRACKET.read_bytes())
        self.one_line("bracket.step", "--tool", "flat:4", "drill:6")
        self.assertIn("#below:9:no_holes", (self.folder / "job.toml").read_text())
        self.job(['strategy = "drill"\nboundary = "bracket.step#holes:10:12"'], diameter=6, stock=(0, 80, 0, 50, 15))
        path = self.folder / "job.toml"
        path.write_text(path.read_text().replace('"flat"', '"drill"'))
        self.run_cusp("plan", "job.toml", "-o", "p.ngc")
        self.assertIn("(drill: 1 hole", (self.folder / "p.ngc").read_text())
        path.write_text(path.read_text().replace("#holes:10:12", "#level:9"))
        self.assertIn("bracket.step#level:9: holes of a part are chosen by #holes:Z:Z",
                      self.run_cusp("plan", "job.toml", "-o", "p.ngc", status=2))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
