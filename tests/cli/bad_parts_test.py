#!/usr/bin/env python3
"""Invalid parts: cusp plan ends with status 2 and names file, quantity and value; it never crashes or hangs.

usage: bad_parts_test.py CUSP [--without-cad]
"""
import copy
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

CUSP = str(pathlib.Path(sys.argv[1]).resolve())
CAD = "--without-cad" not in sys.argv
SECONDS = 240  # on a busy machine under a sanitizer; none takes one second

JOB = """
units = "mm"
[tool]
shape = "ball"
diameter = 4
[cutting]
feed = 1000
[stock]
top = 20
[[operation]]
strategy = "adaptive_isocurve"
floor = "FLOOR"
scallop = 0.2
"""
POCKET = """
units = "mm"
[tool]
shape = "ball"
diameter = 4
[cutting]
feed = 1000
[[operation]]
strategy = "contour_pocket"
floor = "floor.json"
boundary = "edge.dxf"
scallop = 0.2
"""
FLOOR = {"degree_u": 2, "degree_v": 1, "size_u": 4, "size_v": 2,
         "knotvector_u": [0, 0, 0, 0.5, 1, 1, 1], "knotvector_v": [0, 0, 1, 1],
         "control_points": {"points": [[0, 0, 0], [0, 20, 0], [10, 0, 4], [10, 20, 4],
                                       [20, 0, 4], [20, 20, 4], [30, 0, 0], [30, 20, 0]],
                            "weights": [1] * 8}}


def loop(*corners, closed=True):
    corners = [list(c) for c in corners + (corners[:1] if closed else ())]
    return {"type": "spline", "reversed": 0, "degree": 1,
            "knotvector": [0, *range(len(corners)), len(corners) - 1],
            "control_points": {"points": corners}}


def trims(*loops):
    return {"trims": {"count": len(loops), "data": list(loops)}}


def surface(change):
    shape = copy.deepcopy(FLOOR)
    for key, value in change.items():
        target = shape["control_points"] if key in ("points", "weights") else shape
        target[key] = value
    return json.dumps({"shape": {"type": "surface", "count": 1, "data": [shape]}})


def with_point(value):
    points = copy.deepcopy(FLOOR["control_points"]["points"])
    points[3] = value
    return {"points": points}


def with_weight(value):
    return {"weights": [1, 1, 1, value, 1, 1, 1, 1]}


