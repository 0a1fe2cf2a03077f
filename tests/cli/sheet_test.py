"""Drawings without a job file: what each shape is taken for, judged by distances from the drawing to the tool's path.

usage: sheet_test.py CUSP [SEED]
"""
import math
import pathlib
import random
import re
import sys
import tomllib
import unittest

from cusp_case import CuspCase

SEED = int(sys.argv[2]) if len(sys.argv) > 2 else 54
DEPTH, SHALLOW = 6, 3.01  # mm; pockets and lines end above the second
NEAR = 0.06               # mm, of chords and rounding


class Rectangle:
    def __init__(self, x0, y0, x1, y1):
        self.x0, self.y0, self.x1, self.y1 = x0, y0, x1, y1

    def inside(self, x, y):
        return self.x0 < x < self.x1 and self.y0 < y < self.y1

    def distance(self, x, y):
        """To the boundary."""
        if self.inside(x, y):
            return min(x - self.x0, self.x1 - x, y - self.y0, self.y1 - y)
        return math.hypot(max(self.x0 - x, x - self.x1, 0), max(self.y0 - y, y - self.y1, 0))

    def samples(self):
        mx, my = (self.x0 + self.x1) / 2, (self.y0 + self.y1) / 2
        return [(mx, self.y0), (mx, self.y1), (self.x0, my), (self.x1, my)]

    def dxf(self, layer):
        corners = [(self.x0, self.y0), (self.x1, self.y0), (self.x1, self.y1), (self.x0, self.y1)]
        return (f"0\nLWPOLYLINE\n8\n{layer}\n90\n4\n70\n1\n" +
                "".join(f"10\n{x}\n20\n{y}\n" for x, y in corners))


class Circle:
    def __init__(self, x, y, radius):
        self.x, self.y, self.radius = x, y, radius

    def inside(self, x, y):
        return math.hypot(x - self.x, y - self.y) < self.radius

    def distance(self, x, y):
        return abs(math.hypot(x - self.x, y - self.y) - self.radius)

    def samples(self):
        return [(self.x + self.radius * math.cos(k), self.y + self.radius * math.sin(k)) for k in range(6)]

    def dxf(self, layer):
        return f"0\nCIRCLE\n8\n{layer}\n10\n{self.x}\n20\n{self.y}\n40\n{self.radius}\n"


def line(layer, x0, y0, x1, y1):
    return f"0\nLINE\n8\n{layer}\n10\n{x0}\n20\n{y0}\n11\n{x1}\n21\n{y1}\n"


def drawing(*entities):
    return "0\nSECTION\n2\nENTITIES\n" + "".join(entities) + "0\nENDSEC\n0\nEOF\n"


class Sheet:
    """Parts in a row, with holes, islands in holes, pockets and open lines, on layers that say nothing by their names."""

    def __init__(self, rng):
        self.loops, self.drilled, self.lines, self.pockets = [], [], [], []
        self.outer = rng.randint(1, 3)
        self.text = []
        left = rng.uniform(-50, 50)
        for _ in range(self.outer):
            self.add_part(rng, left, rng.uniform(-5, 5))
            left += 110
        rng.shuffle(self.text)

    def add(self, rng, shape):
        self.loops.append(shape)
        self.text.append(shape.dxf(rng.choice(["0", "cut", "body 2"])))

    def add_part(self, rng, x, y):
        self.add(rng, rng.choice([Rectangle(x, y, x + 70, y + 70), Circle(x + 35, y + 35, 46)]))
        kinds = [rng.choice(["drilled", "round", "square", "island", "line", "pocket"]) for _ in range(4)]
        for kind, (cx, cy) in zip(kinds, [(x + 18, y + 18), (x + 52, y + 18), (x + 18, y + 52), (x + 52, y + 52)]):
            if kind == "drilled":
                self.drilled.append((cx, cy))
                self.add(rng, Circle(cx, cy, 2.5))
            elif kind == "round":
                self.add(rng, Circle(cx, cy, rng.uniform(3, 12)))
            elif kind == "line":
                self.lines.append((cx, cy))
                self.text.append(line("0", cx - 5, cy - 3, cx + 5, cy + 3))
            elif kind == "pocket":
                self.pockets.append((cx, cy))
                self.text.append(Rectangle(cx - 8, cy - 8, cx + 8, cy + 8).dxf("Pockets"))
            else:
                self.add(rng, Rectangle(cx - 12, cy - 12, cx + 12, cy + 12))
                if kind == "island":
                    self.add(rng, Circle(cx, cy, rng.uniform(2, 6)))

    def is_material(self, x, y):
        return sum(loop.inside(x, y) for loop in self.loops) % 2 == 1


