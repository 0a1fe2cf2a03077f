#!/usr/bin/env python3
"""Holes and chamfers of solids in jobs of one line: each is cut to size by a tool of the call, or named.

usage: solid_features_test.py CUSP; CUSP_PROPERTY_CASES and CUSP_PROPERTY_FIRST set the random blocks

The judge is swept_heights.py: it samples the program's tool positions and is asked beside each wall, over each floor
and on each cone whether the point is gone that has to be, and whether the one 0.02 mm inside of the part is left.
"""
import math
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import unittest

for folder in ("judges", "support", "generators"):
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / folder))
from featured_block import TIP, FeaturedBlock, RoundHole  # noqa: E402
from property_cases import property_cases, property_seed  # noqa: E402
from stock_walk import StockWalk, rapid_in_stock  # noqa: E402
from swept_heights import SweptHeights  # noqa: E402

CUSP = str(pathlib.Path(sys.argv[1]).resolve())
CASES = property_cases(4)
FIRST = property_seed(1)
WITHIN = 0.02  # mm
DIAMETERS = (3.0, 4.0, 5.0, 6.5)
AROUND = [2 * math.pi * (k + 0.3) / 16 for k in range(16)]


class Tools:
    """Of a call, and what they can make."""
    def __init__(self, flats, drills, vees=(), vees_first=False):
        self.flats, self.drills, self.vees, self.vees_first = flats, drills, vees, vees_first

    def words(self):
        vees = [f"vee:{d}:90" for d in self.vees]
        others = [f"flat:{d}" for d in self.flats] + [f"drill:{d}" for d in self.drills]
        return vees + others if self.vees_first else others + vees

    def breaks(self, width, height):
        """Whether a vee of 90 degrees has a flank for an edge: its tip runs 0.2 mm beside it."""
        return abs(width - height) < 1e-6 and any(width + 0.2 <= d / 2 for d in self.vees)

    def drills_to(self, radius):
        return 2 * radius in self.drills

    def mills(self, radius):
        return any(d <= 2 * radius for d in self.flats)

    def makes(self, hole):
        narrow = hole.radius
        return self.drills_to(narrow) or self.mills(narrow)


def faults_of_hole(cut, hole, tools):
    """Where a hole isn't at its diameter, depth or cone: words; and how many points were asked."""
    faults, asked = [], 0

    def ask(away, z, gone, what):
        nonlocal asked
        for angle in AROUND:
            x, y = hole.x + away * math.cos(angle), hole.y + away * math.sin(angle)
            asked += 1
            if (cut.at(x, y) <= z) != gone:
                faults.append(f"{hole.kind} at {hole.x:.3f} {hole.y:.3f}, {what}, z {z:.3f}: "
                              f"{'stands' if gone else 'gouged'} at radius {away:.3f}")
                return

    for k, ((a, p), (b, q)) in enumerate(zip(hole.profile, hole.profile[1:])):
        last = k + 2 == len(hole.profile)
        drilled = a == b == hole.radius and tools.drills_to(a)
        tip = a * TIP if drilled and last and not hole.through else 0.0
        if a == b:
            for z in (p - WITHIN, (p + q + tip) / 2, q + tip + WITHIN):
                ask(a - WITHIN, z, True, f"wall of {2 * a} mm")
                ask(a + WITHIN, z, False, f"wall of {2 * a} mm")
        else:
            for share in (0.05, 0.5, 0.95):
                away, z = a + (b - a) * share, p + (q - p) * share
                if p == q or (b > 0 and tools.breaks(a - b, p - q)):
                    ask(away, z + WITHIN, True, "step" if p == q else "cone")
                ask(away, z - WITHIN, False, "step" if p == q else "cone")
    radius, floor = hole.profile[-1]
    if hole.through:
        ask(hole.radius - WITHIN, -0.3, True, "below")
    elif radius > 0:
        for share in (0.0, 0.5, 0.97):
            if share == 0.0 or not tools.drills_to(radius):
                ask(radius * share, floor + WITHIN, True, "floor")
            ask(radius * share, floor - WITHIN, False, "floor")
    return faults, asked