OUTER = loop((.1, .1), (.9, .1), (.9, .9), (.1, .9))
HOLE = loop((.3, .3), (.3, .6), (.6, .6), (.6, .3))
# what changes in the floor, words of the message
SURFACES = (
    ({"knotvector_u": [0, 0, 0, 0.5, 0.4, 1, 1]}, "knotvector_u[4] is 0.4, below the 0.5"),
    ({"knotvector_u": [0, 0, 0, 1, 1, 1]}, "knotvector_u holds 6 numbers"),
    ({"knotvector_u": [0, 0, 0, 0.5, 1, 1, 1, 1]}, "knotvector_u holds 8 numbers"),
    ({"knotvector_u": [0, 0, 0, 0, 0, 0, 0]}, "knotvector_u leaves no domain"),
    ({"knotvector_u": []}, "knotvector_u holds 0 numbers"),
    ({"degree_u": 1, "size_u": 4, "knotvector_u": [0, 0, 0.5, 0.5, 1, 1]}, "holds 0.5 2 times"),
    ({"knotvector_v": [0, 0, float("nan"), 1]}, "not JSON"),
    ({"degree_u": 0}, "degree_u is 0"),
    ({"degree_u": 4}, "needs at least 5"),
    ({"degree_u": 99}, "degree_u is 99"),
    ({"degree_u": 2.5}, "degree_u is 2.5"),
    ({"size_u": 3}, "8 control points, size_u x size_v = 3 x 2"),
    ({"size_u": -4, "size_v": -2}, "size_u is -4"),
    ({"size_u": 1e30}, "size_u is 1e+30"),
    (with_weight(0), "weight 3 is 0, it must be above 0"),
    (with_weight(-1), "weight 3 is -1, it must be above 0"),
    ({"weights": [1, 1]}, "2 weights for 8 control points"),
    (with_weight("one"), "is not a number"),
    (with_weight(1e-300), "weight 3 is 1e-300, weight 7 is 1: the larger may be 1000 times"),
    (with_weight(1e6), "weight 3 is 1000000: the larger may be 1000 times"),
    ({"knotvector_u": [0, 0, 0, 1e-300, 1, 1, 1]}, "knotvector_u holds 0 4 times"),
    ({"knotvector_u": [0, 0, 0, 5e299, 1e300, 1e300, 1e300]}, "knotvector_u is 1e+300 long"),
    ({"points": [[x, 10, z] for x in (0, 10, 20, 30) for z in (0, 10)]}, "every surface is vertical"),
    (with_point([1e300, 0, 0]), "control point 3 has x = 1e+300 mm, the limit is"),
    (with_point([0, float("inf"), 0]), "not JSON"),
    (with_point([0, 0, None]), "is not a number"),
    (with_point([0]), "control point 3 has not 2 or 3 coordinates"),
    (with_point([0, 0]), "control point 3 has 2 coordinates, control point 0 has 3"),
    (with_point([]), "control point 3 has not 2 or 3 coordinates"),
    ({"points": []}, "0 control points"),
    ({"points": [[5, 5, 5]] * 8}, "no area"),
    ({"points": [[k, k, 0] for k in range(8)]}, "no area"),
    (trims(loop((.1, .1), (.9, .1), (.9, .9), (.1, .9), closed=False)), "open"),
    (trims(loop((.1, .1), (.9, .9), (.9, .1), (.1, .9))), "cross"),
    (trims(loop((.1, .1), (1.9, .1), (.9, .9))), "leaves the domain at u 1.9"),
    (trims(OUTER, loop((.3, .3), (.6, .3), (.6, .6), (.3, .6))), "a hole runs clockwise"),
    (trims(OUTER, loop((.95, .3), (.95, .6), (.99, .6))), "outside every outer loop"),
    (trims(OUTER, HOLE, loop((.4, .4), (.4, .5), (.5, .5))), "a hole inside a hole"),
    (trims(OUTER, loop((.8, .3), (.8, .6), (.95, .6))), "cross"),
    (trims(OUTER, OUTER), "trim loops 1 and 2 are the same"),
    (trims(loop((.5, .5), (.5, .5), (.5, .5))), "no length"),
    (trims(loop((.1, .1), (.9, .1))), "that is no area"),
    ({"trims": {"count": 2, "data": [OUTER]}}, "count is 2, data holds 1"),
    ({"trims": {"count": 1, "data": [{"type": "circle"}]}}, "circle"),
    ({"trims": {"count": 1, "data": "none"}}, "not a list"))

FACET = ("facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 30 0 0\nvertex 0 20 0\n"
         "endloop\nendfacet\n")


def binary_stl(facets, count=None, cut=0):
    body = b"".join(struct.pack("<12fH", 0, 0, 1, *(c for p in f for c in p), 0) for f in facets)
    data = b"\0" * 80 + struct.pack("<I", len(facets) if count is None else count) + body
    return data[:len(data) - cut]


TRIANGLE = ((0, 0, 0), (30, 0, 0), (0, 20, 0))
# name, content, words of the message
MESHES = (
    ("empty.stl", b"", "no STL"),
    ("named.stl", b"solid empty\nendsolid empty\n", "holds no facet"),
    ("none.stl", binary_stl([]), "holds no facet"),
    ("short.stl", binary_stl([TRIANGLE], cut=7), "truncated: 1 facets"),
    ("liar.stl", binary_stl([TRIANGLE], count=4000000000), "truncated: 4000000000 facets"),
    ("head.stl", b"\0" * 50, "no STL"),
    ("nan.stl", binary_stl([((0, 0, float("nan")), (30, 0, 0), (0, 20, 0))]), "z = nan"),
    ("far.stl", binary_stl([((0, 0, 1e30), (30, 0, 0), (0, 20, 0))]), "the limit is"),
    ("flat.stl", binary_stl([((0, 0, 0), (30, 0, 0), (60, 0, 0))]), "holds no facet"),
    ("wall.stl", binary_stl([((0, 0, 0), (30, 0, 0), (0, 0, 20))]), "0 mm in y"),
    ("cut.stl", ("solid s\n" + FACET[:60]).encode(), "cut.stl:"),
    ("word.stl", ("solid s\n" + FACET.replace("vertex 30", "vertex thirty") + "endsolid\n").encode(),
     "thirty"))

