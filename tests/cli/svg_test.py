#!/usr/bin/env python3
"""SVG drawings: what is engraved is what the drawing shows, sampled by formulas of its own; units, layers, `use`; refusals.

The random paths are made as points and written as path data in every form, so that nothing here reads SVG.

usage: svg_test.py CUSP [COUNT [FIRST SEED]]
"""
import json
import math
import random
import sys
import unittest

from cusp_case import CuspCase
from program_cuts import away, cuts

COUNT, FIRST = (int(sys.argv[k]) if len(sys.argv) > k else otherwise for k, otherwise in ((2, 12), (3, 1)))
TOLERANCE = 0.01
JOB = f"""
units = "mm"
[tool]
shape = "vee"
diameter = 6
tip_angle = 60
[cutting]
feed = 1000
plunge_feed = 300
[stock]
top = 0
[[operation]]
strategy = "engrave"
boundary = "{{boundary}}"
depth = 0.5
plan_tolerance = {TOLERANCE}
"""
POCKET = JOB.replace('"vee"', '"flat"').replace("tip_angle = 60", "").replace('"engrave"', '"pocket"')


def svg(body, attributes='width="100mm" height="80mm" viewBox="0 0 100 80"'):
    return f'<?xml version="1.0"?>\n<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" ' \
           f'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" {attributes}>\n{body}\n</svg>\n'


def bezier(points, t):
    while len(points) > 1:
        points = [((1 - t) * a[0] + t * b[0], (1 - t) * a[1] + t * b[1]) for a, b in zip(points, points[1:])]
    return points[0]


def arc(a, rx, ry, turn, large, sweep, b, t):
    """The point at a share of an elliptic arc, by the appendix of the standard."""
    turn = math.radians(turn)
    c, s = math.cos(turn), math.sin(turn)
    x, y = c * (a[0] - b[0]) / 2 + s * (a[1] - b[1]) / 2, c * (a[1] - b[1]) / 2 - s * (a[0] - b[0]) / 2
    grow = math.sqrt(max(1, (x / rx) ** 2 + (y / ry) ** 2))
    rx, ry = grow * rx, grow * ry
    k = math.sqrt(max(0, (rx * ry) ** 2 - (rx * y) ** 2 - (ry * x) ** 2) / ((rx * y) ** 2 + (ry * x) ** 2))
    k = -k if large == sweep else k
    u, v = k * rx * y / ry, -k * ry * x / rx
    centre = c * u - s * v + (a[0] + b[0]) / 2, s * u + c * v + (a[1] + b[1]) / 2
    begin, end = math.atan2((y - v) / ry, (x - u) / rx), math.atan2((-y - v) / ry, (-x - u) / rx)
    way = (end - begin) % (2 * math.pi) - (0 if sweep else 2 * math.pi)
    w = begin + t * way
    return centre[0] + rx * math.cos(w) * c - ry * math.sin(w) * s, centre[1] + rx * math.cos(w) * s + ry * math.sin(w) * c


