#!/usr/bin/env python3
"""Shanks and holders in deep pockets: refused with a length that does; found by `cusp verify` in programs of others.

usage: whole_tool_test.py CUSP
"""
import json
import math
import re
import sys
import unittest

from cusp_case import CuspCase

JOB = """
[tool]
shape = "flat"
diameter = 6
{tool}
[cutting]
feed = 1000
[stock]
top = 0
x = [-20, 80]
y = [-20, 60]
[[operation]]
strategy = "pocket"
boundary = "plate.dxf#pocket"
depth = {depth}
max_depth = {layer}
"""
LENGTH = re.compile(r"\((?:length|flute_length)\) of ([0-9.]+) mm")


def rectangle(low, high):
    corners = [low, (high[0], low[1]), high, (low[0], high[1])]
    for (a, b), (c, d) in zip(corners, corners[1:] + corners[:1]):
        yield f"0\nLINE\n8\npocket\n10\n{a}\n20\n{b}\n30\n0\n11\n{c}\n21\n{d}\n31\n0\n"


class WholeTool(CuspCase):
    def setUp(self):
        super().setUp()
        self.write("plate.dxf", "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n"
                   + "".join(rectangle((0, 0), (60, 40))) + "0\nENDSEC\n0\nEOF\n")

    def job(self, tool, depth=30, layer=5):
        self.write("job.toml", JOB.format(tool=tool, depth=depth, layer=layer))

    def planned(self, tool, **about):
        self.job(tool, **about)
        return self.cusp(0, "plan", "job.toml", "-o", "p.ngc")

    def refused(self, tool, **about):
        self.job(tool, **about)
        return self.cusp(2, "plan", "job.toml", "-o", "p.ngc")

    def stats(self, status):
        said = self.cusp(status, "verify", "job.toml", "p.ngc", "--stats", "s.json")
        return json.loads((self.folder / "s.json").read_text()), said

    def length_that_does(self, key, tool, depth):
        """The length of the refusal; the plan with it and a little more passes, as does its program; with less it does not."""
        said = self.refused(tool.format(15), depth=depth)
        self.assertRegex(said, r"job.toml: operation 1, pocket: .* of tool 1 at x [-0-9.]+ y [-0-9.]+ z [-0-9.]+ mm: ")
        length = float(LENGTH.search(said)[1])
        self.planned(tool.format(length + 0.1), depth=depth)
        stats, _ = self.stats(0)
        self.assertEqual(0, stats[f"{key}_contact_max_mm"])
        self.assertIn(f"of {length:.2f} mm in place of {length - 0.5:g}",
                      self.refused(tool.format(f"{length - 0.5:g}"), depth=depth))
        return length

    def test_a_holder_keeps_off_the_stock(self):
        for more, clearance, depth in (("", 0.5, 22), ("holder_clearance = 2\n", 2, 30)):
            length = self.length_that_does("holder", "length = {}\nholder = [[20, 25], [40, 30]]\n" + more, depth)
            self.assertAlmostEqual(depth + clearance, length, delta=0.03)

    def test_a_second_cylinder_of_the_holder_meets_stock_that_the_first_does_not(self):
        # the first is no wider than the pocket's passes leave room for
        length = self.length_that_does("holder", "length = {}\nholder = [[6, 4], [40, 30]]\nholder_clearance = 0\n", 30)
        self.assertAlmostEqual(26, length, delta=0.03)

    def test_a_wide_shank_keeps_off_the_stock(self):
        length = self.length_that_does("shank", "shank_diameter = 10\nlength = 60\nflute_length = {}\n", 30)
        self.assertAlmostEqual(30.5, length, delta=0.03)

    def test_flutes_are_as_long_as_the_depth_of_cut(self):
        said = self.refused("flute_length = 8", depth=30, layer=10)
        self.assertIn("the axial depth of cut is 10 mm, the flutes (flute_length) are 8 mm long", said)
        self.assertRegex(said, r"operation 1, pocket: .* at x [-0-9.]+ y [-0-9.]+ z -[0-9.]+ mm")
        said = self.planned("flute_length = 10", depth=30, layer=10)
        self.assertIn("its flutes are 10 mm long: its shank may rub", said)
        self.stats(0)

    def test_a_length_without_a_holder_is_a_warning(self):
        self.assertIn("it is 20 mm long: its holder may touch", self.planned("length = 20"))
        self.assertNotIn("holder_contact", "".join(self.stats(0)[0]))

    def test_verify_names_the_line(self):
        self.job("flute_length = 12\nshank_diameter = 8\nlength = 20\nholder = [[25, 30]]\n")
        # a slot from outside, in layers of 4 mm, and then 3 mm too deep for the holder beside the slot
        lines = ["G21 G90 F1000", "G0 Z5"]
        for z in (-4, -8):
            lines += ["G0 X-30 Y20", f"G1 Z{z}", "G1 X20", "G1 X-30"]
        self.write("p.ngc", "\n".join(lines + ["G0 Z5", "M30"]) + "\n")
        stats, _ = self.stats(1)  # it is no pocket
        self.assertEqual([0, 0, 0], [stats[key] for key in ("beyond_flutes_max_mm", "shank_contact_max_mm",
                                                            "holder_contact_max_mm")])
        lines += ["G1 Z-12.5", "G1 X10", "G1 X-30", "G0 X-40", "G1 Z-22.5", "G1 X5", "G0 Z5"]
        self.write("p.ngc", "\n".join(lines + ["M30"]) + "\n")
        stats, said = self.stats(1)
        self.assertAlmostEqual(22.5 - 12 + 0.5, stats["shank_contact_max_mm"], delta=0.001)
        self.assertAlmostEqual(22.5 - 20 + 0.5, stats["holder_contact_max_mm"], delta=0.001)
        self.assertEqual(0, stats["beyond_flutes_max_mm"])  # the slot is there down to z = -12.5
        line = lines.index("G1 X5") + 1
        self.assertEqual([line, line], [stats["shank_contact_max_line"], stats["holder_contact_max_line"]])
        self.assertEqual(1, stats["holder_contact_max_tool"])
        x, y, z = stats["holder_contact_max_at_mm"]
        self.assertEqual([20, -22.5], [y, z])
        # where the holder comes over the stock beside the slot, 6 mm wide
        self.assertAlmostEqual(-20 - math.sqrt(13 ** 2 - 3 ** 2), x, delta=0.3)
        self.assertRegex(said, rf"broken: holder_contact_max_mm 3 by tool 1 at x -3.* line {line}: a length of 23.0. mm")

    def test_verify_finds_cuts_beyond_the_flutes(self):
        self.job("flute_length = 6\n")
        self.write("p.ngc", "G21 G90 F1000\nG0 Z5\nG0 X-30 Y20\nG1 Z-7.5\nG1 X5\nG0 Z5\nM30\n")
        stats, said = self.stats(1)
        self.assertAlmostEqual(1.5, stats["beyond_flutes_max_mm"], delta=0.001)
        self.assertEqual(5, stats["beyond_flutes_max_line"])
        self.assertIn("line 5: flutes of 7.50 mm would do", said)

    def test_bad_keys_are_refused_with_their_line(self):
        for tool, words in (
                ("flute_length = 5\nshank_diameter = 0", "job.toml:6: tool 1: shank_diameter: is 0, it must be above 0"),
                ("flute_length = 5\nshank_diameter = -2", "job.toml:6: tool 1: shank_diameter: is -2, it must be above 0"),
                ("shank_diameter = 6", "job.toml:5: tool 1: shank_diameter: needs flute_length"),
                ("length = 20\nholder = []", "job.toml:6: tool 1: holder: is empty"),
                ("length = 20\nholder = 20", "job.toml:6: tool 1: holder: a list of pairs is needed: [[diameter, length]"),
                ("length = 20\nholder = [20, 30]", "holder: a list of pairs is needed"),
                ("length = 20\nholder = [[20, 30, 1]]", "holder: a list of pairs is needed"),
                ("length = 20\nholder = [[20, 0]]", "holder: is 0, it must be above 0"),
                ("length = 20\nholder = [[nan, 5]]", "holder: is nan, it must be above 0"),
                ("length = 20\nholder = [[20, \"a\"]]", "holder: a number is needed"),
                ("holder = [[20, 30]]", "job.toml:5: tool 1: holder: needs length"),
                ("length = 4\nflute_length = 5", "job.toml:6: tool 1: flute_length: is 5 mm, the tool is 4 mm long"),
                ("holder_clearance = 1", "holder_clearance: needs shank_diameter or holder"),
                ("length = 20\nholder = [[20, 30]]\nholder_clearance = -1", "holder_clearance: is -1, it must be at least 0")):
            self.assertIn(words, self.refused(tool))

    def test_lengths_are_in_the_units_of_the_file(self):
        self.write("job.toml", 'units = "inch"\n' + JOB.format(
            tool="length = 0.8\nholder = [[0.8, 1.2]]\nholder_clearance = 0.02", depth=1.2, layer=0.2)
            .replace("diameter = 6", "diameter = 0.25").replace("[-20, 80]", "[-1, 4]").replace("[-20, 60]", "[-1, 3]"))
        said = self.cusp(2, "plan", "job.toml", "-o", "p.ngc")
        self.assertAlmostEqual(1.22 * 25.4, float(LENGTH.search(said)[1]), delta=0.03)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
