"""Jobs with several set-ups: a program for each, parts turned over with the stock, what the first has cut through.

usage: setups_test.py CUSP

The flip is judged by points of the programs alone: turned back about the middle of the stock's box, what the second
program cuts lies where the drawing has it.
"""
import json
import math
import pathlib
import random
import re
import sys
import unittest

from cusp_case import CuspCase

WORD = re.compile(r"([A-Z])(-?[\d.]+)")

HEAD = """
[[tool]]
shape = "flat"
diameter = 4
[[tool]]
shape = "drill"
diameter = 3
[cutting]
feed = 1000
[stock]
top = 1
bottom = -9
x = [-5, 45]
y = [-10, 30]
"""
SETUPS = """
[[setup]]
name = "front"
[[setup]]
name = "back"
flip = "{flip}"
"""
OPERATIONS = """
[[operation]]
strategy = "pocket"
boundary = "plate.dxf#pocket"
depth = 3
[[operation]]
strategy = "drill"
boundary = "plate.dxf#holes"
tool = 2
depth = 12
[[operation]]
setup = "back"
strategy = "pocket"
boundary = "plate.dxf#pocket"
depth = 4
[[operation]]
setup = "back"
strategy = "drill"
boundary = "plate.dxf#holes"
tool = 2
depth = 12
"""


def rectangle(layer, x0, y0, x1, y1):
    corners = "".join(f"10\n{x}\n20\n{y}\n" for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1)))
    return f"0\nLWPOLYLINE\n8\n{layer}\n90\n4\n70\n1\n{corners}"


def circle(layer, x, y, radius):
    return f"0\nCIRCLE\n8\n{layer}\n10\n{x}\n20\n{y}\n40\n{radius}\n"


def drawing(entities):
    return f"0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n"


# The places of feed moves below the stock's top, of programs without arcs.
def cut_places(program):
    at, places, feed = {"X": 0.0, "Y": 0.0, "Z": 99.0}, [], False
    for line in re.sub(r"\(.*?\)", "", program).splitlines():
        words = WORD.findall(line)
        for letter, number in words:
            if letter == "G" and number in ("0", "1"):
                feed = number == "1"
        moves = {letter: float(number) for letter, number in words if letter in at}
        if moves:
            at.update(moves)
            if feed and at["Z"] < 1:
                places.append((at["X"], at["Y"], at["Z"]))
    return places


def box(places):
    return [round(f(p[axis] for p in places), 3) for axis in (0, 1) for f in (min, max)]


