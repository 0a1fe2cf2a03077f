#!/usr/bin/env python3
"""Stock of any outline: the plan comes in from beside it and `cusp verify` cuts it, not its box.

usage: stock_outline_test.py CUSP
"""
import json
import math
import sys
import unittest

from cusp_case import CuspCase

HEAD = """
[tool]
shape = "flat"
diameter = 6
flute_length = 16
[cutting]
feed = 1000
[stock]
top = 0
bottom = -20
{stock}
"""
POCKET = """
[[operation]]
strategy = "pocket"
boundary = "plate.dxf#{layer}"
depth = {depth}
{keys}
"""
ADAPTIVE = 'clearing = "adaptive"\nmax_engagement = 60\noutput = "arcs"'
CASTING = [(-40, -40), (40, -40), (40, 40), (26, 40), (26, 0), (12, 0), (12, 40), (8, 40), (8, 10), (-8, 10), (-8, 40),
           (-40, 40)]


def polyline(layer, *points):
    return (f"0\nLWPOLYLINE\n8\n{layer}\n90\n{len(points)}\n70\n1\n" +
            "".join(f"10\n{x}\n20\n{y}\n" for x, y in points))


def rectangle(layer, x0, y0, x1, y1):
    return polyline(layer, (x0, y0), (x1, y0), (x1, y1), (x0, y1))


def circle(layer, radius, x=0, y=0):
    return f"0\nCIRCLE\n8\n{layer}\n10\n{x}\n20\n{y}\n40\n{radius}\n"


DRAWING = [
    circle("bar", 40), circle("ring", 40), circle("ring", 12), polyline("casting", *CASTING),
    rectangle("inside", -15, -10, 15, 10), rectangle("side", 0, -12, 60, 12), rectangle("flat", 20, -50, 50, 50),
    circle("whole", 40), rectangle("bore", -20, -8, 20, 8), rectangle("notch", -12, -20, 8, 15),
    rectangle("beside", 50, -8, 70, 8), polyline("cross", (0, 0), (30, 30), (30, 0), (0, 30)),
    rectangle("two", -40, -40, -10, 40), rectangle("two", 10, -40, 40, 40),
    "0\nLINE\n8\nopen\n10\n0\n20\n0\n11\n10\n21\n0\n", polyline("wedge", (0, 0), (60, 0), (60, 40)),
    rectangle("corner", 30, 20, 70, 45)]


def segment(radius, x):
    """mm2 of a disc beyond the chord at x."""
    return radius**2 * math.acos(x / radius) - x * math.sqrt(radius**2 - x**2)