CAD_FILES = (
    ("empty.step", b"", "empty.step: "),
    ("noise.step", bytes(range(256)) * 20, "noise.step: "),
    ("head.step", b"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n",
     "head.step: "),
    ("point.step", b"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n"
     b"#1=CARTESIAN_POINT('',(0.,0.,0.));\nENDSEC;\nEND-ISO-10303-21;\n", "point.step: "),
    ("cut.step", b"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1=PLANE('',#2", "cut.step: "),
    ("empty.igs", b"", "empty.igs: "),
    ("noise.igs", bytes(range(256)) * 20, "noise.igs: "),
    ("start.igs", b"nothing" + b" " * 65 + b"S      1\n", "start.igs: "))


def dxf(*entities):
    pairs = ["0", "SECTION", "2", "ENTITIES"]
    for entity in entities:
        pairs += [str(word) for word in entity]
    return "\n".join(pairs + ["0", "ENDSEC", "0", "EOF", ""])


def line(x0, y0, x1, y1):
    return (0, "LINE", 8, 0, 10, x0, 20, y0, 11, x1, 21, y1)


SQUARE = (line(2, 2, 28, 2), line(28, 2, 28, 18), line(28, 18, 2, 18), line(2, 18, 2, 2))
DRAWINGS = (
    (dxf(*SQUARE[:3]), "the loop is open"),
    (dxf(SQUARE[0], SQUARE[2]), "the loop is open"),
    (dxf(), "edge.dxf"),
    ("", "edge.dxf"),
    ("no drawing at all\n", "edge.dxf"),
    (dxf(*SQUARE[:3], (0, "3DFACE", 8, 0)), "edge.dxf: the loop is open"),
    (dxf((0, "CIRCLE", 8, 0, 10, 15, 20, 10, 40, -3)), "edge.dxf"),
    (dxf((0, "CIRCLE", 8, 0, 10, 15, 20, 10, 40, "nan")), "edge.dxf"),
    (dxf((0, "CIRCLE", 8, 0, 10, 1e300, 20, 10, 40, 3)), "edge.dxf"),
    (dxf((0, "LINE", 8, 0, 10, 1, 20)), "edge.dxf"),
    (dxf(line(2, 2, 28, 18), line(28, 18, 28, 2), line(28, 2, 2, 18), line(2, 18, 2, 2)),
     "crosses itself"),
    (dxf((0, "SPLINE", 8, 0, 71, 3, 72, 2, 73, 1, 40, 0, 40, 1, 10, 1, 20, 1)), "edge.dxf"))


def curves(*ends):
    data = [{"degree": 1, "knotvector": [0, 0, 1, 1], "control_points": {"points": [list(a), list(b)]}} for a, b in ends]
    return json.dumps({"shape": {"type": "curve", "count": len(data), "data": data}})


def polygon(*corners):
    return curves(*zip(corners, corners[1:] + corners[:1]))