class Setups(CuspCase):
    def setUp(self):
        super().setUp()
        self.write("plate.dxf", drawing(rectangle("pocket", 2, 4, 20, 14) + circle("holes", 30, 6, 1.5) +
                                        circle("holes", 38, 20, 1.5) + rectangle("outline", 0, 0, 40, 24)))

    def text(self, name):
        return (self.folder / name).read_text()

    def job(self, setups=SETUPS.format(flip="x"), operations=OPERATIONS, head=HEAD):
        self.write("job.toml", head + setups + operations)

    # Within plan_tolerance.
    def near(self, wanted, found):
        for a, b in zip(wanted, found, strict=True):
            self.assertAlmostEqual(a, b, delta=0.021, msg=f"{wanted} {found}")

    def refused(self, words, **job):
        self.job(**job)
        self.assertIn(words, self.cusp(2, "plan", "job.toml", "-o", "p.ngc"))

    def test_one_program_a_set_up_with_its_offset(self):
        self.job()
        said = self.cusp(0, "plan", "job.toml", "-o", "p.ngc", "--stats", "p.json")
        self.assertIn("set-up back, G55, turned over about x", said)
        self.assertEqual(["p-back.ngc", "p-front.ngc"], sorted(f.name for f in self.folder.glob("*.ngc")))
        self.assertIn(" G54 ", self.text("p-front.ngc"))
        self.assertNotIn("G55", self.text("p-front.ngc").split("\nG17")[1])
        self.assertIn(" G55 ", self.text("p-back.ngc"))
        self.assertEqual("G55", json.loads(self.text("p-back.json"))["offset"])
        for post in ("grbl", "grblhal", "linuxcnc", "mach3", "fanuc"):
            self.cusp(0, "plan", "job.toml", "-o", f"{post}.nc", "--post", post)
            self.assertRegex(self.text(f"{post}-back.nc"), r"\n(N\d+ )?G17 G21 G40 G49 G55 ")

    def test_parts_are_turned_over_with_the_stock(self):
        # the stock's middle is x 20, y 10
        for flip, pocket, holes in (("x", [4, 18, 8, 14], {(30, 14), (38, 0)}),
                                    ("y", [22, 36, 6, 12], {(10, 6), (2, 20)})):
            self.job(SETUPS.format(flip=flip))
            self.cusp(0, "plan", "job.toml", "-o", "p.ngc")
            front, back = self.text("p-front.ngc"), self.text("p-back.ngc")
            self.near([4, 18, 6, 12], box([p for p in cut_places(front) if p[2] > -4]))
            places = cut_places(back)
            self.near(pocket, box(places))
            self.assertAlmostEqual(-3, min(p[2] for p in places), delta=0.003)  # 4 mm below the top at 1

    # Holes that the first program has drilled through are not drilled again.
    def test_what_was_cut_through_is_not_cut_again(self):
        self.job()
        said = self.cusp(0, "plan", "job.toml", "-o", "p.ngc")
        self.assertIn("nothing thicker than", said)
        self.assertNotIn("T2", self.text("p-back.ngc"))
        # not through: the drill's tip ends 0.1 mm above the bottom of z -9
        self.job(operations=OPERATIONS.replace("depth = 12\n", "depth = 9.9\n", 1))
        self.cusp(0, "plan", "job.toml", "-o", "p.ngc")
        self.assertEqual({(30, 14), (38, 0)},
                         {p[:2] for p in cut_places(self.text("p-back.ngc").split("T2")[1])})

    def test_verify_judges_each(self):
        self.job()
        self.cusp(0, "plan", "job.toml", "-o", "p.ngc")
        self.assertIn("all bounds hold", self.cusp(0, "verify", "job.toml", "p-front.ngc"))
        said = self.cusp(0, "verify", "job.toml", "p-back.ngc", "--after", "p-front.ngc")
        self.assertIn("set-up back, G55, turned over about x", said)
        self.assertIn("all bounds hold", said)
        # without the first program there is stock in its holes
        said = self.cusp(1, "verify", "job.toml", "p-back.ngc")
        self.assertIn("the stock is uncut: --after", said)
        self.assertIn("of operation 4 (drill)", said)
        # the pocket where the drawing has it, not turned over
        self.write("wrong.ngc", self.text("p-front.ngc").replace("G54", "G55"))
        self.assertIn("broken: wall_gouge_max_mm", self.cusp(1, "verify", "job.toml", "wrong.ngc"))
        # what the first program cut from below is stock: a hole beside those that went through is found
        deep = self.text("p-back.ngc").replace("\nM5", "\nG0 X10 Y-5\nG1 Z-3\nG0 Z6\nM5", 1)
        self.write("deep.ngc", deep)
        self.assertIn("broken: gouge_max_mm", self.cusp(1, "verify", "job.toml", "deep.ngc", "--after", "p-front.ngc"))

    # The stock is 10 mm thick, the pocket of the front 3 mm deep; both lie over each other.
    def both_sides(self, depth, more="", head=HEAD, flip="x"):
        self.job(SETUPS.format(flip=flip), OPERATIONS.replace("depth = 4", f"depth = {depth}\n{more}"), head)
        return self.cusp(0, "plan", "job.toml", "-o", "p.ngc")

    def judged(self, status):
        return self.cusp(status, "verify", "job.toml", "p-back.ngc", "--after", "p-front.ngc")

    def test_a_floor_between_two_sides_that_is_thin_or_broken_through(self):
        for flip, y in (("x", (6, 16)), ("y", (4, 14))):
            said = self.both_sides(6.7, flip=flip)
            words = r"0\.30 mm are left between the cuts of both sides at x (\S+) y (\S+) z -5\.(?:7|69)\S* mm \(operation 3, pocket\); "
            self.assertRegex(said, "warning: " + words + r"the limit is 0\.5 mm \(least_floor in \[stock\]")
            place = re.search(words, said)
            x_range = (2, 20) if flip == "x" else (20, 38)
            self.assertTrue(x_range[0] < float(place[1]) < x_range[1] and y[0] < float(place[2]) < y[1], place[0])
            said = self.judged(1)
            self.assertRegex(said, "broken: " + words)
            self.assertRegex(said, r"between_sides_min_mm: 0\.30")
        said = self.both_sides(7.2)
        words = r"the cuts of both sides meet at x \S+ y \S+ z -6\.(2|19)\S* mm \(operation 3, pocket\), 0\.(20|19) mm deep in each other; "
        self.assertRegex(said, "warning: " + words)
        self.assertRegex(self.judged(1), "broken: " + words)
        for depth, more, head in ((6.2, "", HEAD), (6.7, "", HEAD.replace("top = 1", "top = 1\nleast_floor = 0.2")),
                                  (7.2, "may_open = true", HEAD), (11, "", HEAD)):
            self.assertNotIn("both sides", self.both_sides(depth, more, head))
            self.assertIn("all bounds hold", self.judged(0))
        self.both_sides(6.2)
        self.assertIn("between_sides_min_mm: 0.8", self.judged(0))
        self.job(operations=OPERATIONS.replace("depth = 12\n", "depth = 7\n"))
        self.assertIn("(operation 4, drill)", self.cusp(0, "plan", "job.toml", "-o", "p.ngc"))

    # A hole that the front has drilled through is open, its edge is no thin floor.
    def test_holes_through_are_no_thin_floor(self):
        deep = OPERATIONS.replace("depth = 12\n", "depth = 10.2\n", 1).replace('#holes"\ntool = 2\ndepth = 12', '#over"\ndepth = 4')
        self.write("plate.dxf", drawing(rectangle("pocket", 2, 4, 20, 14) + circle("holes", 30, 6, 1.5) +
                                        rectangle("over", 25, 1, 35, 11)))
        self.job(operations=deep.replace('"drill"\nboundary = "plate.dxf#over"', '"pocket"\nboundary = "plate.dxf#over"'))
        self.assertNotIn("both sides", self.cusp(0, "plan", "job.toml", "-o", "p.ngc"))

    def test_a_set_up_without_a_flip_goes_on_in_the_stock_of_the_first(self):
        self.job('[[setup]]\nname = "a"\n[[setup]]\nname = "b"\n', OPERATIONS.replace('"back"', '"b"'))
        said = self.cusp(0, "plan", "job.toml", "-o", "p.ngc")
        self.assertIn("nothing thicker than", said)  # the holes; the pocket is a millimetre deeper
        self.assertAlmostEqual(-3.0, min(p[2] for p in cut_places(self.text("p-b.ngc"))), delta=0.003)
        self.assertNotIn("T2", self.text("p-b.ngc"))
        self.assertIn("all bounds hold", self.cusp(0, "verify", "job.toml", "p-b.ngc", "--after", "p-a.ngc"))

    def test_what_the_first_has_cut_is_no_gouge_of_the_second(self):
        pocket, drill = OPERATIONS.split("[[operation]]")[1:3]
        self.job('[[setup]]\nname = "a"\n[[setup]]\nname = "b"\n', f'[[operation]]{pocket}[[operation]]\nsetup = "b"\n{drill}')
        self.cusp(0, "plan", "job.toml", "-o", "p.ngc")
        judge = "verify", "job.toml"
        self.assertIn("all bounds hold", self.cusp(0, *judge, "p-b.ngc", "--after", "p-a.ngc"))
        self.write("p.toml", HEAD.replace("y = [-10, 30]", 'y = [-10, 30]\nprogram = "p-a.ngc"') + "[[operation]]" + drill)
        self.cusp(0, "plan", "p.toml", "-o", "own.ngc")
        self.assertIn("all bounds hold", self.cusp(0, "verify", "p.toml", "own.ngc"))
        # a hole through the first one's pocket counts from the pocket's floor, z -2; one beside it in full
        for place, depth, words in (("X10 Y8", 1.5, r"gouge_max_mm 1\.(48\d|49\d|5) by tool 2"), ("X10 Y-5", 4.5, r"gouge_max_mm 4\.(48\d|49\d|5) by tool 2")):
            self.write("deep.ngc", self.text("p-b.ngc").replace("\nM5", f"\nG0 {place}\nG1 Z-3.5\nG0 Z6\nM5", 1))
            self.assertRegex(self.cusp(1, *judge, "deep.ngc", "--after", "p-a.ngc"), words)

    def test_sim_runs_it_in_its_offset(self):
        self.job()
        self.cusp(0, "plan", "job.toml", "-o", "p.ngc")
        text = self.text("p-back.ngc")
        self.cusp(0, "sim", "p-back.ngc", "--stats", "a.json")
        self.write("moved.ngc", "G10 L2 P2 X7 Y-3 Z2\n" + text)
        self.cusp(0, "sim", "moved.ngc", "--stats", "b.json")
        ends = [json.loads(self.text(f"{name}.json"))["end_mpos_mm"] for name in "ab"]
        self.assertEqual([7, -3, 2], [round(b - a, 4) for a, b in zip(*ends)])

    def test_random_flips_take_holes_where_the_drawing_has_them(self):
        for seed in range(5):
            chance = random.Random(seed)
            x = sorted(chance.uniform(-50, 50) for _ in range(2))
            y = sorted(chance.uniform(-50, 50) for _ in range(2))
            holes = [(round(chance.uniform(*x), 3), round(chance.uniform(*y), 3)) for _ in range(4)]
            self.write("plate.dxf", drawing("".join(circle("holes", *hole, 2) for hole in holes)))
            flip = chance.choice("xy")
            head = HEAD.replace("[-5, 45]", str(x)).replace("[-10, 30]", str(y))
            self.job(SETUPS.format(flip=flip), "".join(
                f'[[operation]]\nsetup = "{name}"\nstrategy = "drill"\nboundary = "plate.dxf#holes"\ntool = 2\n'
                "depth = 2\n" for name in ("front", "back")), head)
            self.cusp(0, "plan", "job.toml", "-o", "p.ngc")
            found = {p[:2] for p in cut_places(self.text("p-back.ngc"))}
            turned = [(a, sum(y) - b) if flip == "x" else (sum(x) - a, b) for a, b in holes]
            for hole in turned:
                self.assertLess(min(math.dist(hole, p) for p in found), 2e-4, f"seed {seed}")
            self.assertEqual(len(set(holes)), len(found), f"seed {seed}")

    def test_errors(self):
        self.refused('operation 3: setup: is "back", but the job has no [[setup]]', setups="")
        two = SETUPS.format(flip="x")
        self.refused('operation 3: setup: is "bak", set-ups of the job are "front", "back"',
                     operations=OPERATIONS.replace('"back"', '"bak"', 1))
        self.refused('setup 2: offset: is G54, and so is that of the set-up "front"', setups=two + 'offset = "G54"\n')
        self.refused('setup 2: offset: is "G53", known are "G54"', setups=two + 'offset = "G53"\n')
        self.refused('setup 2: name: is "front", and so is that of another', setups=two.replace('"back"', '"front"'))
        self.refused('setup 2: name: is "a b": letters, digits', setups=two.replace('"back"', '"a b"'))
        self.refused("setup 1: name: is missing", setups=two.replace('name = "front"\n', "", 1))
        self.refused('setup 2: flip: is "z", known are "x", "y"', setups=SETUPS.format(flip="z"))
        self.refused("setup 2: flop: unknown key; the nearest known one is flip", setups=two.replace("flip", "flop"))
        self.refused('setup 3: no operation is in "side"', setups=two + '[[setup]]\nname = "side"\n')
        self.refused("may_open: is no key of profile", operations=OPERATIONS +
                     '[[operation]]\nstrategy = "profile"\nboundary = "plate.dxf#outline"\ndepth = 1\nmay_open = true\n')
        for key in ("top = 1\n", "bottom = -9\n", "y = [-10, 30]\n"):
            self.refused("a set-up with a flip needs the stock's box", head=HEAD.replace(key, ""))
        self.refused('fixture 1: setup: is "side", set-ups of the job are',
                     operations=OPERATIONS + '[[fixture]]\nsetup = "side"\ncentre = [90, 0]\ndiameter = 1\ntop = 9\n')

    def test_errors_of_programs(self):
        self.job()
        self.cusp(0, "plan", "job.toml", "-o", "p.ngc")
        text = self.text("p-back.ngc")
        self.write("other.ngc", text.replace("G55", "G57"))
        self.assertIn("moves in G57, which is that of no set-up of job.toml: front has G54, back has G55",
                      self.cusp(2, "verify", "job.toml", "other.ngc"))
        self.write("both.ngc", text.replace("\nM5", "\nG54 G1 X1\nM5", 1))
        self.assertIn("has moves in 2 work offsets", self.cusp(2, "verify", "job.toml", "both.ngc"))
        self.assertIn("the set-up back comes after front",
                      self.cusp(2, "verify", "job.toml", "p-front.ngc", "--after", "p-back.ngc"))

    def test_a_post_without_the_field_is_refused(self):
        self.job()
        post = pathlib.Path(__file__).resolve().parents[2] / "posts/grbl.toml"
        self.write("own.toml", post.read_text().replace("{offset}", "G54"))
        self.assertIn('the set-up "back" has the offset G55, but the post "own" has no {offset} in its modes',
                      self.cusp(2, "plan", "job.toml", "-o", "p.ngc", "--post", "own.toml"))
        self.assertFalse(list(self.folder.glob("*.ngc")))  # nor is the first set-up's program there

    def test_fixtures_of_one_set_up(self):
        clamp = '[[fixture]]\nsetup = "{}"\nx = [8, 12]\ny = [8, 12]\ntop = 4\n'
        self.job(operations=OPERATIONS + clamp.format("back"))
        self.assertRegex(self.cusp(2, "plan", "job.toml", "-o", "p.ngc"), "operation 3, pocket: .* would touch fixture 1")
        self.job(operations=OPERATIONS.replace("plate.dxf#pocket", "plate.dxf#holes", 1).replace("depth = 3", "depth = 3")
                 .replace('"pocket"\nboundary = "plate.dxf#holes"', '"drill"\ntool = 2\nboundary = "plate.dxf#holes"', 1) +
                 clamp.format("front"))
        self.cusp(0, "plan", "job.toml", "-o", "p.ngc")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