def faults_of_ground(cut, block, tools):
    """Where the block is cut too deep, and where level ground stands that the last flat end reaches."""
    faults, reach = [], tools.flats[-1]
    for i in range(57):
        for j in range(40):
            x, y = 0.35 + 0.7 * i, 0.35 + 0.7 * j
            around = [block.height(x + a, y + b) for a in (-0.03, 0, 0.03) for b in (-0.03, 0, 0.03)]
            lowest, z = min(around), cut.at(x, y)
            if z < lowest - WITHIN:
                faults.append(f"gouged to {z:.3f} at {x:.2f} {y:.2f}, not {lowest:.3f}")
            rim = min(x, y, (block.edge or block.wide) - x, block.deep - y)
            if block.chamfer and 0.03 < rim < block.chamfer - 0.03 and tools.breaks(block.chamfer, block.chamfer):
                if z > block.height(x, y) + WITHIN:
                    faults.append(f"chamfer stands to {z:.3f} at {x:.2f} {y:.2f}, not {block.height(x, y):.3f}")
            on_shelf = block.edge is not None and block.edge + 0.03 < x
            if on_shelf and max(around) == block.shelf and z > block.shelf + WITHIN:
                faults.append(f"stands to {z:.3f} at {x:.2f} {y:.2f}, not {block.shelf:.3f}, tool {reach}")
    return faults