BOUNDARY = polygon((2, 2), (28, 2), (28, 18), (2, 18))
ISLAND = polygon((10, 8), (15, 8), (15, 12), (10, 12))
# boundary, islands, words of the message
POCKETS = (
    (curves(((2, 2), (28, 2)), ((28, 2), (28, 18)), ((28, 18), (2, 18))), (), "the loop is open"),
    (polygon((2, 2), (28, 18), (28, 2), (2, 18)), (), "crosses itself near x 15.000 y 10.000"),
    (polygon((2, 2), (2, 2), (28, 2), (28, 18), (2, 18)), (), "curve 1 has no length"),
    (curves(((2, 2), (28, 2)), ((28, 2), (28, 18)), ((28, 18), (2, 2)), ((2, 2), (2, 2))), (), "curve 4 has no length"),
    (polygon((2, 2), (28, 2), (2, 2), (2, 18)), (), "no area"),
    (polygon((2, 2), (38, 2), (38, 18), (2, 18)), (), "does not cover the pocket at"),
    (polygon((2, 2), (5, 2), (5, 5), (2, 5)), (), "tool 1 of 4 mm fits nowhere"),
    (BOUNDARY, (polygon((20, 8), (35, 8), (35, 12), (20, 12)),), "crosses island0.json at (28, 8)"),
    (BOUNDARY, (polygon((40, 8), (45, 8), (45, 12), (40, 12)),), "lies outside the boundary"),
    (BOUNDARY, (BOUNDARY,), "lies outside the boundary"),
    (BOUNDARY, (ISLAND, polygon((13, 9), (18, 9), (18, 11), (13, 11))), "crosses island1.json at (15, 9)"),
    (BOUNDARY, (ISLAND, polygon((11, 9), (12, 9), (12, 10), (11, 10))), "lies inside another"),
    (BOUNDARY, (ISLAND, ISLAND), "lies inside another"),
    (BOUNDARY, (curves(((10, 8), (15, 8)), ((15, 8), (15, 12))),), "island0.json: the loop is open"),
    (BOUNDARY, (polygon((10, 8), (15, 12), (15, 8), (10, 12)),), "island0.json: the loop crosses itself"),
    (BOUNDARY, (polygon((3, 3), (27, 3), (27, 17), (3, 17)),), "fits nowhere"))
NUMBERS = ("0", "-1", "nan", "inf", "-inf", "1e9", "1e-12", '"x"', "true")


