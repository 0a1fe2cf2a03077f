"""Rest machining after earlier programs, judged by a raster cutter of its own.

usage: rest_machining_test.py CUSP [--count POCKETS] [--first SEED]

Each random pocket is cut by a 10 mm tool, then by a 3 mm tool that knows what the first left. The raster finds what is
left with the second in full and with the second as planned for the rest, rapids in stock, and the cut in air.
"""
import argparse
import json
import math
import random
import re
import sys
import unittest

import numpy

from cusp_case import CuspCase

ARGUMENTS = argparse.ArgumentParser()
ARGUMENTS.add_argument("cusp")
ARGUMENTS.add_argument("--count", type=int, default=4)
ARGUMENTS.add_argument("--first", type=int, default=1)
ARGUMENTS = ARGUMENTS.parse_args()
PITCH = 0.2    # mm, of the raster
STEP = 0.1     # mm, between places of a tool
WALL = 0.03    # mm: plan_tolerance, and what rounding and places leave
FLOOR = 0.004  # mm
AIR = 0.2      # of the cut in air of the whole operation
WORD = re.compile(r"([A-Z])([-+.\d]+)")

JOB = """
[[tool]]
number = 1
shape = "flat"
diameter = 10
[[tool]]
number = 2
shape = "flat"
diameter = 3
[cutting]
feed = 1000
plunge_feed = 300
[stock]
top = 0
{stock}
[[operation]]
strategy = "pocket"
boundary = "part.dxf#pocket"
tool = {tool}
depth = 5
max_depth = 2.5
output = "{output}"
{more}
"""


class Raster:
    """Heights of the stock; cuts with flat tools."""

    def __init__(self, width, height):
        self.x = numpy.arange(-8, width + 8, PITCH)
        self.y = numpy.arange(-8, height + 8, PITCH) + PITCH / 3
        self.z = numpy.zeros((len(self.x), len(self.y)))

    def under(self, x, y, radius):
        i0, i1 = numpy.searchsorted(self.x, [x - radius, x + radius])
        j0, j1 = numpy.searchsorted(self.y, [y - radius, y + radius])
        inside = (self.x[i0:i1, None] - x) ** 2 + (self.y[None, j0:j1] - y) ** 2 <= radius ** 2
        return self.z[i0:i1, j0:j1], inside

    def depth(self, place, radius):
        z, inside = self.under(place[0], place[1], radius)
        return float(numpy.max(z[inside] - place[2], initial=0))

    def cut(self, place, radius):
        """Returns how deep."""
        z, inside = self.under(place[0], place[1], radius)
        deepest = float(numpy.max(z[inside] - place[2], initial=0))
        if deepest > 0:
            z[inside] = numpy.minimum(z[inside], place[2])
        return max(0.0, deepest)


def places_of(text):
    """Each move: true if it is rapid, and its places."""
    at, mode = numpy.zeros(3), "0"
    for line in text.splitlines():
        words = dict(WORD.findall(re.sub(r"\(.*?\)", "", line)))
        if words.get("G", mode) in ("0", "1", "2", "3"):
            mode = words.get("G", mode)
        elif "X" not in words:
            continue
        end = numpy.array([float(words.get(axis, old)) for axis, old in zip("XYZ", at)])
        if (end == at).all() and "I" not in words and "J" not in words:
            continue
        if mode in ("0", "1"):
            count = max(1, math.ceil(math.dist(end, at) / STEP))
            yield mode == "0", [at + (end - at) * k / count for k in range(1, count + 1)]
        else:
            centre = at[:2] + [float(words.get("I", 0)), float(words.get("J", 0))]
            begin, finish = at[:2] - centre, end[:2] - centre
            turn = math.atan2(finish[1], finish[0]) - math.atan2(begin[1], begin[0])
            turn = turn % (2 * math.pi) or 2 * math.pi
            turn = turn if mode == "3" else turn - 2 * math.pi or -2 * math.pi
            radius = math.hypot(*begin)
            count = max(1, math.ceil(abs(turn) * radius / STEP))
            start = math.atan2(begin[1], begin[0])
            yield False, [numpy.array([centre[0] + radius * math.cos(start + turn * k / count),
                                       centre[1] + radius * math.sin(start + turn * k / count),
                                       at[2] + (end[2] - at[2]) * k / count]) for k in range(1, count + 1)]
        at = end


