#!/usr/bin/env python3
"""Feeds and speeds by material: the makers' tables, limits of the machine, what is given stays; warnings of slender tools and deep slots.

usage: material_test.py CUSP
"""
import math
import pathlib
import random
import re
import sys
import tomllib
import unittest

from cusp_case import CuspCase

TOP = pathlib.Path(__file__).resolve().parents[2]
MATERIALS = {file.stem: tomllib.loads(file.read_text()) for file in sorted((TOP / "materials").glob("*.toml"))}
DEFAULT = {"spindle": 24000, "xy": 6000, "z": 3000}  # cusp settings
DRAWING = "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n8\nholes\n10\n50\n20\n50\n40\n{radius}\n0\nENDSEC\n0\nEOF\n"
JOB = """units = "{units}"
material = "{material}"
{top}
[[tool]]
shape = "{shape}"
diameter = {diameter}
{tool}
{cutting}
[stock]
top = 0
bottom = {bottom}
x = [0, {size}]
y = [0, {size}]
[[operation]]
strategy = "{strategy}"
boundary = "part.dxf#holes"
depth = {depth}
{operation}
"""


def at(table, diameter):
    """Of the table, in proportion between its entries."""
    table = [[0, 0]] + table
    for (below, least), (above, most) in zip(table, table[1:]):
        if diameter <= above:
            return least + (most - least) * (diameter - below) / (above - below)
    return table[-1][1]