def random_path(rnd):
    """Path data, and points along it, closely."""
    at = (round(rnd.uniform(20, 80), 2), round(rnd.uniform(20, 60), 2))
    data, drawn, control, kind_before = [("M", at)], [], None, ""
    start, here = at, (0.0, 0.0)
    text = f"M{at[0]} {at[1]}"
    for _ in range(rnd.randint(2, 7)):
        a, kind, relative = at, rnd.choice("LHVCSQTAZ"), rnd.random() < 0.5
        there = [(round(rnd.uniform(5, 95), 2), round(rnd.uniform(5, 75), 2)) for _ in range(3)]
        values = []
        if kind == "Z":
            drawn += [bezier([a, start], t / 8) for t in range(9)]
            text, at, kind_before = text + rnd.choice("zZ"), start, ""
            continue
        if kind == "H":
            b, values = (there[0][0], a[1]), [there[0][0] - (a[0] if relative else 0)]
        elif kind == "V":
            b, values = (a[0], there[0][1]), [there[0][1] - (a[1] if relative else 0)]
        else:
            count = {"L": 1, "C": 3, "S": 2, "Q": 2, "T": 1, "A": 1}[kind]
            points = there[:count]
            b = points[-1]
            if kind == "A":
                shape = (round(rnd.uniform(1, 40), 1), round(rnd.uniform(1, 40), 1), rnd.choice([0, 30, -75]), rnd.randint(0, 1),
                         rnd.randint(0, 1))
                values = list(shape)
            values += [v - (o if relative else 0) for p in points for v, o in zip(p, a)]
            mirrored = (2 * a[0] - control[0], 2 * a[1] - control[1]) if control and kind_before == {"S": "C", "T": "Q"}.get(kind) else a
            net = {"L": [a, *points], "C": [a, *points], "S": [a, mirrored, *points], "Q": [a, *points],
                   "T": [a, mirrored, *points], "A": []}[kind]
            if kind in "CSQT":
                control = net[-2]
            drawn += [arc(a, *shape, b, t / 120) if kind == "A" else bezier(net, t / 120) for t in range(121)]
        if kind in "HV":
            drawn += [a, b]
        kind_before = {"S": "C", "T": "Q"}.get(kind, kind)
        words = [f"{v:.4f}".rstrip("0").rstrip(".") for v in values]
        if kind == "A" and rnd.random() < 0.5:  # flags need nothing between them
            words[3:6] = [words[3] + words[4] + words[5]]
        joined = words[0] + "".join((rnd.choice([",", " "]) if not w.startswith("-") or rnd.random() < 0.5 else "") + w for w in words[1:])
        text, at = text + (kind.lower() if relative else kind) + joined, b
    return text, drawn


def random_transform(rnd):
    """The attribute, and what it does."""
    steps = []
    for _ in range(rnd.randint(0, 3)):
        a, b = round(rnd.uniform(-20, 20), 1), round(rnd.uniform(0.5, 1.5), 2)
        c, s, k = math.cos(math.radians(a)), math.sin(math.radians(a)), math.tan(math.radians(a))
        steps.append(rnd.choice([
            (f"translate({a},{b})", lambda p, a=a, b=b: (p[0] + a, p[1] + b)), (f"scale({b})", lambda p, b=b: (b * p[0], b * p[1])),
            (f"scale({-b} 1)", lambda p, b=b: (-b * p[0], p[1])), (f"skewX({a})", lambda p, k=k: (p[0] + k * p[1], p[1])),
            (f"rotate({a} 10 20)", lambda p, c=c, s=s: (10 + c * (p[0] - 10) - s * (p[1] - 20), 20 + s * (p[0] - 10) + c * (p[1] - 20))),
            (f"matrix(1 0.2 -0.3 {b} {a} 0)", lambda p, a=a, b=b: (p[0] - 0.3 * p[1] + a, 0.2 * p[0] + b * p[1]))]))

    def apply(p):
        for _, step in reversed(steps):
            p = step(p)
        return p
    return " ".join(text for text, _ in steps), apply


