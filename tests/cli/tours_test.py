"""Ways between holes and parts: near the shortest there are, by a bound that knows no tour, and no loop cut after the
one that contains it.

usage: tours_test.py CUSP
It takes Debian's interpreter, which has numpy.
"""
import json
import random
import re
import sys
import unittest

import numpy
from cusp_case import CuspCase

HEAD = """units = "mm"
[[tool]]
shape = "flat"
diameter = 3
[cutting]
feed = 1000
plunge_feed = 300
[stock]
top = 0
bottom = -5
margin = 10
"""


def least_way(places, length, rounds=120):
    """No path from the first place through all others is shorter: the tree bound of Held and Karp, by subgradients.
    A tree of least length whose places are priced, less the prices of a path's two ends a place and one at its ends."""
    apart = numpy.hypot(*(places[:, None, :] - places[None, :, :]).transpose(2, 0, 1))
    price, best, step = numpy.zeros(len(places)), 0.0, 0.1
    for _ in range(rounds):
        degree, sum_ = numpy.zeros(len(places)), 0.0
        near, parent = numpy.full(len(places), numpy.inf), numpy.zeros(len(places), int)
        near[0] = 0
        done = numpy.zeros(len(places), bool)
        for k in range(len(places)):
            one = int(numpy.argmin(numpy.where(done, numpy.inf, near)))
            done[one] = True
            if k > 0:
                sum_ += near[one]
                degree[one] += 1
                degree[parent[one]] += 1
            way = apart[one] + price[one] + price
            nearer = ~done & (way < near)
            near[nearer], parent[nearer] = way[nearer], one
        bound = sum_ - 2 * price.sum() + price[0] + price[1:].min()
        best = max(best, bound)
        wanted = numpy.full(len(places), 2.0)
        wanted[0] = 1
        off = degree - wanted
        price += step * (length - bound) / max(1.0, (off ** 2).sum()) * off * 10
        price -= price[0]
    return best


def circle(x, y, radius):
    return f"0\nCIRCLE\n8\nl\n10\n{x:.4f}\n20\n{y:.4f}\n40\n{radius:.4f}\n"


def drawing(entities):
    return "0\nSECTION\n2\nENTITIES\n" + "".join(entities) + "0\nENDSEC\n0\nEOF\n"


class Tours(CuspCase):
    def places(self, strategy, entities):
        """Where rapid moves end over what is cut next, in order, after the origin."""
        self.write("l.dxf", drawing(entities))
        self.write("job.toml", HEAD + f'[[operation]]\nstrategy = "{strategy}"\nboundary = "l.dxf#l"\ndepth = 1\n')
        self.cusp(0, "plan", "--estimate-times", "job.toml", "-o", "p.ngc", "--stats", "p.json")
        at, places, self.cuts = {"X": 0.0, "Y": 0.0}, [(0.0, 0.0)], []
        for line in (self.folder / "p.ngc").read_text().splitlines():
            words = re.findall(r"([XY])(-?[\d.]+)", re.sub(r"\(.*?\)", "", line))
            at.update({axis: float(value) for axis, value in words})
            if words and re.match(r"G0 |G81", line) or (words and re.match(r"[XY]", line)):
                places.append((at["X"], at["Y"]))
                self.cuts.append([])
            elif words:
                self.cuts[-1].append((at["X"], at["Y"]))
        return numpy.array(places)

    def ratio(self, places):
        length = numpy.hypot(*numpy.diff(places, axis=0).T).sum()
        return length / least_way(places, length)

    def test_the_bound_is_no_longer_than_a_way_that_is_the_shortest(self):
        line = numpy.array([(k, 0.0) for k in range(40)])
        self.assertAlmostEqual(39, least_way(line, 39), delta=1e-6)
        grid = numpy.array([(i, j) for i in range(8) for j in range(8)], float)
        self.assertLessEqual(least_way(grid, 63), 63 + 1e-6)

    def test_random_holes_are_visited_on_nearly_the_shortest_way(self):
        seed = 540
        draw = random.Random(seed)
        for many, most in ((60, 1.03), (600, 1.05)):
            holes = [circle(draw.uniform(0, 500), draw.uniform(0, 500), 1.5) for _ in range(many)]
            places = self.places("drill", holes)
            self.assertEqual(many + 1, len(places))
            self.assertLess(self.ratio(places), most, f"{many} holes, seed {seed}")

    def test_the_bound_tells_a_way_that_is_longer(self):
        draw = random.Random(541)
        places = numpy.array([(draw.uniform(0, 500), draw.uniform(0, 500)) for _ in range(300)])
        here, left, order = places[0], set(range(1, 300)), [0]
        while left:  # the nearest next
            order.append(min(left, key=lambda k: numpy.hypot(*(places[k] - here))))
            left.remove(order[-1])
            here = places[order[-1]]
        self.assertGreater(self.ratio(places[order]), 1.1)

    def test_parts_of_a_sheet_come_after_what_is_in_them(self):
        seed = 542
        draw = random.Random(seed)
        cells = [(i, j) for i in range(6) for j in range(6)]
        draw.shuffle(cells)
        entities, rings = [], []
        for i, j in cells:
            x, y = 40 * i + 20, 40 * j + 20
            size = draw.uniform(13, 17)
            # a hole in an island in a hole in a part, and a hole beside
            for at, radius in (((x, y), size), ((x + 3, y), size - 5), ((x + 3, y), size - 9), ((x + 3, y), 2),
                               ((x - size + 3, y), 1.6)):
                rings.append((at, radius))
                entities.append(circle(*at, radius))
        draw.shuffle(entities)
        places = self.places("profile", entities)[1:]
        self.assertEqual(len(rings), len(places))
        when = {}
        for k, cut in enumerate(self.cuts):
            # beside its ring by the tool's radius
            ring = min(rings, key=lambda r: abs(abs(numpy.median(numpy.hypot(*(numpy.array(cut) - r[0]).T)) - r[1]) - 1.5))
            when[ring] = k
        self.assertEqual(len(rings), len(when))
        for inner, k in when.items():
            for outer, later in when.items():
                if outer[1] > inner[1] and numpy.hypot(*numpy.subtract(inner[0], outer[0])) < outer[1]:
                    self.assertLess(k, later, f"seed {seed}: {inner} in {outer}")

    def test_parts_of_a_sheet_are_cut_on_nearly_the_shortest_way(self):
        seed = 543
        draw = random.Random(seed)
        cells = [(i, j) for i in range(9) for j in range(9)]
        draw.shuffle(cells)
        entities = []
        for i, j in cells:
            x, y, a, b = 40 * i + 20, 40 * j + 20, draw.uniform(8, 14), draw.uniform(8, 14)
            entities.append(f"0\nLWPOLYLINE\n8\nl\n90\n4\n70\n1\n" + "".join(
                f"10\n{x + dx:.4f}\n20\n{y + dy:.4f}\n" for dx, dy in ((-a, -b), (a, -b), (a, b), (-a, b))))
            entities += [circle(x - 4, y, 2.5), circle(x + 4, y, 2.5)]
        places = self.places("profile", entities)
        self.assertEqual(len(entities) + 1, len(places))
        way = numpy.hypot(*numpy.diff(places, axis=0).T).sum()
        rapid = json.loads((self.folder / "p.json").read_text())["rapid_length_mm"]
        # the bound knows nothing of the order that holes need
        self.assertLess(rapid / (rapid - way + least_way(places, way)), 1.1, f"seed {seed}")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]], verbosity=2)
