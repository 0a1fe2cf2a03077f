#!/usr/bin/env python3
"""Shares of the time: cutting, air and rapid moves add up, air is what an oracle finds; air and doubled length are bounded over random jobs.

usage: wasted_motion_test.py CUSP
"""
import json
import math
import random
import re
import sys
import unittest

from cusp_case import CuspCase, property_cases

STEP = 0.25  # mm, between the positions of the oracle
MOST_AIR = 0.25  # of the time at feed
MOST_DOUBLED = 0.25  # of the length at feed
HEAD = """units = "mm"
[[tool]]
shape = "flat"
diameter = 6
[[tool]]
shape = "drill"
diameter = 5
[cutting]
feed = 900
plunge_feed = 300
[stock]
top = 0
bottom = -12
x = [0, 120]
y = [0, 90]
"""


def rectangle(x, y, width, height, layer):
    corners = ((x, y), (x + width, y), (x + width, y + height), (x, y + height))
    return f"0\nLWPOLYLINE\n8\n{layer}\n90\n4\n70\n1\n" + "".join(f"10\n{a}\n20\n{b}\n" for a, b in corners)


def circle(x, y, diameter, layer):
    return f"0\nCIRCLE\n8\n{layer}\n10\n{x}\n20\n{y}\n40\n{diameter / 2}\n"


def feed_positions(text):
    """(x, y, z, length) along the feed moves, by straight moves and chords of arcs."""
    at, motion = [0.0, 0.0, 5.0], 0
    for line in text.splitlines():
        line = re.sub(r"\(.*?\)", "", line)
        words = dict((word, float(value)) for word, value in re.findall(r"([A-Z])(-?[0-9.]+)", line))
        found = re.findall(r"G0*([0-3])(?![0-9.])", line)
        motion = int(found[-1]) if found else motion
        to = [words.get(axis, at[k]) for k, axis in enumerate("XYZ")]
        if "I" in words or "J" in words:
            centre = at[0] + words.get("I", 0), at[1] + words.get("J", 0)
            start = math.atan2(at[1] - centre[1], at[0] - centre[0])
            turn = math.atan2(to[1] - centre[1], to[0] - centre[0]) - start
            turn = (turn % (2 * math.pi) or 2 * math.pi) if motion == 3 else -(-turn % (2 * math.pi) or 2 * math.pi)
            radius = math.hypot(at[0] - centre[0], at[1] - centre[1])
            length = math.hypot(radius * turn, to[2] - at[2])

            def place(share, centre=centre, radius=radius, start=start, turn=turn, low=at[2], high=to[2]):
                return (centre[0] + radius * math.cos(start + turn * share), centre[1] + radius * math.sin(start + turn * share),
                        low + (high - low) * share)
        else:
            length = math.dist(at, to)

            def place(share, a=tuple(at), b=tuple(to)):
                return tuple(p + (q - p) * share for p, q in zip(a, b))
        if motion > 0 and length > 0:
            count = max(1, round(length / STEP))
            for k in range(count):
                yield (*place((k + 0.5) / count), length / count)
        at = to