class BadParts(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.scratch.name)

    def tearDown(self):
        self.scratch.cleanup()

    def plan(self, job, *options):
        (self.folder / "job.toml").write_text(job)
        return subprocess.run([CUSP, "plan", "job.toml", "-o", "p.ngc", *options], cwd=self.folder,
                              text=True, timeout=SECONDS, errors="replace",
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def refused(self, job, words):
        (self.folder / "p.ngc").unlink(missing_ok=True)
        result = self.plan(job)
        with self.subTest(words=words):
            self.assertEqual(2, result.returncode, result.stdout)
            self.assertIn(words, result.stdout)
            self.assertFalse((self.folder / "p.ngc").exists())

    def refused_file(self, name, content, words):
        (self.folder / name).write_bytes(content)
        job = JOB.replace("FLOOR", name)
        result = self.plan(job)
        with self.subTest(name=name):
            self.assertEqual(2, result.returncode, result.stdout)
            self.assertIn(name, result.stdout)
            self.assertIn(words, result.stdout)

    def test_the_floor_itself_is_planned(self):
        (self.folder / "floor.json").write_text(surface({}))
        self.assertEqual(0, self.plan(JOB.replace("FLOOR", "floor.json")).returncode)

    def test_surfaces_and_trims(self):
        for change, words in SURFACES:
            (self.folder / "floor.json").write_text(surface(change))
            self.refused(JOB.replace("FLOOR", "floor.json"), words)

    def test_meshes(self):
        for name, content, words in MESHES:
            self.refused_file(name, content, words)

    @unittest.skipUnless(CAD, "built without Open CASCADE")
    def test_cad_files(self):
        for name, content, words in CAD_FILES:
            self.refused_file(name, content, words)

    def test_drawings(self):
        (self.folder / "floor.json").write_text(surface({}))
        for text, words in DRAWINGS:
            (self.folder / "edge.dxf").write_text(text)
            self.refused(POCKET, words)

    def test_pockets(self):
        (self.folder / "floor.json").write_text(surface({}))
        for boundary, islands, words in POCKETS:
            (self.folder / "edge.json").write_text(boundary)
            names = [f"island{k}.json" for k in range(len(islands))]
            for name, island in zip(names, islands):
                (self.folder / name).write_text(island)
            self.refused(POCKET.replace("edge.dxf", "edge.json") + f"islands = {json.dumps(names)}\n", words)

    def test_bounds_that_are_none(self):
        (self.folder / "floor.json").write_text(surface({}))
        (self.folder / "edge.json").write_text(BOUNDARY)
        pocket = POCKET.replace("edge.dxf", "edge.json")
        isocurves = JOB.replace("FLOOR", "floor.json")
        for number in NUMBERS:
            for job in (pocket, isocurves):
                self.refused(job.replace("scallop = 0.2", f"scallop = {number}"), "operation 1: scallop: ")
                self.refused(job + f"floor_tolerance = {number}\n", "operation 1: floor_tolerance: ")
                self.refused(job + f"plan_tolerance = {number}\n", "operation 1: plan_tolerance: ")
            self.refused(isocurves.replace("scallop = 0.2", f"iso_distance = {number}"), "iso_distance")

    def test_letters_outside_strings(self):
        (self.folder / "floor\u00e9.json").write_text(surface({}))
        job = JOB.replace("FLOOR", "floor\u00e9.json") + "# caf\u00e9 \ufecc \"\n"
        self.assertEqual(0, self.plan(job).returncode)
        self.refused(job.replace("top = 20\n", "top = 20\ufecctop\n"), "job.toml:9: byte 0xEF outside strings")
        self.refused(job + 'entry = """a\n"quoted\u00e9" """ \u00e9\n', "job.toml:16: byte 0xC3 outside strings")

    def test_missing_files(self):
        for name in ("gone.json", "gone.stl", "gone.step", "gone.igs", "gone.obj", "."):
            self.refused(JOB.replace("FLOOR", name), name if CAD or name[-4:] not in
                         ("step", ".igs") else "Open CASCADE")
        (self.folder / "floor.json").write_text(surface({}))
        self.refused(POCKET, "edge.dxf")

    def planned(self, change, job, words):
        (self.folder / "floor.json").write_text(surface(change))
        result = self.plan(job.replace("FLOOR", "floor.json"), "--stats", "stats.json")
        self.assertEqual(0, result.returncode, result.stdout)
        self.assertIn(words, result.stdout)
        self.assertEqual(0, json.loads((self.folder / "stats.json").read_text())["gouge_bound_mm"])

    def test_an_undercut_is_left_standing(self):
        # it comes back below itself
        points = [[x, y, z] for x, z in ((0, 0), (24, 2), (24, 8), (8, 10)) for y in (0, 20)]
        self.planned({"points": points}, JOB, "stock is left there")

    def test_a_valley_narrower_than_the_tool_is_left_standing(self):
        points = [[x, y, z] for x, z in ((0, 10), (14, -10), (16, -10), (30, 10)) for y in (0, 20)]
        self.planned({"points": points}, JOB.replace("diameter = 4", "diameter = 12"),
                     "stock is left there")

    def test_what_a_mesh_keeps_is_told(self):
        # a narrow valley, and a roof over its side
        facets = []
        for (x0, z0), (x1, z1) in (((0, 10), (14, -10)), ((14, -10), (16, -10)), ((16, -10), (30, 10)), ((20, 12), (30, 12))):
            facets += [((x0, 0, z0), (x1, 0, z1), (x1, 20, z1)), ((x0, 0, z0), (x1, 20, z1), (x0, 20, z0))]
        (self.folder / "valley.stl").write_bytes(binary_stl(facets))
        result = self.plan(JOB.replace("FLOOR", "valley.stl").replace("diameter = 4", "diameter = 12"))
        self.assertEqual(0, result.returncode, result.stdout)
        self.assertIn("stock is left there", result.stdout)

    def test_an_edge_that_is_one_point_is_a_pole(self):
        points = [[0, 10, 0], [0, 10, 0]] + FLOOR["control_points"]["points"][2:]
        self.planned({"points": points}, JOB, "wrote")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