class Cut:
    """A program cut into a raster."""

    def __init__(self, raster, text, radius, less=0.0):
        self.worst_rapid, self.feed, self.air = 0.0, 0, 0
        for rapid, places in places_of(text):
            for place in places:
                if rapid:
                    self.worst_rapid = max(self.worst_rapid, raster.depth(place, radius - WALL) - FLOOR)
                else:
                    self.feed += 1
                    self.air += raster.depth(place, radius) <= FLOOR
                    raster.cut(place, radius - less)


def loop(points):
    corners = "".join(f"10\n{x:.4f}\n20\n{y:.4f}\n" for x, y in points)
    return f"0\nLWPOLYLINE\n8\npocket\n90\n{len(points)}\n70\n1\n{corners}"


def random_pocket(seed):
    """Loops of a pocket with slanted sides, a notch or a neck, and sometimes an island."""
    draw = random.Random(seed)
    width, height = draw.uniform(30, 44), draw.uniform(24, 32)
    skew = draw.uniform(-3, 3)
    notch = draw.uniform(4, height - 14)
    left = draw.uniform(0.35, 0.5) * width
    right = left + draw.uniform(2, 6)
    outer = [(0, 0), (width, skew), (width + skew, height), (right, height), (right, height - notch), (left, height - notch),
             (left, height), (0, height)]
    loops = [loop(outer)]
    if draw.random() < 0.5:
        x, y = draw.uniform(right + 11, width - 4), draw.uniform(11, 12)
        loops.append(f"0\nCIRCLE\n8\npocket\n10\n{x:.4f}\n20\n{y:.4f}\n40\n{draw.uniform(1, 3):.4f}\n")
    return width + abs(skew), height + abs(skew), "".join(loops), draw.choice(["lines", "arcs"])