def cut_points(program):
    """(tool, x, y, z) along all feed moves, at most 0.1 mm apart."""
    place = {"X": 0.0, "Y": 0.0, "Z": 0.0}
    tool, mode, points = 0, 0, []
    for text in program.splitlines():
        text = re.sub(r"\(.*?\)", "", text)
        words = dict((letter, float(value)) for letter, value in re.findall(r"([A-Z])(-?[\d.]+)", text))
        tool = int(words.get("T", tool))
        mode = int(words["G"]) if words.get("G") in (0, 1, 2, 3, 81, 83) else mode
        target = {axis: words.get(axis, place[axis]) for axis in place}
        if mode in (81, 83) and ("X" in words or "Y" in words or "Z" in words):
            points.append((tool, target["X"], target["Y"], target["Z"]))
        elif mode == 1 and target != place:
            count = math.ceil(math.dist(place.values(), target.values()) / 0.1)
            for k in range(count + 1):
                points.append((tool, *(place[a] + (target[a] - place[a]) * k / count for a in place)))
        place = target
    return points


class Sheets(CuspCase):
    TOOLS = ("--tool", "flat:3", "drill:5")

    def plan(self, *arguments):
        """Output and program; the printed job gives the same moves."""
        said = self.cusp(0, "plan", *arguments, "-o", "out.ngc")
        printed = self.cusp(0, "plan", *arguments, "--print-job")
        self.write("job.toml", printed[printed.index("# The job of"):])
        self.cusp(0, "plan", "job.toml", "-o", "job.ngc")
        moves = [[text for text in (self.folder / name).read_text().splitlines() if not text.startswith("(")]
                 for name in ("out.ngc", "job.ngc")]
        self.assertEqual(*moves)
        self.job = tomllib.loads((self.folder / "job.toml").read_text())
        return said, (self.folder / "out.ngc").read_text()

    def refused(self, text, *arguments):
        self.assertIn(text, self.cusp(2, "plan", *arguments, "-o", "out.ngc"))

    def judge(self, sheet, program):
        """No deep cut touches material, every loop is cut along, every line and pocket is cut."""
        points = cut_points(program)
        radius = {1: 1.5, 2: 2.5}
        deep = [point for point in points if point[3] < -SHALLOW]
        for tool, x, y, z in deep:
            self.assertFalse(sheet.is_material(x, y), f"material is cut at {x} {y} {z}")
            nearest = min(loop.distance(x, y) for loop in sheet.loops)
            self.assertGreater(nearest, radius[tool] - NEAR, f"T{tool} at {x} {y} {z} is too near a loop")
        bottom = [point for point in deep if point[3] <= -DEPTH + 1e-6]
        for loop in sheet.loops:
            for at in loop.samples():
                nearest = min(math.dist(at, point[1:3]) - radius[point[0]] for point in bottom)
                self.assertLess(nearest, NEAR, f"nothing is cut beside {at}")
        for at in sheet.drilled:
            self.assertTrue(any(point[0] == 2 and math.dist(at, point[1:3]) < 1e-3 for point in bottom), at)
        for at in sheet.lines + sheet.pockets:
            self.assertTrue(any(-SHALLOW < point[3] < 0 and math.dist(at, point[1:3]) < 1.6 for point in points), at)

    def test_shapes_are_told_apart_by_nesting(self):
        rng = random.Random(SEED)
        for case in range(3):
            sheet = Sheet(rng)
            self.write("sheet.dxf", drawing(*sheet.text))
            said, program = self.plan("sheet.dxf", *self.TOOLS, "--depth", str(DEPTH))
            with self.subTest(seed=SEED, case=case):
                self.judge(sheet, program)
                self.assertIn("1 outline" if sheet.outer == 1 else f"{sheet.outer} outlines", said)
                self.assertEqual("outer", self.job["operation"][-1]["loops"])

    def test_the_judge_sees_the_wrong_side(self):
        sheet = Sheet(random.Random(SEED))
        self.write("sheet.dxf", drawing(*sheet.text))
        _, program = self.plan("sheet.dxf", *self.TOOLS, "--depth", str(DEPTH), "--side", "inside")
        with self.assertRaises(AssertionError):
            self.judge(sheet, program)

    def test_the_job_is_verified(self):
        sheet = Sheet(random.Random(SEED + 1))
        self.write("sheet.dxf", drawing(*sheet.text))
        self.plan("sheet.dxf", *self.TOOLS, "--depth", str(DEPTH), "--tabs", "3", "--moves", "arcs")
        self.assertIn("all bounds hold", self.cusp(0, "verify", "job.toml", "out.ngc"))
        self.assertEqual(3, self.job["operation"][-1]["tabs"]["count"])

    def test_options_say_what_layers_are(self):
        plate = Rectangle(0, 0, 60, 40)
        self.write("plate.dxf", drawing(plate.dxf("0"), Circle(10, 10, 4).dxf("a"), Circle(30, 20, 2.5).dxf("b"),
                                        Circle(45, 20, 2.6).dxf("b"), line("c", 20, 30, 40, 30),
                                        Rectangle(5, 20, 15, 35).dxf("d"), Circle(50, 35, 3).dxf("dims")))
        said, _ = self.plan("plate.dxf", "--tool", "flat:3", "drill:5", "vee:6:60", "--depth", "6", "--layer",
                            "a=pocket:2", "--layer", "b=drill:7", "--layer", "c=engrave:0.3", "--layer",
                            "d=v_carve:1")
        made = [(each["strategy"], each.get("depth")) for each in self.job["operation"]]
        self.assertEqual([("pocket", 2), ("engrave", 0.3), ("v_carve", 1), ("drill", 7), ("profile", 6)],
                         [(name, depth) for name, depth in made])
        self.assertIn("plate.dxf#a: pocket, flat 3 mm, 2 mm deep", said)
        self.assertNotIn("dims", (self.folder / "job.toml").read_text())

    def test_names_of_layers_count(self):
        self.write("plate.dxf", drawing(Rectangle(0, 0, 60, 40).dxf("Outline"), Circle(10, 10, 2.5).dxf("Holes"),
                                        Circle(30, 10, 6).dxf("Holes"), Circle(45, 10, 1).dxf("Holes"),
                                        line("Text", 10, 30, 40, 30), Rectangle(5, 20, 15, 28).dxf("POCKETS_2")))
        said, program = self.plan("plate.dxf", *self.TOOLS, "--depth", "6")
        self.assertEqual(["pocket", "engrave", "drill", "profile", "profile"],
                         [each["strategy"] for each in self.job["operation"]])
        self.assertIn("plate.dxf#Holes: 1 hole of 5 mm: drill, drill 5 mm, its tip 7.51 mm deep", said)
        self.assertIn("left out: 1 hole of 2 mm, narrower than flat 3 mm; --tool drill:2 drills it", said)
        self.assertFalse([p for p in cut_points(program) if math.dist(p[1:3], (45, 10)) < 3 and p[3] < 0])

    def test_several_drawings_are_one_job(self):
        self.write("plate.dxf", drawing(Rectangle(0, 0, 60, 40).dxf("0")))
        self.write("holes.dxf", drawing(Circle(15, 20, 6).dxf("0"), Circle(40, 20, 2.5).dxf("0")))
        said, program = self.plan("holes.dxf", "plate.dxf", *self.TOOLS, "--depth", "6")
        sheet = Sheet(random.Random(0))
        sheet.loops, sheet.lines, sheet.pockets = [Rectangle(0, 0, 60, 40), Circle(15, 20, 6),
                                                   Circle(40, 20, 2.5)], [], []
        sheet.drilled = [(40, 20)]
        self.judge(sheet, program)
        self.assertIn("holes.dxf: 1 hole: profile inside", said)
        self.write("mixed.dxf", drawing(Circle(15, 20, 6).dxf("0"), Circle(90, 20, 6).dxf("0")))
        self.refused("lies beside an outline of another drawing", "mixed.dxf", "plate.dxf", *self.TOOLS, "--depth", "6")

    def test_svg_and_inches(self):
        self.write("plate.svg", '<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="40mm" viewBox="0 0 60 40">'
                   '<rect width="60" height="40"/><circle cx="20" cy="20" r="6"/></svg>')
        said, _ = self.plan("plate.svg", "--tool", "flat:0.125", "--depth", "0.25", "--units", "inch")
        self.assertIn("plate.svg: 1 hole: profile inside, flat 0.125 inch", said)
        self.assertIn("plate.svg: 1 outline: profile outside", said)

    def test_the_example_is_what_its_call_makes(self):
        examples = pathlib.Path(__file__).resolve().parents[2] / "examples/plate"
        self.write("tag.svg", (examples / "tag.svg").read_text())
        self.plan("tag.svg", "--tool", "flat:3", "drill:5", "vee:6:60", "--depth", "4", "--tabs", "3", "--moves", "arcs")
        self.assertEqual((examples / "tag.toml").read_text(), (self.folder / "job.toml").read_text())
        self.assertIn("all bounds hold", self.cusp(0, "verify", "job.toml", "out.ngc"))

    def test_bad_calls_are_refused_in_words(self):
        self.write("plate.dxf", drawing(Rectangle(0, 0, 60, 40).dxf("0"), Circle(9, 9, 1).dxf("holes")))
        self.write("gap.dxf", drawing(line("0", 0, 0, 50, 0), line("0", 50, 0.3, 50, 40), line("0", 50, 40, 0, 0)))
        tool, depth = ("--tool", "flat:3"), ("--depth", "6")
        self.refused("--depth: is missing", "plate.dxf", *tool)
        self.refused("--tool: is missing", "plate.dxf", *depth)
        self.refused("--scallop: is for surfaces", "plate.dxf", *tool, *depth, "--scallop", "0.1")
        self.refused("--layer x: no drawing has a layer of that name", "plate.dxf", *tool, *depth, "--layer", "x=pocket:2")
        self.refused('"mill" is no operation', "plate.dxf", *tool, *depth, "--layer", "0=mill")
        self.refused("NAME=OPERATION is needed", "plate.dxf", *tool, *depth, "--layer", "0")
        self.refused("needs a vee", "plate.dxf", *tool, *depth, "--layer", "0=v_carve")
        self.refused("a mill is needed", "plate.dxf", "--tool", "drill:2", *depth)
        self.refused("--tabs 4:6: one number or three", "plate.dxf", *tool, *depth, "--tabs", "4:6")
        self.refused("tabs are lower", "plate.dxf", *tool, *depth, "--tabs", "4:6:9")
        self.refused("narrower than every drill: --tool drill:2", "plate.dxf", *tool, "drill:5", "drill:4", *depth,
                     "--layer", "holes=drill")
        self.refused("nothing to cut", "plate.dxf", *tool, *depth, "--layer", "0=none", "--layer", "holes=none")
        self.refused("has gaps of up to 0.3 mm: --join-gaps", "gap.dxf", *tool, *depth)
        said, _ = self.plan("gap.dxf", *tool, *depth, "--join-gaps", "0.4")
        self.assertIn("1 outline", said)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
