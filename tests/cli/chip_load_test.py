#!/usr/bin/env python3
"""Feeds by load: straight cuts of known width have the F of the formula, limits hold, other commands read the result.

usage: chip_load_test.py CUSP
"""
import collections
import json
import math
import re
import sys
import unittest

from cusp_case import CuspCase

DIAMETER = 10.0
FEED = 800.0
PLUNGE = 200.0
JOB = """
[tool]
shape = "{shape}"
diameter = {diameter}
[cutting]
feed = {feed}
plunge_feed = {plunge}
[stock]
top = 0
x = [0, 80]
y = [0, 60]
[[operation]]
strategy = "{strategy}"
boundary = "plate.dxf#outline"
depth = 2
{keys}
"""
WORDS = re.compile(r"([GXYF])(-?[0-9.]+)")


class ChipLoad(CuspCase):
    def setUp(self):
        super().setUp()
        corners = [(0, 0), (80, 0), (80, 60), (0, 60)]
        lines = "".join(f"0\nLINE\n8\noutline\n10\n{a}\n20\n{b}\n30\n0\n11\n{c}\n21\n{d}\n31\n0\n"
                        for (a, b), (c, d) in zip(corners, corners[1:] + corners[:1]))
        (self.folder / "plate.dxf").write_text(
            f"0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n{lines}0\nENDSEC\n0\nEOF\n")

    def plan(self, keys, strategy="face", shape="flat", status=0):
        (self.folder / "job.toml").write_text(JOB.format(keys=keys, strategy=strategy, shape=shape, diameter=DIAMETER,
                                                         feed=FEED, plunge=PLUNGE))
        said = self.cusp(status, "plan", "job.toml", "-o", "p.ngc", "--stats", "p.json")
        if status:
            return said
        return json.loads((self.folder / "p.json").read_text())["operations"][0]

    def feeds(self):
        """mm of plane way by the F at which it is cut."""
        way = collections.Counter()
        at = {"X": 0.0, "Y": 0.0}
        motion, feed = 0, 0.0
        for line in (self.folder / "p.ngc").read_text().splitlines():
            line = re.sub(r"\(.*?\)", "", line)
            words = dict(WORDS.findall(line))
            motion = int(float(words["G"])) if "G" in words and words["G"] in "0123" else motion
            feed = float(words.get("F", feed))
            to = {axis: float(words.get(axis, at[axis])) for axis in "XY"}
            if motion > 0:
                way[feed] += math.dist(at.values(), to.values())
            at = to
        return way

    def test_straight_cuts_have_the_feed_of_the_formula(self):
        for width in (1.0, 2.0, 3.5):
            with self.subTest(width=width):
                self.plan(f"chip_load = true\nfeed_max = 4000\nstep_over = {width}")
                way = self.feeds()
                wanted = FEED / math.sqrt(1 - (1 - 2 * width / DIAMETER) ** 2)
                near = sum(way[f] for f in way if abs(f - wanted) < 0.05 * wanted)
                # The rest is the first pass, and the steps from one to the next.
                self.assertGreater(near, 0.85 * sum(way.values()), way)

    def test_limits_hold_and_others_read_the_program(self):
        stats = self.plan("chip_load = true\nfeed_min = 500\nfeed_max = 1100\nmax_depth = 1", "pocket")
        low, high = (stats[f"chip_load_feed_{k}"] for k in ("least", "most"))
        self.assertGreaterEqual(low, 500)
        self.assertLess(low, FEED)  # the slot of the first pass
        self.assertLessEqual(high, 1100)
        for feed in self.feeds():
            self.assertTrue(feed == PLUNGE or 499.9 <= feed <= 1100.1, feed)
        self.cusp(0, "verify", "job.toml", "p.ngc", "--stats", "v.json")
        self.cusp(0, "sim", "p.ngc", "--stats", "s.json")

    def test_the_gain_is_that_of_the_simulated_programs(self):
        plain = self.plan("step_over = 2")
        self.assertEqual({FEED, PLUNGE}, set(self.feeds()) | {PLUNGE})
        self.assertNotIn("chip_load_before_s", plain)
        scaled = self.plan("step_over = 2\nchip_load = true")
        self.assertAlmostEqual(plain["estimated_s"], scaled["chip_load_before_s"], delta=0.01)
        self.assertEqual(scaled["estimated_s"], scaled["chip_load_after_s"])
        self.assertLess(scaled["chip_load_after_s"], 0.95 * scaled["chip_load_before_s"])

    def test_a_change_is_over_five_percent(self):
        self.plan("chip_load = true\nfeed_min = 400\nmax_depth = 1", "pocket")
        last = 0.0
        for feed in re.findall(r"F([0-9.]+)", (self.folder / "p.ngc").read_text()):
            feed = float(feed)
            if PLUNGE not in (feed, last) and last:
                self.assertFalse(last / 1.049 < feed < 1.049 * last, (last, feed))
            last = feed

    def test_what_has_no_meaning_is_refused(self):
        self.assertIn("feed_max: needs chip_load = true", self.plan("feed_max = 900", status=2))
        self.assertIn("feed_min: is 900 mm/min, above feed_max, 800 mm/min",
                      self.plan("chip_load = true\nfeed_min = 900\nfeed_max = 800", status=2))
        self.assertIn("chip_load: needs a flat end",
                      self.plan("chip_load = true\nscallop = 0.1\nstep_over = 1", "pocket", "ball", status=2))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
