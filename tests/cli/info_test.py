#!/usr/bin/env python3
"""cusp info as a machinist calls it: its text, its JSON and its errors.

usage: info_test.py CUSP [--without-cad]
"""
import json
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import plate_mesh
from cusp_case import property_cases

CUSP = str(pathlib.Path(sys.argv[1]).resolve())
WITH_CAD = "--without-cad" not in sys.argv
BRACKET = pathlib.Path(__file__).resolve().parents[2] / "examples/bracket/bracket.step"
TRAY = pathlib.Path(__file__).resolve().parents[2] / "examples/tutorial/tray.step"


def line(layer, x0, y0, x1, y1):
    return (0, "LINE", 8, layer, 10, x0, 20, y0, 11, x1, 21, y1)


def circle(layer, x, y, radius):
    return (0, "CIRCLE", 8, layer, 10, x, 20, y, 40, radius)


def dxf(*entities):
    words = [str(word) for entity in entities for word in entity]
    return "\n".join(["0", "SECTION", "2", "ENTITIES", *words, "0", "ENDSEC", "0", "EOF", ""])


def rectangle(layer, low_x, low_y, high_x, high_y):
    return (line(layer, low_x, low_y, high_x, low_y), line(layer, high_x, low_y, high_x, high_y),
            line(layer, high_x, high_y, low_x, high_y), line(layer, low_x, high_y, low_x, low_y))


PLATE = dxf(*rectangle("cut", 0, 0, 100, 60), circle("cut", 30, 30, 10), circle("cut", 30, 30, 4),
            *rectangle("open", 200, 0, 240, 30)[:3])
SURFACE = json.dumps({"shape": {"type": "surface", "count": 1, "data": [{
    "degree_u": 1, "degree_v": 1, "size_u": 2, "size_v": 2,
    "knotvector_u": [0, 0, 1, 1], "knotvector_v": [0, 0, 1, 1],
    "control_points": {"points": [[0, 0, 0], [0, 40, 0], [60, 0, 30], [60, 40, 30]]}}]}})


def stl(count):
    """A sheet of 2 * count * count facets with a groove of radius 10, 2 mm deep, in every 40 mm."""
    step = 120 / count
    heights = [-max(0, (100 - min(100, ((i * step) % 40 - 20) ** 2)) ** 0.5 - 8) for i in range(count + 1)]
    facet = struct.Struct("<12fH")
    out = bytearray(b"\0" * 80 + struct.pack("<I", 2 * count * count))
    for i in range(count):
        for j in range(count):
            x0, x1, y0, y1 = i * step, (i + 1) * step, j * step, (j + 1) * step
            a, b = (x0, y0, heights[i]), (x1, y0, heights[i + 1])
            c, d = (x1, y1, heights[i + 1]), (x0, y1, heights[i])
            out += facet.pack(0, 0, 0, *a, *b, *c, 0) + facet.pack(0, 0, 0, *a, *c, *d, 0)
    return bytes(out)


def pockets_of(heights):
    """Height, area and openness of the pieces of squares below the top that have a wall beside them."""
    wide, deep, top = len(heights), len(heights[0]), max(sum(heights, []))
    cells = {(i, j): heights[i][j] for i in range(wide) for j in range(deep)}
    around = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j]

    def flood(start, inside, steps):
        found, todo = {start}, [start]
        while todo:
            i, j = todo.pop()
            for near in ((i + a, j + b) for a, b in steps):
                if near not in found and inside(near):
                    found.add(near)
                    todo.append(near)
        return found

    left = {cell for cell, z in cells.items() if z < top}
    while left:
        first = min(left)
        piece = flood(first, lambda c: cells.get(c) == cells[first], [(1, 0), (-1, 0), (0, 1), (0, -1)])
        left -= piece
        outside = flood((-1, -1), lambda c: -1 <= c[0] <= wide and -1 <= c[1] <= deep and c not in piece, around)
        beside = [cells.get((i + a, j + b), -1) for i, j in piece for a, b in around if (i + a, j + b) in outside]
        if any(z > cells[first] for z in beside):
            yield cells[first], plate_mesh.PITCH ** 2 * len(piece), any(z <= cells[first] for z in beside)