class WastedMotion(CuspCase):
    def random_job(self, draw):
        """A job of one to three operations apart from each other, and their names."""
        kinds = draw.sample(("pocket", "adaptive", "bores", "holes", "profile", "slot"), draw.randint(1, 3))
        shapes, operations = [], ""
        for place, kind in enumerate(kinds):
            x, y = 5 + 38 * place, draw.uniform(8, 20)
            layer = f"l{place}"
            depth = round(draw.uniform(1.5, 9), 2)
            keys = f'boundary = "part.dxf#{layer}"\ndepth = {depth}\n'
            if kind in ("pocket", "adaptive", "profile"):
                shapes.append(rectangle(x + 3, y, draw.uniform(14, 26), draw.uniform(14, 50), layer))
            elif kind == "slot":
                shapes.append(f"0\nLINE\n8\n{layer}\n10\n{x + 8}\n20\n{y}\n11\n{x + 20}\n21\n{y + draw.uniform(5, 40)}\n")
            else:
                size = 5 if kind == "holes" else draw.uniform(6.5, 14)
                shapes += [circle(x + 10, y + 18 * k, size, layer) for k in range(draw.randint(1, 3))]
            strategy = {"adaptive": "pocket", "bores": "bore", "holes": "drill"}.get(kind, kind)
            more = {"adaptive": 'clearing = "adaptive"\n', "holes": "tool = 2\n", "bores": ""}.get(kind, f"max_depth = {draw.choice((2, 3, 6))}\n")
            operations += f'[[operation]]\nstrategy = "{strategy}"\n{keys}{more}' + ("" if kind == "holes" else 'output = "arcs"\n')
        self.write("part.dxf", "0\nSECTION\n2\nENTITIES\n" + "".join(shapes) + "0\nENDSEC\n0\nEOF\n")
        self.write("job.toml", HEAD + operations)
        return kinds

    def stats(self):
        return json.loads((self.folder / "p.json").read_text())

    def test_air_and_doubled_length_are_bounded_over_random_jobs(self):
        count = property_cases(12)
        for seed in range(count):
            draw = random.Random(seed)
            kinds = self.random_job(draw)
            said = self.cusp(0, "plan", "job.toml", "-o", "p.ngc", "--stats", "p.json")
            stats, text = self.stats(), (self.folder / "p.ngc").read_text()
            with self.subTest(seed=seed, kinds=kinds):
                for figures in (stats, *stats["operations"]):
                    self.assertAlmostEqual(figures["estimated_s"], sum(figures[key] for key in ("cutting_s", "air_s", "rapid_s")), places=6)
                    self.assertGreaterEqual(min(figures[key] for key in ("cutting_s", "air_s", "rapid_s")), 0)
                share = re.search(r"about \d+ s \(cutting (\d+) %, air (\d+) %, rapid (\d+) %\)", said)
                self.assertAlmostEqual(int(share[2]) / 100, stats["air_s"] / stats["estimated_s"], delta=0.006)
                seen, doubled, whole, over = {}, 0, 0, 0
                for k, (x, y, z, length) in enumerate(feed_positions(text)):
                    whole += length
                    over += length if z > 0 else 0
                    place = round(x / STEP), round(y / STEP), round(z / STEP)
                    doubled += length if k - seen.get(place, k) > 4 else 0
                    seen[place] = k
                feed_s = stats["estimated_s"] - stats["rapid_s"]
                found = [stats["air_s"] / feed_s, doubled / whole, over / whole]
                if "--show" in sys.argv:
                    print(seed, kinds, [round(value, 3) for value in found])
                self.assertLess(stats["air_s"] / feed_s, MOST_AIR)
                self.assertLess(doubled / whole, MOST_DOUBLED)

    def test_air_is_found(self):
        """A face 3 mm over the stock is all air; one at half of its height none."""
        job = HEAD + '[[operation]]\nstrategy = "face"\ndepth = {depth}\ntop = {top}\n'
        for top, depth, low, high in ((4, 1, 0.95, 1.0), (0, 1, 0.0, 0.35)):
            self.write("job.toml", job.format(top=top, depth=depth).replace("top = 0\nbottom", "top = 0\nclearance = 8\nbottom"))
            self.cusp(0, "plan", "job.toml", "-o", "p.ngc", "--stats", "p.json")
            stats = self.stats()
            share = stats["air_s"] / (stats["air_s"] + stats["cutting_s"])
            self.assertGreaterEqual(share, low)
            self.assertLessEqual(share, high)

    def test_what_was_cut_before_is_air(self):
        """The same pocket twice: the second is air."""
        self.write("part.dxf", "0\nSECTION\n2\nENTITIES\n" + rectangle(20, 20, 40, 30, "a") + "0\nENDSEC\n0\nEOF\n")
        pocket = '[[operation]]\nstrategy = "pocket"\nboundary = "part.dxf#a"\ndepth = 4\nmax_depth = 2\n'
        self.write("job.toml", HEAD + pocket + pocket)
        self.cusp(0, "plan", "job.toml", "-o", "p.ngc", "--stats", "p.json")
        operations = self.stats()["operations"]
        first, second = operations[:len(operations) // 2], operations[len(operations) // 2:]
        self.assertLess(sum(one["air_s"] for one in first), 0.1 * sum(one["cutting_s"] for one in first))
        self.assertEqual(0, sum(one["cutting_s"] for one in second))

    def test_a_floor_that_roughing_has_cut_is_not_finished_in_air(self):
        points = [[0, 0, -3], [0, 20, -3], [30, 0, -3], [30, 20, -3]]
        self.write("level.json", json.dumps({"shape": {"type": "surface", "count": 1, "data": [{
            "rational": False, "degree_u": 1, "degree_v": 1, "size_u": 2, "size_v": 2, "knotvector_u": [0, 0, 1, 1],
            "knotvector_v": [0, 0, 1, 1], "control_points": {"points": points}}]}}))
        self.write("job.toml", '[[tool]]\nshape = "ball"\ndiameter = 4\n[[tool]]\nshape = "flat"\ndiameter = 8\n[cutting]\n'
                   'feed = 1000\n[stock]\ntop = 0\nbottom = -8\nx = [-5, 35]\ny = [-5, 25]\n[[operation]]\n'
                   'strategy = "adaptive_isocurve"\nfloor = ["level.json"]\nscallop = 0.1\ntool = 1\nroughing = true\ntools = [2]\n')
        said = self.cusp(0, "plan", "job.toml", "-o", "p.ngc", "--stats", "p.json")
        self.assertRegex(said, r"scallop at most 0\.09")
        self.assertLess(self.stats()["air_s"], 0.05 * self.stats()["cutting_s"])
        self.assertNotIn("tool 1 ball", (self.folder / "p.ngc").read_text())
        self.cusp(0, "verify", "job.toml", "p.ngc")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
