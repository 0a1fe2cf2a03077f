#!/usr/bin/env python3
"""Pockets at the stock's edge, cleared adaptively: the tool comes in from beside the stock, and `cusp verify` finds nothing
over the angle but corners, nothing left and no rapid in stock.

usage: open_sides_test.py CUSP
"""
import json
import sys
import unittest

from cusp_case import CuspCase

JOB = """
[tool]
shape = "flat"
diameter = 6
[cutting]
feed = 1000
[stock]
x = [0, 80]
y = [0, 60]
[[operation]]
strategy = "pocket"
boundary = "plate.dxf#{layer}"
depth = 8
max_depth = 4
{keys}
"""
ADAPTIVE = 'clearing = "adaptive"\nmax_engagement = 60\noutput = "arcs"'
LAYERS = {
    "edge": [(40, 15), (80, 15), (80, 45), (40, 45)],
    "beyond": [(40, 15), (90, 15), (90, 45), (40, 45)],
    "corner": [(50, -2), (83, -2), (83, 20), (50, 20)],
    "through": [(0, 25), (80, 25), (80, 34), (0, 34)],
    "whole": [(0, 0), (80, 0), (80, 60), (0, 60)],
    "inside": [(40, 15), (79.9, 15), (79.9, 45), (40, 45)],
}


def polyline(layer, points):
    return (f"0\nLWPOLYLINE\n8\n{layer}\n90\n{len(points)}\n70\n1\n" +
            "".join(f"10\n{x}\n20\n{y}\n" for x, y in points))


class OpenSides(CuspCase):
    def planned(self, layer, keys=ADAPTIVE):
        drawing = "".join(polyline(name, points) for name, points in LAYERS.items())
        self.write("plate.dxf", f"0\nSECTION\n2\nENTITIES\n{drawing}0\nENDSEC\n0\nEOF\n")
        self.write("job.toml", JOB.format(layer=layer, keys=keys))
        self.cusp(0, "plan", "--estimate-times", "job.toml", "-o", "p.ngc", "--stats", "p.json")
        self.cusp(0, "verify", "job.toml", "p.ngc", "--stats", "v.json")
        plan, verified = (json.loads((self.folder / f).read_text()) for f in ("p.json", "v.json"))
        return plan["operations"][-1], verified

    def test_the_tool_comes_in_from_beside_the_stock(self):
        for layer, corners in (("edge", 2), ("beyond", 2), ("corner", 1), ("through", 0), ("whole", 0)):
            with self.subTest(layer):
                plan, verified = self.planned(layer)
                self.assertEqual(1, plan["open_pocket"])
                self.assertEqual(0, plan["entries"])
                self.assertEqual(corners, plan["rest_places"])  # those at the stock's edge are cut
                self.assertLessEqual(plan["engagement_bound_deg"], 60)
                self.assertLess(verified["over_engagement_mm"], 0.003 * plan["cut_length_mm"])
                self.assertLess(verified["rapid_cut_max_mm"], 0.005)

    def test_on_the_edge_is_beyond_it(self):
        self.planned("edge")
        program = (self.folder / "p.ngc").read_text()
        self.planned("beyond")
        self.assertEqual(program.replace("#edge", "#beyond"), (self.folder / "p.ngc").read_text())

    def test_a_pocket_inside_the_stock_has_a_helix(self):
        plan, _ = self.planned("inside")
        self.assertNotIn("open_pocket", plan)
        self.assertEqual(2, plan["entries"])  # of two layers

    def test_contour_clearing_keeps_inside_the_outline(self):
        plan, _ = self.planned("edge", keys="")
        self.assertEqual(4, plan["rest_places"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
