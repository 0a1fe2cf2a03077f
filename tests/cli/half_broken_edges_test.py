#!/usr/bin/env python3
"""Edges of solids that are broken along parts of loops, in jobs of one line: the vee breaks all that it can without a gouge.

usage: half_broken_edges_test.py CUSP; CUSP_PROPERTY_CASES and CUSP_PROPERTY_FIRST set the random blocks

The judge is swept_heights.py, and for what the vee can do the block's own heights: at each place of an edge the tool is
stood beside it, and either it would be in the part, or the edge has to be broken there.
"""
import math
import pathlib
import sys
import unittest

for folder in ("judges", "support", "generators"):
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / folder))
from cusp_case import CuspCase  # noqa: E402
from half_broken_block import HalfBrokenBlock  # noqa: E402
from property_cases import property_cases, property_seed  # noqa: E402
from swept_heights import SweptHeights  # noqa: E402

CASES = property_cases(6)
FIRST = property_seed(1)
WITHIN = 0.02  # mm
BESIDE = 0.2  # mm from the edge to the tip


def gouges(block, x, y, z, radius):
    """True if a vee of 90 degrees with its tip there is in the part."""
    steps = [radius * k / 12 for k in range(13)]
    around = [2 * math.pi * k / 48 for k in range(48)]
    return any(block.height(x + away * math.cos(a), y + away * math.sin(a)) > z + away + 0.005
               for away in steps for a in around)


def places(block, radius):
    """Along each broken edge: a place, the way to the material, z of its upper side, and what the vee can do there:
    True, False, or None for within 0.1 mm of a place where it changes."""
    found = []
    for (x0, y0), (x1, y1), (u, v), top in block.sides():
        z = top - block.width - BESIDE
        count = 2 * int(math.hypot(x1 - x0, y1 - y0))

        def can(t):
            x, y = x0 + t * (x1 - x0) / count, y0 + t * (y1 - y0) / count
            return not gouges(block, x - BESIDE * u, y - BESIDE * v, z, radius)
        for k in range(count):
            near = {can(t) for t in (k + 0.3, k + 0.5, k + 0.7)}
            at = (k + 0.5) / count
            found.append((x0 + at * (x1 - x0), y0 + at * (y1 - y0), u, v, top, near.pop() if len(near) == 1 else None))
    return found


def faults(block, cut, radius):
    """Broken edges that stand where the vee can break them, and gouges; and how many places were to be broken."""
    found, broken = [], 0
    for x, y, u, v, top, can in places(block, radius):
        for share in (0.15, 0.5, 0.85):
            at = (x + share * block.width * u, y + share * block.width * v)
            wanted = block.height(*at)
            if can and cut.at(*at) > wanted + WITHIN:
                found.append(f"stands to {cut.at(*at):.3f} at {at[0]:.2f} {at[1]:.2f}, not {wanted:.3f}")
        broken += 1 if can else 0
    for i in range(80):
        for j in range(56):
            x, y = 0.25 + 0.5 * i, 0.25 + 0.5 * j
            lowest = min(block.height(x + a, y + b) for a in (-0.03, 0, 0.03) for b in (-0.03, 0, 0.03))
            if cut.at(x, y) < lowest - WITHIN:
                found.append(f"gouged to {cut.at(x, y):.3f} at {x:.2f} {y:.2f}, not {lowest:.3f}")
    return found, broken


class HalfBrokenEdges(CuspCase):
    def plan(self, block, tools=("flat:6", "vee:5:90")):
        self.write("part.step", block.step())
        call = ("plan", "part.step", "--tool", *tools, "--post", "linuxcnc")
        said = self.cusp(0, *call, "-o", "p.ngc")
        self.write_job(self.cusp(0, *call, "--print-job"))
        self.assertIn("all bounds hold", self.cusp(0, "verify", "job.toml", "p.ngc"))
        return said, (self.folder / "p.ngc").read_text()

    def test_parts_of_edges_are_broken_wherever_the_vee_can(self):
        broken, left = 0, 0
        for seed in range(FIRST, FIRST + CASES):
            with self.subTest(seed=seed):
                block = HalfBrokenBlock(seed)
                said, program = self.plan(block)
                found, count = faults(block, SweptHeights(program), 2.5)
                self.assertEqual([], found, said)
                broken += count
                cannot = [place for place in places(block, 2.5) if place[-1] is False]
                left += len(cannot)
                self.assertEqual(len(cannot) > 1, "; the rest stays, such as at" in said, said)
        self.assertGreater(broken, 40 * CASES)
        self.assertGreater(left, CASES)

    def test_the_judge_finds_edges_that_are_not_broken_and_gouges(self):
        block = HalfBrokenBlock(FIRST)
        self.plan(block)
        job = (self.folder / "job.toml").read_text()
        program = (self.folder / "p.ngc").read_text()
        first = job.index('\n[[operation]]\nstrategy = "engrave"')
        self.write("less.toml", job[:first])
        self.cusp(0, "plan", "less.toml", "-o", "less.ngc")
        less = (self.folder / "less.ngc").read_text()
        self.assertRegex(str(faults(block, SweptHeights(less), 2.5)[0]), "stands")
        block.upper, block.lower = set(), set()  # none of its edges is to be broken
        self.assertRegex(str(faults(block, SweptHeights(program), 2.5)[0]), "gouged")

    def test_a_vee_that_is_wider_than_the_flat_end_breaks_edges_too(self):
        for seed in range(FIRST, FIRST + CASES):
            with self.subTest(seed=seed):
                block = HalfBrokenBlock(seed)
                said, program = self.plan(block, ("flat:4", "vee:6:90"))
                self.assertEqual([], faults(block, SweptHeights(program), 3)[0], said)

    def test_engravings_that_do_not_break_the_edges_are_refused(self):
        block = HalfBrokenBlock(FIRST)
        self.plan(block)
        job = (self.folder / "job.toml").read_text()
        c, depth = block.width, block.width + BESIDE
        self.assertIn(f"depth = {depth:g}\n", job)
        for old, new, words in ((f"depth = {depth:g}\n", "depth = 0.9\n", "the tip of tool 2 breaks these edges at z "),
                                ("tip_angle = 90", "tip_angle = 60", "tool 2 is no vee of 90 degrees, as these edges need"),
                                (f":{c:g}\"\n", f":{c / 2:g}\"\n", "as these edges need")):
            self.assertIn(old, job)
            self.write("wrong.toml", job.replace(old, new))
            self.assertIn(words, self.cusp(2, "plan", "wrong.toml", "-o", "wrong.ngc"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
