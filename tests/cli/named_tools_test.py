#!/usr/bin/env python3
"""cusp verify and the tools that a program names: another cutter than the job's is no sound program, nor is an unnamed one.

usage: named_tools_test.py CUSP
"""
import re
import sys
import unittest

from cusp_case import CuspCase

JOB = """units = "{units}"
[[tool]]
shape = "flat"
diameter = {wide}
[[tool]]
shape = "bull"
diameter = {round}
corner_radius = {corner}
[cutting]
feed = {feed}
[stock]
top = 0
bottom = {bottom}
x = [0, {long}]
y = [0, {long}]
[[operation]]
strategy = "pocket"
boundary = "square.dxf#o"
depth = {depth}
[[operation]]
strategy = "profile"
boundary = "square.dxf#o"
side = "inside"
depth = {depth}
tool = 2
"""
SIZES = {"wide": 6, "round": 4, "corner": 1, "feed": 800, "bottom": -9, "long": 40, "depth": 3}


class NamedTools(CuspCase):
    def planned(self, inch, post):
        unit = 25.4 if inch else 1
        corners = ((8, 8), (32, 8), (32, 32), (8, 32))
        self.write("square.dxf", "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n"
                   "0\nLWPOLYLINE\n8\no\n90\n4\n70\n1\n" + "".join(f"10\n{x}\n20\n{y}\n" for x, y in corners) +
                   "0\nENDSEC\n0\nEOF\n")
        self.write("job.toml", JOB.format(units="inch" if inch else "mm", **{k: v / unit for k, v in SIZES.items()}))
        self.cusp(0, "plan", "job.toml", "-o", "p.ngc", "--post", post)
        self.cusp(0, "verify", "job.toml", "p.ngc")
        return (self.folder / "p.ngc").read_text()

    def test_another_cutter_than_the_jobs_breaks_the_program(self):
        for inch, post in ((False, "linuxcnc"), (True, "fanuc"), (False, "smoothieware"), (True, "grbl")):
            program = self.planned(inch, post)
            unit = 25.4 if inch else 1
            for tool, word, by in (("1 flat", "diameter", 2), ("2 bull", "diameter", -0.05), ("2 bull", "corner radius", 0.3)):
                pattern = rf"([(;] ?tool {tool} [^:)\n]*?{word} )([\d.]+)"
                other, count = re.subn(pattern, lambda m: m.group(1) + f"{float(m.group(2)) + by / unit:.6f}", program)
                self.assertGreater(count, 0, program)
                self.write("q.ngc", other)
                with self.subTest(inch=inch, post=post, tool=tool, word=word):
                    said = self.cusp(1, "verify", "job.toml", "q.ngc")
                    line = next(k for k, text in enumerate(other.splitlines(), 1) if re.search(pattern, text))
                    self.assertRegex(said, rf"broken: tool {tool} .* by its comment in line {line}, tool {tool} .*job.toml: "
                                     rf"first cut by tool {tool[0]} at x [-\d.]+ y [-\d.]+ z [-\d.]+, line \d+")

    def test_a_program_without_a_tool_fits_no_job_of_several(self):
        program = self.planned(False, "grbl")
        bare = re.sub(r"\(.*?\)", "", re.sub(r"\bT\d+", "", program))
        self.write("q.ngc", bare)
        self.assertIn("q.ngc: its tool is not known", self.cusp(2, "verify", "job.toml", "q.ngc"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
