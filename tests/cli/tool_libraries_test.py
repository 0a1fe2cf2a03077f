#!/usr/bin/env python3
"""Tools of libraries, and fixtures in the way of plans and programs.

usage: tool_libraries_test.py CUSP
"""
import pathlib
import sys
import tomllib
import unittest

from pocket_case import PocketCase

TOP = pathlib.Path(__file__).resolve().parents[2]


class Libraries(PocketCase):
    LIBRARY = 'units = "mm"\n' + "".join(
        f'[[tool]]\nname = "{name}"\nshape = "{shape}"\ndiameter = {size}\nfeed = {feed}\nspindle = 10000\n'
        for name, shape, size, feed in (("6mm flat", "flat", 6, 900), ("6mm ball", "ball", 6, 700), ("3mm ball", "ball", 3, 400)))
    JOB = """
units = "mm"
library = "tools.toml"
[stock]
top = 0
[[operation]]
strategy = "contour_pocket"
floor = "floor.json"
boundary = "boundary.json"
scallop = 0.3
tool = "6mm ball"
"""

    def refused(self, words, job=None, library=None):
        self.write("tools.toml", library or self.LIBRARY)
        self.write("job.toml", job or self.JOB)
        self.assertIn(words, self.cusp(2, "plan", "job.toml", "-o", "p.ngc"))

    def test_a_tool_by_name(self):
        self.write("tools.toml", self.LIBRARY)
        self.write("job.toml", self.JOB)
        text = self.planned()
        self.assertIn("(tool 2 ball diameter 6 mm: 6mm ball)\nT2\nM3 S10000\n", text)
        self.assertIn(" F700\n", text)
        self.assertIn(" F175\n", text)  # a quarter, into the stock
        self.cusp(0, "verify", "job.toml", "p.ngc")
        self.write("job.toml", self.JOB + "feed = 555\nspindle = 8000\n")
        text = self.planned()
        self.assertIn("M3 S8000\n", text)
        self.assertIn(" F555\n", text)
        self.assertNotIn(" F700\n", text)

    def test_inches_of_the_library_are_its_own(self):
        self.write("tools.toml", self.LIBRARY.replace('"mm"', '"inch"').replace("diameter = 6", "diameter = 0.25"))
        self.write("job.toml", self.JOB)
        text = self.planned()
        self.assertIn("(tool 2 ball diameter 6.35 mm: 6mm ball)", text)
        self.assertIn(f" F{700 * 25.4:g}\n", text)

    def test_errors(self):
        self.refused('tool: is "6mm bal", no tool has that name, in tools.toml either; the nearest are "6mm ball", ',
                     self.JOB.replace('"6mm ball"', '"6mm bal"'))
        self.refused("tools.toml:2: tool 1: name: is missing",
                     library=self.LIBRARY.replace('name = "6mm flat"\n', ""))
        self.refused("tools.toml:1: units: is missing", library=self.LIBRARY.replace('units = "mm"', ""))
        self.refused('units: is "cm", known are "mm", "inch"', library=self.LIBRARY.replace('"mm"', '"cm"'))
        self.refused("diameter: is missing", library=self.LIBRARY.replace("diameter = 6\n", ""))
        self.refused("feeed: unknown key; the nearest known one is feed", library=self.LIBRARY.replace("feed", "feeed"))
        self.refused('two tools are named "6mm ball"', library=self.LIBRARY.replace("3mm ball", "6mm ball"))
        self.refused("tool: is missing: name a tool of the library", self.JOB.replace('tool = "6mm ball"\n', ""))
        self.refused('library "metal": there is none of that name', self.JOB.replace("tools.toml", "metal"))
        self.refused("has the number 2, and so has a [[tool]] of the job",
                     self.JOB.replace("[stock]", '[[tool]]\nnumber = 2\nshape = "flat"\ndiameter = 3\nfeed = 100\n[stock]'))
        self.refused("cutting: is missing", library=self.LIBRARY.replace("feed = 400\n", ""))
        self.refused("flute_length: is 20 mm, the tool is 10 mm long",
                     library=self.LIBRARY + "flute_length = 20\nlength = 10\n")

    def test_a_tool_that_is_too_short_is_a_warning_flutes_that_are_too_short_an_error(self):
        for status, keys, words in ((2, "flute_length = 2\n", r"tool 2 \(6mm ball\) at x .*: the axial depth of cut is 4.1\d* mm"),
                                    (0, "length = 2\n", r"tool 2 \(6mm ball\) goes .*, it is 2 mm long: its holder may touch")):
            self.write("tools.toml", self.LIBRARY.replace('name = "6mm ball"\n', 'name = "6mm ball"\n' + keys))
            self.write("job.toml", self.JOB)
            self.assertRegex(self.cusp(status, "plan", "job.toml", "-o", "p.ngc"), words)

    def test_the_libraries_that_come_with_the_program(self):
        for file in sorted((TOP / "tool_libraries").glob("*.toml")):
            for tool in tomllib.loads(file.read_text())["tool"]:
                if tool["shape"] != "ball" or tool["diameter"] < 3:
                    continue
                self.write("job.toml", self.JOB.replace("tools.toml", file.stem).replace("6mm ball", tool["name"]))
                text = self.planned()
                self.assertIn(f"F{tool['feed']:g}\n", text)
                self.assertEqual("mist" == tool["coolant"], "\nM7\n" in text)


class Fixtures(PocketCase):
    def test_cuts_and_links(self):
        box = '[[fixture]]\nname = "clamp"\nx = [{}]\ny = [10, 20]\ntop = {}\n'
        self.job(more=box.format("-30, -10", 4))
        text = self.planned()
        self.assertIn("\nG0 Z5\n", text)  # over it
        self.job(more=box.format("-30, -10", 14))
        said = self.cusp(0, "plan", "job.toml", "-o", "p.ngc")
        self.assertIn("clearance: 15 mm above the stock's top in place of 5, to be over clamp", said)
        self.assertIn("\nG0 Z15\n", (self.folder / "p.ngc").read_text())
        self.cusp(0, "verify", "job.toml", "p.ngc")
        self.job(more=box.format("-30, 1", 2))
        self.assertRegex(self.cusp(2, "plan", "job.toml", "-o", "p.ngc"),
                         r"operation 1, contour_pocket: .* at x \S+ y \S+ z \S+ mm would touch clamp")

    def test_verify_finds_them(self):
        self.job()
        self.planned()
        self.job(more='[[fixture]]\nname = "vice"\ncentre = [20, 33]\ndiameter = 4\ntop = 3\nmargin = 2\n')
        said = self.cusp(1, "verify", "job.toml", "p.ngc")
        self.assertIn("broken: fixture_hit_max_mm", said)
        self.assertIn("vice at x ", said)

    def test_errors(self):
        for table, words in (("x = [0, 1]\ntop = 1\n", "fixture 1: x: needs y"),
                             ("x = [1, 0]\ny = [0, 1]\ntop = 1\n", "fixture 1: x: two numbers [min, max]"),
                             ("x = [0, 1]\ny = [0, 1]\n", "fixture 1: top: is missing"),
                             ("centre = [0, 1]\ntop = 1\n", "fixture 1: centre: needs diameter"),
                             ("centre = [0, 1]\ndiameter = 2\nx = [0, 1]\ntop = 1\n", "x: is given beside centre: one of them"),
                             ("center = [0, 1]\n", "center: unknown key; the nearest known one is centre")):
            self.job(more="[[fixture]]\n" + table)
            self.assertIn(words, self.cusp(2, "plan", "job.toml", "-o", "p.ngc"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