class StockOutline(CuspCase):
    def setUp(self):
        super().setUp()
        self.write("plate.dxf", "0\nSECTION\n2\nENTITIES\n" + "".join(DRAWING) + "0\nENDSEC\n0\nEOF\n")

    def job(self, stock, layer, keys=ADAPTIVE, depth=8):
        self.write("job.toml", HEAD.format(stock=stock) + POCKET.format(layer=layer, keys=keys, depth=depth))

    def planned(self, outline, layer, keys=ADAPTIVE):
        self.job(f'outline = "plate.dxf#{outline}"', layer, keys)
        self.cusp(0, "plan", "--estimate-times", "job.toml", "-o", "p.ngc", "--stats", "p.json")
        self.cusp(0, "verify", "job.toml", "p.ngc", "--stats", "v.json")
        plan, verified = (json.loads((self.folder / f).read_text()) for f in ("p.json", "v.json"))
        return plan["operations"][-1], verified

    def test_the_tool_comes_in_from_beside_the_stock(self):
        half = math.sqrt(40**2 - 12**2)
        bore = 4 * (8 * math.sqrt(12**2 - 8**2) / 2 + 12**2 * math.asin(8 / 12) / 2)
        corner = 3**2 * (1 - math.pi / 4)
        areas = {("bar", "side"): 12 * half + 40**2 * math.asin(12 / 40) - 2 * corner,
                 ("bar", "flat"): segment(40, 20), ("bar", "whole"): math.pi * 40**2,
                 ("ring", "bore"): 40 * 16 - bore - 4 * corner,
                 ("casting", "notch"): 20 * 35 - 16 * 5 - 3 * corner}
        for (outline, layer), area in areas.items():
            with self.subTest(outline=outline, layer=layer):
                plan, verified = self.planned(outline, layer)
                self.assertEqual(1, plan["open_pocket"])
                self.assertEqual(0, plan["entries"])
                self.assertLessEqual(plan["engagement_bound_deg"], 60)
                self.assertLess(verified["over_engagement_mm"], 0.003 * plan["cut_length_mm"])
                self.assertLess(verified["rapid_cut_max_mm"], 0.005)
                # all but what the tolerance leaves at walls
                self.assertAlmostEqual(8 * area, verified["removed_mm3"], delta=0.004 * 8 * area)
                self.assertAlmostEqual(verified["removed_mm3"], plan["removed_mm3"], delta=2)
                self.assertLess(plan["air_mm"], plan["cut_length_mm"] / 2)

    def test_a_pocket_inside_has_a_helix(self):
        plan, _ = self.planned("bar", "inside")
        self.assertNotIn("open_pocket", plan)
        self.assertEqual(1, plan["entries"])

    def test_the_box_is_another_stock(self):
        self.planned("bar", "flat")
        program = (self.folder / "p.ngc").read_text()
        self.job("x = [-40, 40]\ny = [-40, 40]", "flat")
        self.cusp(0, "plan", "--estimate-times", "job.toml", "-o", "box.ngc", "--stats", "b.json")
        self.assertNotEqual(program, (self.folder / "box.ngc").read_text())
        # in the corners of the box the program of the bar goes down into stock, and leaves some
        self.assertIn("left", self.cusp(1, "verify", "job.toml", "p.ngc", "--stats", "v.json"))
        self.assertGreater(json.loads((self.folder / "v.json").read_text())["over_engagement_mm"], 1)

    def test_contour_clearing_keeps_inside_the_outline(self):
        plan, _ = self.planned("bar", "side", keys="")
        self.assertEqual(4, plan["rest_places"])

    def test_the_stock_is_turned_over_with_the_parts(self):
        self.job('outline = "plate.dxf#wedge"', "corner", ADAPTIVE + '\nsetup = "back"')
        job = (self.folder / "job.toml").read_text()
        front = POCKET.format(layer="corner", keys=ADAPTIVE, depth=3)
        self.write("job.toml", job + front + '[[setup]]\nname = "front"\n[[setup]]\nname = "back"\nflip = "x"\n')
        self.cusp(0, "plan", "--estimate-times", "job.toml", "-o", "p.ngc", "--stats", "p.json")
        area = None
        for name, depth in (("front", 3), ("back", 8)):
            plan = json.loads((self.folder / f"p-{name}.json").read_text())["operations"][-1]
            self.assertEqual(1, plan["open_pocket"])
            area = area or plan["removed_mm3"] / depth
            self.assertAlmostEqual(area, plan["removed_mm3"] / depth, delta=0.01 * area)
            self.assertAlmostEqual(30 * 20 / 2, plan["removed_mm3"] / depth, delta=6)  # the wedge over (30, 20)
        self.cusp(0, "verify", "job.toml", "p-back.ngc", "--after", "p-front.ngc")

    def test_the_outline_is_placed_with_the_drawings(self):
        here, _ = self.planned("bar", "side")
        there, _ = self.planned("bar", "side", ADAPTIVE + "\n[placing]\nmove = [100, 50, 0]")
        self.assertEqual(1, there["open_pocket"])
        self.assertAlmostEqual(here["removed_mm3"], there["removed_mm3"], delta=0.002 * here["removed_mm3"])

    def test_what_is_no_stock_is_refused(self):
        for stock, layer, words in (
                ('outline = "plate.dxf#bar"', "beside", "stock: outline: {0}#bar has no stock in the pocket {0}#beside "
                 "of operation 1, x 50 to 70, y -8 to 8 mm: the stock's box is x -40 to 40, y -40 to 40"),
                ('outline = "plate.dxf#cross"', "inside", "stock: outline: {0}#cross: the loop crosses itself near x 15"),
                ('outline = "plate.dxf#two"', "inside", "bounds a second body: the stock is one"),
                ('outline = "plate.dxf#open"', "inside", "stock: outline: {0}#open: the loop is open: 1 curve"),
                ('outline = "plate.dxf#none"', "inside", "stock: outline: {0}: no curve on the layer \"none\""),
                ('outline = "none.dxf"', "inside", "stock: outline: none.dxf: "),
                ('outline = "plate.dxf#bar"\nx = [0, 1]', "inside", "stock: outline: is given beside x: one of them"),
                ('outline = "plate.dxf#bar"\ny = [0, 1]', "inside", "stock: outline: is given beside y: one of them"),
                ('outline = "plate.dxf#bar"\nmargin = 1', "inside", "stock: outline: is given beside margin")):
            with self.subTest(stock):
                self.job(stock, layer)
                said = self.cusp(2, "plan", "--estimate-times", "job.toml", "-o", "p.ngc")
                self.assertIn(words.format("plate.dxf"), said)
                self.assertIn("job.toml:", said)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