class SolidFeatures(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name)

    def run_cusp(self, *arguments):
        done = subprocess.run([CUSP, *map(str, arguments)], cwd=self.folder, text=True, timeout=300, capture_output=True)
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        return done

    def plan(self, block, tools, *options):
        """The messages of planning a block, and its program, which cusp verifies by the printed job."""
        (self.folder / "part.step").write_text(block.step())
        arguments = ("plan", "--estimate-times", "part.step", "--tool", *tools.words(), "--post", "linuxcnc", *options)
        done = self.run_cusp(*arguments, "-o", "p.ngc")
        (self.folder / "job.toml").write_text(self.run_cusp(*arguments, "--print-job").stdout)
        self.assertIn("all bounds hold", self.run_cusp("verify", "job.toml", "p.ngc").stdout)
        return done.stdout + done.stderr, (self.folder / "p.ngc").read_text()

    def check(self, block, tools, said, program):
        cut = SweptHeights(program)
        faults, asked = faults_of_ground(cut, block, tools), 0
        for hole in block.holes:
            if tools.makes(hole):
                found, count = faults_of_hole(cut, hole, tools)
                faults, asked = faults + found, asked + count
            else:
                self.assertRegex(said, rf"of {2 * hole.radius:g} mm[^\n]*: stay[^\n]*x {hole.x:.6g} y {hole.y:.6g}")
        self.assertEqual([], faults, program)
        return asked

    def test_holes_are_made_to_size_by_what_the_call_has(self):
        asked = 0
        for seed in range(FIRST, FIRST + CASES):
            with self.subTest(seed=seed):
                r = random.Random(seed)
                block = FeaturedBlock(seed, DIAMETERS)
                flats = r.choice(([3.0], [6.0, 3.0], [4.0], [5.0, 2.0]))
                tools = Tools(flats, r.sample(DIAMETERS, r.choice((0, 1, 2))))
                said, program = self.plan(block, tools)
                asked += self.check(block, tools, said, program)
        self.assertGreater(asked, 300 * CASES)

    def test_edges_and_mouths_are_broken_by_a_vee(self):
        asked, edges = 0, 0
        for seed in range(FIRST, FIRST + CASES):
            with self.subTest(seed=seed):
                r = random.Random(seed)
                block = FeaturedBlock(seed, DIAMETERS, chamfered=True)
                tools = Tools([r.choice((3.0, 2.5))], r.sample(DIAMETERS, 1), [r.choice((4.0, 6.0))], r.random() < 0.5)
                said, program = self.plan(block, tools)
                asked += self.check(block, tools, said, program)
                left = not tools.breaks(block.chamfer, block.chamfer)
                edges += 0 if left else 1
                self.assertEqual(left, "the vee's flank is too narrow; --tool vee:" in said and
                                 f"{block.chamfer:g} mm wide: stay" in said, said)
                self.assertNotIn("slanted ground stays, 0 ", said)
        self.assertGreater(asked, 300 * CASES)
        self.assertGreater(edges, 0)

    def test_the_judge_finds_chamfers_that_are_missing_or_wrong(self):
        block, tools = FeaturedBlock(FIRST, DIAMETERS, chamfered=True), Tools([2.5], [], [6.0])
        self.plan(block, tools)
        job = (self.folder / "job.toml").read_text()
        self.assertIn("#edges:", job)
        for old, new, on_edge, in_mouth in (('strategy = "chamfer"', "", "stands", True),
                                            (r"\nwidth = 1\n", "\nwidth = 1.1\n", "gouged", False),
                                            (r"tip_angle = 90", "tip_angle = 80", "gouged|stands", True)):
            parts = re.split(r"(?=\n\[\[)", job)
            wrong = "".join(re.sub(old, new, part) if new else part for part in parts if new or old not in part)
            self.assertNotEqual(job, wrong)
            (self.folder / "wrong.toml").write_text(wrong)
            self.run_cusp("plan", "wrong.toml", "-o", "wrong.ngc")
            cut = SweptHeights((self.folder / "wrong.ngc").read_text())
            self.assertRegex(str(faults_of_ground(cut, block, tools)), on_edge)
            mouths = [hole for hole in block.holes if hole.kind == "countersunk"]
            self.assertEqual(in_mouth, any(faults_of_hole(cut, hole, tools)[0] for hole in mouths))

    def test_edges_that_no_vee_of_the_call_cuts_are_named(self):
        block = FeaturedBlock(FIRST, DIAMETERS, chamfered=True)
        (self.folder / "part.step").write_text(block.step())
        c = block.chamfer
        for tools, words in ((("flat:2.5",), f" at z 12, {c:g} mm wide: stay, such as at x "),
                             (("flat:2.5",), "no vee has their 90 degrees; --tool vee:"),
                             (("flat:2.5", "vee:6:60"), "vee 6 mm of 60 degrees is not used: it fits no edge of the part"),
                             (("flat:2.5", "vee:1:90"), "the vee's flank is too narrow; --tool vee:")):
            done = self.run_cusp("plan", "part.step", "--tool", *tools, "--print-job")
            self.assertIn(words, done.stdout + done.stderr)
            self.assertNotIn('strategy = "chamfer"', done.stdout)

    def test_a_vee_that_would_gouge_a_wall_is_not_used(self):
        """A countersunk hole so near to a wall that a wide vee would be in it, and a thin one is not."""
        block = FeaturedBlock(FIRST, (3.0,))
        block.edge, block.shelf = 27.0, 7.0
        block.holes = [RoundHole(31, 14, [(3.0, 7.0), (1.5, 5.5), (1.5, 0.0)], "countersunk")]
        for vee, breaks in ((12.0, False), (4.0, True)):
            tools = Tools([2.5], [3.0], [vee])
            said, program = self.plan(block, tools)
            self.assertEqual(breaks, "1 edge at z 7, 1.5 mm wide: chamfer, vee 4 mm" in said, said)
            self.assertEqual(not breaks, "the vee would gouge the part beside them" in said, said)
            self.assertEqual([], faults_of_ground(SweptHeights(program), block, tools))

    def test_of_a_mouth_near_a_wall_the_rest_is_broken(self):
        block = FeaturedBlock(FIRST, (3.0,))
        block.edge, block.shelf = 27.0, 7.0
        block.holes = [RoundHole(31, 14, [(3.0, 7.0), (1.5, 5.5), (1.5, 0.0)], "countersunk")]
        said, program = self.plan(block, Tools([7.0], [3.0], [5.8]))
        self.assertRegex(said, r"1 edge at z 7, 1\.5 mm wide: \d\.\d+ mm of 9\.4\d* broken, vee 5.8 mm of 90 degrees; the rest "
                         "stays, such as at x ")
        cut = SweptHeights(program)
        self.assertEqual([], faults_of_ground(cut, block, Tools([7.0], [3.0])))
        self.assertLess(cut.at(31 + 2.25, 14), 6.25 + WITHIN)
        self.assertGreater(cut.at(31 - 2.9, 14), 7 - WITHIN)

    def test_a_cone_of_a_mouth_s_angle_goes_down_in_its_middle(self):
        """By a spot drill, and by a vee that has no room to go round beside a wall or in a narrow hole."""
        for sink, radius, x in (("drill:8:90", 1.5, 32.0), ("vee:8:90", 1.5, 31.5), ("vee:4:90", 0.15, 33.0)):
            with self.subTest(sink):
                block = FeaturedBlock(FIRST, (3.0,))
                block.edge, block.shelf, wide = 27.0, 7.0, radius + 1.0
                block.holes = [RoundHole(x, y, [(wide, 7.0), (radius, 6.0), (radius, 0.0)], "countersunk") for y in (8.0, 20.0)]
                (self.folder / "part.step").write_text(block.step())
                call = ("plan", "part.step", "--tool", "flat:2", f"drill:{2 * radius:g}", sink, "--post", "linuxcnc")
                said = self.run_cusp(*call, "-o", "p.ngc").stdout
                self.assertIn(f"2 edges at z 7, 1 mm wide: countersink {2 * wide:g} mm, {sink[:sink.index(':')]} ", said)
                (self.folder / "job.toml").write_text(self.run_cusp(*call, "--print-job").stdout)
                self.assertIn("all bounds hold", self.run_cusp("verify", "job.toml", "p.ngc").stdout)
                cut = SweptHeights((self.folder / "p.ngc").read_text())
                made = Tools([2.0], [2 * radius], [2 * wide + 0.4])
                self.assertEqual([], faults_of_ground(cut, block, made))
                for hole in block.holes:
                    self.assertEqual([], faults_of_hole(cut, hole, made)[0])

    def test_countersinks_that_a_tool_can_not_make_are_refused(self):
        block = FeaturedBlock(FIRST, (3.0,))
        block.holes = [RoundHole(8, 9.5, [(1.5, 12.0), (1.5, 0.0)], "plain")]
        (self.folder / "part.step").write_text(block.step())
        for shape, keys, words in (('shape = "drill"', "countersink = 7", "is 7 mm, the cone of tool 1 is 0 to 6 mm wide"),
                                   ('shape = "flat"', "countersink = 5", "needs the cone of a drill or a vee, tool 1 is flat"),
                                   ('shape = "drill"', "countersink = 3", "is 3 mm, all holes are as wide"),
                                   ('shape = "drill"', "countersink = 5\ndepth = 2", "does not go with countersink")):
            (self.folder / "job.toml").write_text(
                f'units = "mm"\n[tool]\n{shape}\ndiameter = 6\n[cutting]\nfeed = 100\n[[operation]]\nstrategy = "drill"\n'
                f'boundary = "part.step"\n{keys}\n')
            done = subprocess.run([CUSP, "plan", "job.toml", "-o", "p.ngc"], cwd=self.folder, text=True, capture_output=True)
            self.assertEqual(2, done.returncode)
            self.assertIn(words, done.stderr)

    def test_inches(self):
        block, tools = FeaturedBlock(FIRST, DIAMETERS, chamfered=True), Tools([2.5], [4.0], [6.0])
        (self.folder / "part.step").write_text(block.step())
        done = self.run_cusp("plan", "part.step", "--units", "inch", "--tool", "flat:2.5mm", "drill:4mm", "vee:6mm:90",
                             "--post", "linuxcnc", "--print-job")
        (self.folder / "job.toml").write_text(done.stdout)
        self.run_cusp("plan", "job.toml", "-o", "p.ngc")
        self.assertIn("all bounds hold", self.run_cusp("verify", "job.toml", "p.ngc").stdout)
        self.assertIn('units = "inch"', done.stdout)
        (self.folder / "mm.toml").write_text(self.run_cusp("plan", "part.step", "--tool", *tools.words(), "--post",
                                                           "linuxcnc", "--print-job").stdout)
        self.run_cusp("plan", "mm.toml", "-o", "mm.ngc")
        self.assertEqual(done.stdout.count('strategy = "chamfer"'),
                         (self.folder / "mm.toml").read_text().count('strategy = "chamfer"'))
        self.assertIn("all bounds hold", self.run_cusp("verify", "mm.toml", "p.ngc").stdout)

    def test_the_judge_finds_planted_faults(self):
        block, tools = FeaturedBlock(FIRST, DIAMETERS), Tools([2.5], [])
        _, program = self.plan(block, tools)
        cut = SweptHeights(program)
        job = (self.folder / "job.toml").read_text()
        self.assertIn('strategy = "bore"', job)
        (self.folder / "less.toml").write_text(re.sub(r'\n\[\[operation\]\]\nstrategy = "bore"[^[]*$', "", job))
        self.run_cusp("plan", "less.toml", "-o", "less.ngc")
        without = SweptHeights((self.folder / "less.ngc").read_text())
        self.assertTrue(any(faults_of_hole(without, hole, tools)[0] for hole in block.holes))
        for hole in block.holes:
            self.assertEqual([], faults_of_hole(cut, hole, tools)[0])
            whole = hole.profile
            for wider in (-0.05, 0.05):  # a diameter that is wrong by 0.1
                hole.profile = [(radius + wider, z) for radius, z in whole]
                words = str(faults_of_hole(cut, hole, tools)[0])
                self.assertIn("stands" if wider > 0 else "gouged", words)
            hole.profile = [(radius, z and z - 0.05) for radius, z in whole]
            if whole[-1][1] > 0:
                self.assertIn("floor" if whole[-1][0] > 0 else "wall", str(faults_of_hole(cut, hole, tools)[0]))

    def test_a_hole_that_nothing_makes_is_named_with_its_place(self):
        block = FeaturedBlock(FIRST, (3.0,))
        block.holes = [RoundHole(8, 9.5, [(1.5, 12.0), (1.5, 0.0)], "plain"),
                       RoundHole(20, 9.5, [(4.0, 12.0), (4.0, 9.0), (1.5, 9.0), (1.5, 2.0)], "counterbored")]
        said, program = self.plan(block, Tools([4.0], [3.5]))
        self.assertIn("2 holes of 3 mm: stay, at x 8 y 9.5, x 20 y 9.5: no drill has their diameter and no flat end is "
                      "narrower; --tool drill:3 drills them", said)
        self.assertIn("1 hole of 8 mm, none through: bore, flat 4 mm", said)
        cut = SweptHeights(program)
        self.assertEqual(math.inf, cut.at(8, 9.5))
        self.assertAlmostEqual(9.0, cut.at(20, 9.5), delta=WITHIN)

    def test_no_rapid_move_meets_stock(self):
        block = FeaturedBlock(FIRST, DIAMETERS)
        _, program = self.plan(block, Tools([5.0, 2.5], [4.0]))
        self.assertEqual("", rapid_in_stock(StockWalk((0, block.wide), (0, block.deep), block.high, 0.0), program))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