class Materials(CuspCase):
    def job(self, material="aluminium", shape="flat", diameter=6.0, tool="", cutting="", operation="", top="", units="mm", strategy=None,
            depth=3):
        scale = 25.4 if units == "inch" else 1
        strategy = strategy or ("drill" if shape == "drill" else "profile")
        self.write("part.dxf", DRAWING.format(radius=(diameter / 2 if strategy == "drill" else 30) * scale))
        self.write("job.toml", JOB.format(units=units, material=material, top=top, shape=shape, diameter=diameter, tool=tool,
                                          cutting=cutting, bottom=-20 / scale, size=100 / scale, strategy=strategy,
                                          operation=operation, depth=depth / scale))

    def rates(self, status=0):
        """rpm, feed and plunge feed of the program, and what was said."""
        said = self.cusp(status, "plan", "job.toml", "-o", "p.ngc")
        text = (self.folder / "p.ngc").read_text()
        feeds = sorted({float(f) for f in re.findall(r"F([0-9.]+)", text)})
        return float(re.search(r"M3 S([0-9.]+)", text)[1]), feeds[-1], feeds[0], said

    def expected(self, material, diameter, flutes=2, drill=False, spindle=None, most=None):
        """As the tables say, without the roundings."""
        most, data = {**DEFAULT, **(most or {})}, MATERIALS[material]
        of_turn = at(data["drill_feed"], diameter) if drill else at(data["chip"], diameter) * flutes
        share = 1 if drill else 0.25
        rpm = spindle or min(1000 * data["drill_speed" if drill else "surface_speed"] / (math.pi * diameter), most["spindle"],
                             most["xy"] / of_turn, most["z"] / (share * of_turn))
        return rpm, rpm * of_turn, rpm * of_turn * share

    def assert_rates(self, found, expected):
        for value, wanted in zip(found, expected):
            self.assertLessEqual(value, wanted * (1 + 1e-6))
            self.assertGreaterEqual(value, wanted * (1 - 0.02))  # three digits each of rpm and feed

    def test_mills_and_drills_by_the_tables_over_random_tools(self):
        draw = random.Random(54)
        for case in range(40):
            material = draw.choice(sorted(MATERIALS))
            drill = draw.random() < 0.3
            diameter = round(draw.uniform(1, 16), 2)
            flutes = draw.randint(1, 4)
            most = {"spindle": draw.choice((8000, 24000, 60000)), "xy": draw.choice((800, 6000)), "z": draw.choice((200, 3000))}
            machine = f"max_rate = [{most['xy']}, {most['xy'] + 100}, {most['z']}]\nspindle = [0, {most['spindle']}]\n"
            self.write("mill.toml", machine)
            self.job(material, "drill" if drill else "flat", diameter, f"flutes = {flutes}", top='machine = "mill.toml"')
            with self.subTest(seed=54, case=case, material=material, drill=drill, diameter=diameter, flutes=flutes, most=most):
                rpm, feed, plunge, _ = self.rates()
                wanted = self.expected(material, diameter, flutes, drill, None, most)
                self.assert_rates((rpm,) if drill else (rpm, feed, plunge), wanted)
                if drill:
                    self.assert_rates((plunge,), wanted[2:])
                    self.assertLessEqual(plunge, most["z"])
                self.assertLessEqual(feed, most["xy"])

    def test_it_says_whence_and_what_holds_it_back(self):
        self.job()
        said = self.rates()[3]
        self.assertRegex(said, r"tool 1: 1\d+ rpm, \d+ mm/min: 24\d m/min and 0.048 mm a tooth of 2 in aluminium \(Harvey Tool")
        self.write("mill.toml", "spindle = [2000, 9000]\n")
        self.job(top='machine = "mill.toml"')
        self.assertIn("; held back by mill.toml:1: spindle", self.rates()[3])

    def test_what_is_given_stays(self):
        rpm = self.expected("aluminium", 6)[0]
        for keys, wanted in ((dict(cutting="[cutting]\nspindle = 5000"), self.expected("aluminium", 6, spindle=5000)),
                             (dict(tool="spindle = 5000"), self.expected("aluminium", 6, spindle=5000)),
                             (dict(operation="spindle = 5000"), self.expected("aluminium", 6, spindle=5000)),
                             (dict(cutting="[cutting]\nfeed = 333"), (rpm, 333, 333 / 4)),
                             (dict(tool="feed = 333\nplunge_feed = 99"), (rpm, 333, 99)),
                             (dict(operation="feed = 333"), (rpm, 333, 333 / 4)),
                             (dict(cutting="[cutting]\nspindle = 0\nfeed = 50"), None)):
            with self.subTest(keys=keys):
                self.job(**keys)
                if wanted:
                    self.assert_rates(self.rates()[:3], wanted)
                else:
                    self.cusp(0, "plan", "job.toml", "-o", "p.ngc")
                    self.assertNotIn("tool 1:", self.cusp(0, "plan", "job.toml", "-o", "p.ngc"))

    def test_inches_are_converted(self):
        self.job(diameter=0.25, units="inch")
        rpm, feed, plunge, _ = self.rates()
        self.assert_rates((rpm, feed * 25.4, plunge * 25.4), self.expected("aluminium", 6.35))

    def test_the_least_spindle_is_kept_and_the_feed_lowered(self):
        self.write("mill.toml", "spindle = [20000, 24000]\nmax_rate = [1000, 1000, 1000]\n")
        self.job(material="steel", top='machine = "mill.toml"')
        rpm, feed, _, _ = self.rates()
        self.assertEqual(20000, rpm)
        self.assertLessEqual(feed, 1000)

    def test_one_line_calls(self):
        self.job()
        call = ("plan", "part.dxf", "--depth", "3", "--material", "plywood", "--print-job", "--tool")
        job = tomllib.loads(self.printed(*call, "flat:6"))
        self.assert_rates([job["cutting"][key] for key in ("spindle", "feed", "plunge_feed")], self.expected("plywood", 6))
        job = tomllib.loads(self.printed(*call, "flat:6", "--feed", "700"))
        self.assertEqual(700, job["cutting"]["feed"])
        said = self.cusp(0, "plan", "part.dxf", "--depth", "3", "--material", "plywood", "--tool", "flat:6", "-o", "p.ngc")
        self.assertRegex(said, r"flat 6 mm: \d+ rpm, \d+ mm/min: .*plywood \(AST Tooling")
        self.assertIn('material "plywod": there is none of that name, the nearest is "plywood"',
                      self.cusp(2, "plan", "part.dxf", "--depth", "3", "--material", "plywod", "--tool", "flat:6", "--print-job"))

    def printed(self, *call):
        text = self.cusp(0, *call)
        return text[text.index("# The job"):]

    def test_a_finishing_tool_never_changes_the_rates_of_the_rougher(self):
        self.job()
        part = str(TOP / "examples/parts/sine-hills.json")
        call = ("plan", part, "--scallop", "0.1", "--print-job", "--tool", "flat:6")
        for more in ((), ("--material", "aluminium"), ("--material", "hardwood")):
            found = set()
            for finisher in ("ball:1", "ball:3", "ball:6"):
                job = tomllib.loads(self.printed(*call, finisher, *more))
                rougher = {**job["cutting"], **job["tool"][0]}
                found.add((rougher["feed"], rougher["plunge_feed"], rougher["spindle"]))
            self.assertEqual(1, len(found), found)

    def test_a_slender_tool_is_a_warning(self):
        for keys, warned in (("length = 48", False), ("length = 49", True), ("length = 60\nflute_length = 12\nshank_diameter = 10", False),
                             ("length = 60\nflute_length = 58\nshank_diameter = 10", True)):
            self.job(tool=keys)
            self.assertEqual(warned, "out of its holder" in self.rates()[3], keys)

    def test_a_full_slot_deeper_than_the_tool_is_wide_is_a_warning(self):
        for keys, warned in (("max_depth = 6", False), ("max_depth = 6.5", True), ("", True)):
            self.job(operation=keys, depth=13)
            self.assertEqual(warned, "times its diameter" in self.rates()[3], keys)

    def test_faults(self):
        self.job(material="aluminum")
        self.assertIn('job.toml:2: material: material "aluminum": there is none of that name, the nearest is "aluminium"',
                      self.cusp(2, "plan", "job.toml", "-o", "p.ngc"))
        good = (TOP / "materials/brass.toml").read_text()
        for text, words in ((good.replace("source", "sauce"), "sauce: unknown key"), (good.replace("surface_speed = 244", ""), "surface_speed: is missing"),
                            (re.sub("chip = .*", "chip = [[3, 0.1], [3, 0.2]]", good), "chip: the diameter 3 does not grow from 3"),
                            (re.sub("chip = .*", "", good), "chip: is missing")):
            self.write("own.toml", text)
            self.job(material="own.toml")
            self.assertIn(words, self.cusp(2, "plan", "job.toml", "-o", "p.ngc"))

    def test_every_material_names_its_source(self):
        self.assertGreater(len(MATERIALS), 5)
        for name, data in MATERIALS.items():
            with self.subTest(name=name):
                self.assertGreater(len(data["source"]), 10)
                chips = [chip / diameter for diameter, chip in data["chip"]]
                self.assertTrue(all(0.002 < share < 0.06 for share in chips), chips)
                self.assertIn(name, (TOP / "docs/job_file.md").read_text())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