class Info(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.scratch.name)
        (self.folder / "plate.dxf").write_text(PLATE)
        (self.folder / "ramp.json").write_text(SURFACE)

    def tearDown(self):
        self.scratch.cleanup()

    def info(self, *arguments):
        return subprocess.run([CUSP, "info", *arguments], cwd=self.folder, text=True, timeout=300,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def said(self, *arguments):
        result = self.info(*arguments)
        self.assertEqual(0, result.returncode, result.stdout)
        return result.stdout

    def refused(self, words, *arguments):
        before = sorted(self.folder.iterdir())
        result = self.info(*arguments, "--stats", "stats.json")
        self.assertEqual(2, result.returncode, result.stdout)
        self.assertIn(words, result.stdout)
        self.assertEqual(1, result.stdout.count("\n"), result.stdout)
        self.assertEqual(before, sorted(self.folder.iterdir()))

    def described(self, name):
        self.said(name, "--stats", "info.json")
        return json.loads((self.folder / "info.json").read_text())["files"][0]

    @unittest.skipUnless(WITH_CAD, "reads STEP")
    def test_levels_pockets_holes_and_corners_of_a_bracket(self):
        found = self.described(str(BRACKET))
        self.assertEqual([15, 10, 9], [level["z_mm"] for level in found["levels"]])
        self.assertEqual([(9, [40, 20], [40, 25], False)],
                         [(p["z_mm"], p["size_mm"], p["middle_mm"], p["open"]) for p in found["pockets"]])
        small, bored = found["round_holes"]
        self.assertEqual((6, 15, 15, True, 4), (small["diameter_mm"], small["top_mm"], small["depth_mm"], small["through"],
                                                len(small["places_mm"])))
        self.assertEqual((6.6, 10, 10, True), tuple(bored[key] for key in ("diameter_mm", "top_mm", "depth_mm", "through")))
        self.assertEqual({"diameter_mm": 12, "depth_mm": 5, "angle_degrees": 0}, bored["mouth"])
        self.assertEqual([{"radius_mm": 4, "count": 4}], found["inner_corners"])
        self.assertEqual([], found["fillets"])
        self.assertIn("counterbored 12 mm, 5 mm deep", self.said(str(BRACKET)))
        tray = self.described(str(TRAY))["fillets"]
        self.assertEqual([(3.5, True, 1), (4, True, 8), (1.5, False, 8), (2, False, 1)],
                         [(f["radius_mm"], f["concave"], f["count"]) for f in tray])
        self.assertIn("1 of radius 2 mm, convex, 27.4 mm long", self.said(str(TRAY)))

    def test_levels_and_pockets_of_random_plates_are_those_of_their_squares(self):
        for seed in range(1, 1 + property_cases(12)):
            r = random.Random(seed)
            heights = [[r.choice((7, 7, 7, 5, 3)) for _ in range(7)] for _ in range(6)]
            heights[0][0] = 7
            (self.folder / "plate.stl").write_text(plate_mesh.stl(plate_mesh.plate(heights)))
            found = self.described("plate.stl")
            areas = {}
            for z in sum(heights, []):
                areas[z] = areas.get(z, 0) + plate_mesh.PITCH ** 2
            self.assertEqual(sorted(areas.items(), reverse=True),
                             [(level["z_mm"], level["level_area_mm2"]) for level in found["levels"]], f"seed {seed}")
            self.assertEqual(sorted(pockets_of(heights)),
                             sorted((p["z_mm"], p["level_area_mm2"], p["open"]) for p in found["pockets"]), f"seed {seed}")

    def test_a_drawing_of_several_loops_is_listed(self):
        self.said("plate.dxf", "--stats", "stats.json")
        layers = {layer["name"]: layer
                  for layer in json.loads((self.folder / "stats.json").read_text())["files"][0]["layers"]}
        cut = layers["cut"]
        self.assertEqual([0, 1, 2], [loop["depth"] for loop in cut["loops"]])
        self.assertEqual([False, True, False], [loop["hole"] for loop in cut["loops"]])
        self.assertEqual([None, 1, 2], [loop.get("inside") for loop in cut["loops"]])
        self.assertAlmostEqual(6000, cut["loops"][0]["area_mm2"], 6)
        self.assertAlmostEqual(314.159265, cut["loops"][1]["area_mm2"], 5)
        self.assertAlmostEqual(62.831853, cut["loops"][1]["length_mm"], 5)
        chain = layers["open"]["open_chains"][0]
        self.assertAlmostEqual(30, chain["gap_mm"])
        self.assertEqual([[200, 0], [200, 30]], sorted([chain["begin_mm"], chain["end_mm"]]))

    def test_one_layer_of_a_drawing(self):
        text = self.said("plate.dxf#open")
        self.assertIn("gap 30 mm", text)
        self.assertNotIn('"cut"', text)

    def test_several_files_are_several_entries(self):
        self.said("plate.dxf", "ramp.json", "--stats", "stats.json")
        files = json.loads((self.folder / "stats.json").read_text())["files"]
        self.assertEqual(["plate.dxf", "ramp.json"], [entry["file"] for entry in files])
        self.assertEqual([60, 40, 30], files[1]["size_mm"])
        self.assertAlmostEqual(26.565051, files[1]["steepest_degrees"], 5)
        self.assertTrue(files[1]["any_ball"])

    def test_units_of_files_that_name_none(self):
        self.assertIn("60 x 40 x 30 mm", self.said("ramp.json"))
        self.assertIn("1524 x 1016 x 762 mm = 60 x 40 x 30 inch", self.said("ramp.json", "--units", "inch"))

    def test_pictures_are_svg(self):
        for part in ("plate.dxf", "ramp.json"):
            self.said(part, "--picture", "part.svg")
            root = xml.etree.ElementTree.parse(self.folder / "part.svg").getroot()
            self.assertTrue(root.tag.endswith("svg"))
            self.assertGreater(len(list(root)), 4)

    def test_a_large_mesh_is_quick(self):
        (self.folder / "large.stl").write_bytes(stl(400))
        self.said("large.stl", "--stats", "stats.json")
        part = json.loads((self.folder / "stats.json").read_text())["files"][0]
        self.assertEqual(320000, part["facets"])
        self.assertEqual(1, part["holes"])
        self.assertEqual(0, part["undercut_share"])
        self.assertAlmostEqual(20, part["largest_ball_mm"], delta=0.3)

    def test_what_can_not_be_read_is_refused_and_nothing_written(self):
        for name, content, words in (
                ("empty.stl", b"", "empty.stl: no STL"),
                ("empty.json", b"", "empty.json: not JSON"),
                ("empty.dxf", b"", "empty.dxf: no DXF"),
                ("noise.stl", bytes(range(256)) * 20, "noise.stl"),
                ("noise.json", bytes(range(256)) * 20, "noise.json: not JSON"),
                ("noise.dxf", bytes(range(256)) * 20, "noise.dxf:1"),
                ("noise.step", bytes(range(256)) * 20, "noise.step: "),
                ("part.ply", b"ply", 'not from ".ply"'),
                ("type.json", b'{"shape": {"type": "volume", "data": []}}', '"volume"'),
                ("kind.dxf", dxf((0, "3DFACE", 8, 0)).encode(), "3DFACE")):
            (self.folder / name).write_bytes(content)
            self.refused(words, name)
            self.refused(words, "plate.dxf", name)
        self.refused("gone.stl: can't be read", "gone.stl")
        (self.folder / "folder.stl").mkdir()
        self.refused("is a folder", "folder.stl")
        self.refused('no curve on the layer "none"', "plate.dxf#none")

    def test_a_picture_shows_one_file(self):
        self.refused("call cusp info once for each", "plate.dxf", "ramp.json", "--picture", "part.svg")

    def test_outputs_are_written_both_or_not_at_all(self):
        before = sorted(self.folder.iterdir())
        result = self.info("ramp.json", "--picture", "part.svg", "--stats", "nowhere/stats.json")
        self.assertEqual(2, result.returncode, result.stdout)
        self.assertIn("nowhere/stats.json: can't be written", result.stdout)
        self.assertEqual(before, sorted(self.folder.iterdir()))

    def test_help_has_an_example(self):
        text = self.said("--help")
        self.assertIn("cusp info plate.dxf#outline", text)
        self.assertIn("--tolerance", text)

    def test_values_out_of_range_are_refused(self):
        for arguments in (("--tolerance", "0"), ("--tolerance", "nan"), ("--units", "cm")):
            self.assertEqual(2, self.info("ramp.json", *arguments).returncode)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