class Svg(CuspCase):
    def engraved(self, drawing, layer=""):
        self.write("d.svg", drawing)
        self.write("j.toml", JOB.format(boundary="d.svg" + layer))
        self.said = self.cusp(0, "plan", "j.toml", "-o", "p.ngc")
        return cuts((self.folder / "p.ngc").read_text())

    def agree(self, drawing, points, layer="", bound=2 * TOLERANCE):
        found = self.engraved(drawing, layer)
        pieces = list(zip(points, points[1:]))
        self.assertLess(max(away(p, found) for p in points), bound)
        return found, pieces

    def refused(self, drawing, *words, layer=""):
        self.write("d.svg", drawing)
        self.write("j.toml", JOB.format(boundary="d.svg" + layer))
        said = self.cusp(2, "plan", "j.toml", "-o", "p.ngc")
        for word in words:
            self.assertIn(word, said)

    def test_random_paths(self):
        for seed in range(FIRST, FIRST + COUNT):
            with self.subTest(seed=seed):
                rnd = random.Random(seed)
                data, drawn = random_path(rnd)
                transform, apply = random_transform(rnd)
                outer, place = random_transform(rnd)
                points = [place(apply(p)) for p in drawn]
                points = [(0.5 * x, 40 - 0.5 * y) for x, y in points]  # 100 units on 50 mm, y upwards
                found, _ = self.agree(svg(f'<g transform="{outer}"><path transform="{transform}" d="{data}"/></g>',
                                          'width="5cm" height="40mm" viewBox="0 0 100 80"'), points)
                # and no more: the cut's own corners lie on the drawing
                close = [(a, b) for a, b in zip(points, points[1:])]
                for a, _b in found:
                    self.assertLess(away(a, close), 0.05, f"seed {seed}")

    def test_shapes(self):
        circle = [(30 + 12 * math.cos(a / 50), 60 - 12 * math.sin(a / 50)) for a in range(315)]
        self.agree(svg('<circle cx="30" cy="20" r="12"/>'), circle)
        self.agree(svg('<svg:circle cx="30" cy="20" r="12"/>'), circle)
        self.agree(svg('<ellipse cx="30" cy="20" rx="12" ry="6"/>'), [(x, 60 + (y - 60) / 2) for x, y in circle])
        self.agree(svg('<rect x="10" y="5" width="40" height="30"/>'), [(10, 75), (50, 75), (50, 45), (10, 45)])
        found = self.engraved(svg('<rect x="10" y="5" width="40" height="30" rx="5"/>'))
        self.assertGreater(away((10, 75), found), 2)
        self.assertLess(away((10 + 5 * (1 - math.sqrt(0.5)), 75 - 5 * (1 - math.sqrt(0.5))), found), 0.02)
        self.agree(svg('<line x1="1cm" y1="10" x2="60%" y2="10"/>', 'width="96px" height="96px"'),
                   [(10, 25.4 - 10 * 25.4 / 96), (0.6 * 25.4, 25.4 - 10 * 25.4 / 96)])
        self.agree(svg('<polyline points="10,10 20-5,30 7"/>'.replace("20-5", "20 5"), ""), [(10 * 25.4 / 96, -10 * 25.4 / 96)])
        self.assertIn("1 unit of the drawing is 0.264583 mm, 96 an inch", self.said)
        self.agree(svg('<polygon points="10 10 50 10 50 50"/>'), [(10, 70), (50, 70), (50, 30), (30, 50)])

    def test_where_the_page_puts_it(self):
        line = '<line x1="0" y1="0" x2="10" y2="0"/>'
        for attributes, begin, end in (
                ('width="100mm" height="50mm" viewBox="0 0 10 10"', (25, 50), (75, 50)),
                ('width="100mm" height="50mm" viewBox="0 0 10 10" preserveAspectRatio="xMaxYMin"', (50, 50), (100, 50)),
                ('width="100mm" height="50mm" viewBox="0 0 10 10" preserveAspectRatio="none"', (0, 50), (100, 50)),
                ('width="100mm" viewBox="0 -5 10 10"', (0, 50), (100, 50)), ('width="2in" height="1in" viewBox="-5 0 20 10"', (12.7, 25.4), (38.1, 25.4))):
            found = self.engraved(svg(line, attributes))
            self.assertLess(max(away(begin, found), away(end, found)), 0.02, attributes)
            self.assertAlmostEqual(sum(math.dist(*piece) for piece in found), math.dist(begin, end), delta=0.05)

    def test_use_and_symbols(self):
        body = ('<defs><g id="part"><line x1="0" y1="0" x2="5" y2="0"/></g></defs>'
                '<symbol id="s" viewBox="0 0 10 10"><line x1="0" y1="10" x2="10" y2="10"/></symbol>'
                '<use href="#part" x="10" y="10"/><use xlink:href="#part" x="20" y="20" transform="rotate(90)"/>'
                '<use href="#s" x="40" y="40" width="20" height="20"/>')
        found = self.engraved(svg(body))
        self.assertAlmostEqual(sum(math.dist(*piece) for piece in found), 5 + 5 + 20, delta=0.05)
        for place in ((12, 70), (-20, 80 - 22), (50, 20)):
            self.assertLess(away(place, found), 0.02, place)

    def test_layers(self):
        body = ('<g inkscape:groupmode="layer" inkscape:label="cut" id="layer1"><rect x="10" y="10" width="20" height="20"/>'
                '<g id="inner"><circle id="hole" cx="20" cy="20" r="3"/></g></g><g style="display : none"><line x2="5"/></g>'
                '<text x="50" y="50">words</text><image/>')
        drawing = svg(body)
        length = lambda layer: sum(math.dist(*piece) for piece in self.engraved(drawing, layer))
        self.assertAlmostEqual(length(""), 80 + 6 * math.pi, delta=0.1)
        self.assertIn("a text at x 50 y 30 mm is not cut", self.said)
        self.assertIn("left out, since they draw no curve: 1 image", self.said)
        self.assertAlmostEqual(length("#cut"), 80 + 6 * math.pi, delta=0.1)
        self.assertAlmostEqual(length("#layer1"), 80 + 6 * math.pi, delta=0.1)
        self.assertAlmostEqual(length("#inner"), 6 * math.pi, delta=0.1)
        self.assertAlmostEqual(length("#hole"), 6 * math.pi, delta=0.1)
        self.refused(drawing, 'no curve on the layer "cutt"', '"cut"', layer="#cutt")
        self.cusp(0, "info", "d.svg", "--stats", "i.json")
        part = json.loads((self.folder / "i.json").read_text())["files"][0]
        self.assertEqual("SVG", part["format"])
        self.assertEqual({"cut": 2}, {layer["name"]: len(layer["loops"]) for layer in part["layers"] if not layer["hidden"]})

    def test_it_is_cut_as_a_dxf_is(self):
        """A pocket with an island, holes to drill, letters of curves."""
        self.write("d.svg", svg('<rect x="10" y="10" width="60" height="50"/><circle cx="40" cy="35" r="10"/>'))
        self.write("j.toml", POCKET.format(boundary="d.svg"))
        self.cusp(0, "plan", "j.toml", "-o", "p.ngc")
        self.cusp(0, "verify", "j.toml", "p.ngc", "--stats", "v.json")
        self.assertAlmostEqual(json.loads((self.folder / "v.json").read_text())["removed_mm3"], 0.5 * (3000 - 100 * math.pi), delta=8)
        self.write("j.toml", JOB.replace('"vee"', '"drill"').replace("tip_angle = 60", "").replace('"engrave"', '"drill"')
                   .replace(f"plan_tolerance = {TOLERANCE}", "").format(boundary="d.svg").replace("diameter = 6", "diameter = 20"))
        self.cusp(0, "plan", "j.toml", "-o", "p.ngc")
        self.assertIn("X40", (self.folder / "p.ngc").read_text())

    def test_refusals(self):
        self.refused("<svg><path", "d.svg:1: no SVG drawing")
        self.refused("<html/>", "it begins with <html>")
        self.refused("", "no SVG drawing")
        self.refused(svg(""), "the drawing holds no curve")
        self.refused(svg("<text>a</text>"), "convert text to curves")
        self.refused(svg('<path d="M0 0\nL10 x"/>'), "d.svg:3: path data, character 10", "a number is needed")
        self.refused(svg('<path d="L10 10"/>'), "it begins with a move")
        self.refused(svg('<path d="M0 0 B1 1"/>'), '"B" is no command')
        self.refused(svg('<path d="M0 0 A5 5 0 2 0 1 1"/>'), "a flag of an arc is 0 or 1")
        self.refused(svg('<path d="M0 0 L1 1e999"/>'), "a number is needed")
        self.refused(svg('<rect width="5parsec" height="2"/>'), "d.svg:3: width", '"5parsec" is no length')
        self.refused(svg('<g transform="rotate(1 2)"><line x2="5"/></g>'), 'transform: "rotate(1 2)"')
        self.refused(svg('<use href="#nothing"/>'), '"#nothing" is no object')
        self.refused(svg('<g id="a"><use href="#a"/><line x2="3"/></g>'), "more than 16 deep")
        self.refused(svg('<line x2="5"/>', 'viewBox="0 0 0 5"'), "viewBox")
        self.refused(svg('<line x2="1e12"/>'), "d.svg:3")
        many = "".join(f'<g id="g{k}">' + f'<use href="#g{k + 1}"/>' * 9 + "</g>" for k in range(12)) + '<line id="g12" x2="1"/>'
        self.refused(svg(f"<defs>{many}</defs>" + '<use href="#g0"/>'), "more than 500000 elements")
        self.refused(svg(f'<defs>{many.replace("line", "g")}</defs>' + '<use href="#g0"/>'), "more than 500000 elements")
        self.refused(svg("<g>" * 100000 + "</g>" * 100000), "elements more than 256 deep")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