class RestMachining(CuspCase):
    def job(self, name, tool, output="lines", stock="", more=""):
        self.write(name, JOB.format(tool=tool, output=output, stock=stock, more=more))

    def plan(self, job, program):
        said = self.cusp(0, "plan", job, "-o", program, "--stats", program + ".json")
        return (self.folder / program).read_text(), json.loads((self.folder / (program + ".json")).read_text()), said

    def drawing(self, loops):
        self.write("part.dxf", f"0\nSECTION\n2\nENTITIES\n{loops}0\nENDSEC\n0\nEOF\n")

    def pockets(self):
        for seed in range(ARGUMENTS.first, ARGUMENTS.first + ARGUMENTS.count):
            width, height, loops, output = random_pocket(seed)
            self.drawing(loops)
            self.job("first.toml", 1, output)
            self.job("full.toml", 2, output)
            self.job("rest.toml", 2, output, 'program = ["first.ngc"]')
            yield seed, [Raster(width, height) for _ in range(3)]

    def test_leaves_no_more_than_the_whole_operation(self):
        for seed, (whole, rest, repeated) in self.pockets():
            first, _, _ = self.plan("first.toml", "first.ngc")
            full, full_stats, _ = self.plan("full.toml", "full.ngc")
            kept, stats, _ = self.plan("rest.toml", "rest.ngc")
            Cut(whole, first, 5, WALL)
            Cut(whole, full, 1.5, WALL)
            Cut(rest, first, 5)
            Cut(repeated, first, 5)
            air = Cut(repeated, full, 1.5).air
            cut = Cut(rest, kept, 1.5)
            worst = float(numpy.max(rest.z - whole.z))
            print(f"seed {seed}: left {worst:.4f}, rapid {cut.worst_rapid:.4f}, air {cut.air * STEP:.0f} of {air * STEP:.0f} mm, stock {(cut.feed - cut.air) * STEP:.0f} mm, "
                  f"{full_stats['estimated_s']:.0f} s in full, {stats['estimated_s']:.0f} s")
            self.assertLessEqual(worst, FLOOR, f"seed {seed}")
            self.assertLessEqual(cut.worst_rapid, 0, f"seed {seed}")
            self.assertLessEqual(cut.air, AIR * air, f"seed {seed}")
            self.assertLess(stats["estimated_s"], 0.3 * full_stats["estimated_s"], f"seed {seed}")
            self.assertIn("all bounds hold", self.cusp(0, "verify", "rest.toml", "rest.ngc", "--grid", "0.3"))

    def simple_pocket(self, output="arcs"):
        self.drawing(loop([(0, 0), (34, 2), (30, 24), (0, 24)]))
        self.job("first.toml", 1, output)
        return self.plan("first.toml", "first.ngc")[0]

    def test_cuts_what_is_left_of_floor_and_walls(self):
        self.drawing(loop([(0, 0), (34, 2), (30, 24), (0, 24)]))
        self.job("first.toml", 1)
        self.write("first.toml", (self.folder / "first.toml").read_text().replace("depth = 5", "depth = 4.9"))
        self.job("full.toml", 2)
        self.job("rest.toml", 2, stock='program = ["first.ngc"]')
        first, full, kept = (self.plan(name + ".toml", name + ".ngc")[0] for name in ("first", "full", "rest"))
        whole, rest = Raster(36, 26), Raster(36, 26)
        Cut(whole, first, 5, WALL)
        Cut(whole, full, 1.5, WALL)
        Cut(rest, first, 5)
        self.assertGreater(float(numpy.max(rest.z - whole.z)), 0.05)
        self.assertLessEqual(Cut(rest, kept, 1.5).worst_rapid, 0)
        self.assertLessEqual(float(numpy.max(rest.z - whole.z)), FLOOR)
        self.assertIn("all bounds hold", self.cusp(0, "verify", "rest.toml", "rest.ngc", "--grid", "0.3"))

    def test_after_its_own_program_is_nothing(self):
        corners = [[0, 0, -1], [0, 20, -1], [30, 0, -3], [30, 20, -3]]
        self.write("slope.json", json.dumps({"shape": {"type": "surface", "count": 1, "data": [{
            "degree_u": 1, "degree_v": 1, "size_u": 2, "size_v": 2, "knotvector_u": [0, 0, 1, 1],
            "knotvector_v": [0, 0, 1, 1], "control_points": {"points": corners, "weights": [1, 1, 1, 1]}}]}}))
        self.drawing(loop([(4, 4), (26, 4), (26, 16), (4, 16)]))
        floor = 'tool = "ball"\nfloor = ["slope.json"]\nscallop = {}\n'
        for name, text, scallops in (("planes", 'strategy = "parallel_planes"\n' + floor, (0.05, 0.04)),
                                     ("pocket", 'strategy = "contour_pocket"\nboundary = "part.dxf"\n' + floor, (0.05, 0.04)),
                                     ("carved", 'strategy = "v_carve"\ndepth = 1\nboundary = "part.dxf"\nscallop = {}\n',
                                      (0.2, 0.1))):
            jobs = [f"""[[tool]]
shape = "vee"
diameter = 8
tip_angle = 60
[[tool]]
name = "ball"
shape = "ball"
diameter = 6
[cutting]
feed = 1000
[stock]
top = 0
bottom = -6
x = [-6, 36]
y = [-6, 26]
[[operation]]
{text.format(scallop)}""" for scallop in scallops]
            for job, lines in (("first", jobs[0]), ("again", jobs[0] + 'after = "first.ngc"\n'),
                               ("finer", jobs[1] + 'after = "first.ngc"\n')):
                self.write(job + ".toml", lines)
            whole = self.plan("first.toml", "first.ngc")[1]
            again = self.plan("again.toml", "again.ngc")[1]
            finer = self.plan("finer.toml", "finer.ngc")[1]
            self.assertGreater(whole["cut_length_mm"], 100, name)
            self.assertEqual(0, again["cut_length_mm"], name)
            self.assertGreater(finer["cut_length_mm"], 50, name)
            self.assertIn("all bounds hold", self.cusp(0, "verify", "finer.toml", "finer.ngc"))

    def test_takes_the_tool_of_a_foreign_program_from_the_job(self):
        first = self.simple_pocket()
        bare = re.sub(r"\(.*?\)\n", "", first)
        self.assertIn("G2", bare + first.replace("G3", "G2"))
        self.job("rest.toml", 2, "arcs", 'program = "first.ngc"')
        known, _, _ = self.plan("rest.toml", "known.ngc")
        self.write("first.ngc", bare)
        foreign, _, _ = self.plan("rest.toml", "foreign.ngc")
        self.assertEqual(known, foreign)

    def test_refuses_a_program_whose_tool_is_not_known(self):
        first = self.simple_pocket()
        self.write("other.ngc", first)
        self.job("rest.toml", 2, stock='program = ["first.ngc"]')
        bare = re.sub(r"\(.*?\)\n", "", first)
        self.write("first.ngc", bare.replace("T1", "T7"))
        for command in (["plan", "rest.toml", "-o", "rest.ngc"], ["verify", "rest.toml", "other.ngc"]):
            said = self.cusp(2, *command)
            self.assertIn("first.ngc: tool 7 is not known", said)
            self.assertIn("rest.toml has no [[tool]] with number = 7", said)
        self.write("first.ngc", bare.replace("T1\n", ""))
        self.assertIn("first.ngc: its tool is not known: there is neither a T word",
                      self.cusp(2, "plan", "rest.toml", "-o", "rest.ngc"))
        self.write("first.ngc", first + "(tool 1 flat diameter 8 mm)\n")
        self.plan("rest.toml", "rest.ngc")  # after the program's end
        self.write("first.ngc", first.replace("T1\n", "T1\n(tool 1 flat diameter 8 mm)\n"))
        self.assertIn("tool 1 is another one than in a comment before",
                      self.cusp(2, "plan", "rest.toml", "-o", "rest.ngc"))

    def test_refuses_bad_keys(self):
        self.simple_pocket()
        for stock, more, wanted in (
                ('program = "none.ngc"', "", "none.ngc, which is no file"), ("program = []", "", "names no program"),
                ("", 'after = ["first.ngc", "none.ngc"]', "operation 1: after: names none.ngc"),
                ("", "rest_tolerance = 0.1", "rest_tolerance: needs after, or program in [stock]"),
                ("", 'after = "first.ngc"\nrest_tolerance = 2', "rest_tolerance")):
            self.job("rest.toml", 2, stock=stock, more=more)
            said = self.cusp(2, "plan", "rest.toml", "-o", "rest.ngc")
            self.assertIn(wanted, said)
            self.assertIn("rest.toml:", said)

    def test_of_nothing_is_an_empty_operation_and_a_warning(self):
        first = self.simple_pocket()
        self.job("again.toml", 1, "arcs", more='after = "first.ngc"')
        again, stats, said = self.plan("again.toml", "again.ngc")
        self.assertIn("warning: operation 1, pocket: nothing thicker than 0.001 mm is left after first.ngc", said)
        self.assertFalse([rapid for rapid, _ in places_of(again) if not rapid])
        self.assertEqual(0, stats["operations"][0]["rest_machining"]["kept_mm"])
        self.assertEqual(["first.ngc"], stats["operations"][0]["rest_machining"]["programs"])
        self.assertGreater(stats["operations"][0]["rest_machining"]["removed_mm"], 100)
        self.cusp(0, "sim", "again.ngc")
        self.assertIn("all bounds hold", self.cusp(0, "verify", "again.toml", "again.ngc", "--grid", "0.3"))

    def test_is_verified_from_the_stock_that_the_programs_leave(self):
        self.simple_pocket()
        self.job("rest.toml", 2, "arcs", more='after = "first.ngc"')
        self.plan("rest.toml", "rest.ngc")
        self.cusp(0, "verify", "rest.toml", "rest.ngc", "--grid", "0.3", "--stats", "rest.json")
        volume = json.loads((self.folder / "rest.json").read_text())["removed_mm3"]
        # four corners of the larger tool, 5 mm deep
        self.assertTrue(4 * 5 * 0.5 * (1 - math.pi / 4) * (5 ** 2 - 1.5 ** 2) < volume < 600, volume)
        self.job("full.toml", 2, "arcs")
        self.assertIn("of operation 1 (pocket)", self.cusp(1, "verify", "full.toml", "rest.ngc", "--grid", "0.3"))

    def test_of_operations_of_one_job_comes_after_those_before_it(self):
        self.simple_pocket()
        self.write("half.ngc", "(tool 1 flat diameter 10 mm)\nT1\nG0 Z5\nG0 X10 Y12\nG1 Z-2 F300\nG1 X22 F900\nG0 Z5\nM30\n")
        self.job("both.toml", 1, "arcs", 'program = "half.ngc"')
        text = (self.folder / "both.toml").read_text()
        second = text[text.index("[[operation]]"):].replace("tool = 1", "tool = 2")
        self.write("both.toml", text + second)
        _, stats, _ = self.plan("both.toml", "both.ngc")
        by_tool = {tool: [sum(o["rest_machining"][key] for o in stats["operations"] if o["tool"] == tool)
                          for key in ("kept_mm", "removed_mm")] for tool in (1, 2)}
        self.assertGreater(by_tool[1][0], by_tool[1][1])      # most is left
        self.assertLess(by_tool[2][0], 0.2 * by_tool[2][1])   # corners alone
        self.assertIn("all bounds hold", self.cusp(0, "verify", "both.toml", "both.ngc", "--grid", "0.3"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
