"""2.5-D programs that waste nothing: each level once, entries of arcs, few retracts, short tours, and rest machining
that finds nothing after its own program.

usage: drawing_cuts_test.py CUSP
"""
import json
import math
import random
import re
import subprocess
import sys
import unittest

from cusp_case import CUSP, CuspCase

HEAD = """
units = "{units}"
[[tool]]
shape = "flat"
diameter = {d6}
[[tool]]
shape = "vee"
diameter = {d10}
tip_angle = 90
tip_diameter = {d1}
[[tool]]
shape = "drill"
diameter = {d5}
[[tool]]
shape = "flat"
diameter = {d3}
name = "3mm flat"
[cutting]
feed = {feed}
plunge_feed = {plunge}
[stock]
top = 0
bottom = {bottom}
x = [{x0}, {x1}]
y = [{x0}, {x1}]
{stock}
"""

def head(units="mm", stock=""):
    unit = 25.4 if units == "inch" else 1
    sizes = {"d6": 6, "d10": 10, "d1": 1, "d5": 5, "d3": 3, "feed": 1000, "plunge": 300, "bottom": -14, "x0": -20,
             "x1": 100}
    return HEAD.format(units=units, stock=stock, **{key: value / unit for key, value in sizes.items()})


def polygon(layer, points, closed=1):
    return (f"0\nLWPOLYLINE\n8\n{layer}\n90\n{len(points)}\n70\n{closed}\n" +
            "".join(f"10\n{x}\n20\n{y}\n" for x, y in points))


def rectangle(layer, x0, y0, x1, y1):
    return polygon(layer, [(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def circle(layer, x, y, radius):
    return f"0\nCIRCLE\n8\n{layer}\n10\n{x}\n20\n{y}\n40\n{radius}\n"


def drawing(*entities):
    return ("0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" + "".join(entities) +
            "0\nENDSEC\n0\nEOF\n")


def operation(strategy, layer="", units="mm", **keys):
    unit = 25.4 if units == "inch" else 1
    keys = {"boundary": f"plate.dxf#{layer}", **keys} if layer else keys
    lengths = ("depth", "max_depth", "width", "lead_in")
    return f'[[operation]]\nstrategy = "{strategy}"\n' + "".join(
        f"{key} = {value / unit if key in lengths else value}\n" if not isinstance(value, str) else
        f'{key} = "{value}"\n' for key, value in keys.items())


def cuts_by_level(program):
    """mm of the level cuts in plan at each z below 0; arcs by their radius."""
    at, mode, sums = {"X": 0.0, "Y": 0.0, "Z": 5.0}, "0", {}
    for line in program.splitlines():
        words = dict(re.findall(r"([GXYZIJ])(-?[\d.]+)", re.sub(r"\(.*?\)", "", line)))
        mode = words["G"] if words.get("G") in ("0", "1", "2", "3") else mode
        end = {axis: float(words.get(axis, at[axis])) for axis in "XYZ"}
        way = math.dist((at["X"], at["Y"]), (end["X"], end["Y"]))
        if mode in ("2", "3") and ("I" in words or "J" in words):
            i, j = float(words.get("I", 0)), float(words.get("J", 0))
            a = math.atan2(-j, -i)
            b = math.atan2(end["Y"] - at["Y"] - j, end["X"] - at["X"] - i)
            way = math.hypot(i, j) * ((b - a if mode == "3" else a - b) % (2 * math.pi) or 2 * math.pi)
        if mode != "0" and end["Z"] == at["Z"] < 0:
            sums[end["Z"]] = sums.get(end["Z"], 0) + way
        at = end
    return sums


class DrawingCuts(CuspCase):
    def setUp(self):
        super().setUp()
        self.write("plate.dxf", drawing(
            rectangle("outline", 0, 0, 40, 30), rectangle("pocket", 5, 5, 37, 27), circle("hole", 20, 15, 3.05),
            circle("wider", 20, 15, 3.6), circle("holes", 10, 10, 2.5), circle("holes", 30, 10, 2.5),
            polygon("open", [(0, 0), (30, 10), (60, 0)], 0), circle("disc", 20, 15, 20)))

    def planned(self, operations, *arguments, units="mm", stock="", name="p"):
        self.write("job.toml", head(units, stock) + operations)
        self.said = self.cusp(0, "plan", "job.toml", "-o", f"{name}.ngc", "--stats", f"{name}.json", *arguments)
        return (self.folder / f"{name}.ngc").read_text()

    def stats(self):
        return json.loads((self.folder / "p.json").read_text())["operations"]

    def holds(self):
        self.assertIn("all bounds hold", self.cusp(0, "verify", "job.toml", "p.ngc"))

    def test_nothing_is_left_after_the_same_program(self):
        for units in ("mm", "inch"):
            operations = {
                "pocket": operation("pocket", "pocket", units, depth=4, max_depth=2),
                "profile": operation("profile", "outline", units, depth=4, max_depth=2),
                "drill": operation("drill", "holes", units, depth=4, tool=3),
                "face": operation("face", "", units, depth=1),
                "engrave": operation("engrave", "open", units, depth=1, tool=2),
                "chamfer": operation("chamfer", "outline", units, width=1, tool=2),
            }
            for post in ("cusp", "grbl", "fanuc", "mach3", "linuxcnc", "grblhal"):
                for name, text in operations.items():
                    if post != "cusp" and name not in ("chamfer", "profile"):
                        continue
                    with self.subTest(f"{name}, {units}, {post}"):
                        self.planned(text, "--post", post, units=units, name="before")
                        self.planned(text, "--post", post, units=units, stock='program = ["before.ngc"]')
                        self.assertIn("nothing is cut", self.said)

    def test_the_last_level_of_a_pocket_is_cut_once(self):
        for output in ("lines", "arcs"):
            for depth, most in ((4, 2), (6, 2), (2, 2), (5, 3)):
                sums = cuts_by_level(self.planned(operation("pocket", "pocket", depth=depth, max_depth=most,
                                                            output=output)))
                levels = math.ceil(depth / most)
                self.assertEqual(levels, len([way for way in sums.values() if way > 50]), sums)
                self.assertLess(max(sums.values()), 1.25 * min(way for way in sums.values() if way > 50), sums)
                self.holds()

    def test_a_finishing_tool_leaves_out_the_floor_that_the_roughing_tool_has_cut(self):
        rough = operation("pocket", "pocket", depth=4, max_depth=2, tool=1)
        alone = sum(cuts_by_level(self.planned(rough)).values())
        both = sum(cuts_by_level(self.planned(rough.replace("tool = 1", "tool = 4\ntools = [1]"))).values())
        self.assertLess(both, alone + 3 * 108 + 60)  # the wall and its corners, at each level
        self.holds()

    def test_rapid_moves_end_just_above_what_stands(self):
        program = self.planned(operation("pocket", "pocket", depth=6, max_depth=2))
        self.assertIn("G0 Z-3\n", program)  # 1 mm over the level before, without a descent through air
        self.holds()

    def test_an_arm_hardly_wider_than_the_tool_is_owed_where_the_tolerance_leaves_room(self):
        draw = random.Random(48)
        for _ in range(12):
            wide, tolerance = 3 + draw.choice((0.01, 0.03, 0.05)), draw.choice((0.02, 0.05))
            x, y = draw.uniform(-8, 8), draw.uniform(-8, 8)
            self.write("plate.dxf", drawing(polygon("arm", [
                (x, y), (x + 16, y), (x + 16, y + 9), (x + wide, y + 9), (x + wide, y + 20), (x, y + 20)])))
            self.planned(operation("pocket", "arm", depth=1.5, tool="3mm flat", plan_tolerance=tolerance))
            self.holds()
        self.write("plate.dxf", drawing(polygon("arm", [(0, 0), (16, 0), (16, 9), (3.2, 9), (3.2, 20), (0, 20)])))
        self.planned(operation("pocket", "arm", depth=1.5, tool="3mm flat"))
        self.holds()
        program = (self.folder / "p.ngc").read_text()
        self.write("p.ngc", re.sub(r"Y1[3-9]\.?\d*", "Y13", program))
        self.assertRegex(self.cusp(1, "verify", "job.toml", "p.ngc"), r"(left|wall_stock_max_mm) .* y 1[4-9]")

    def test_an_entry_into_a_narrow_hole_is_a_helix_of_arcs(self):
        for strategy in ("pocket", "profile"):
            for layer in ("hole", "wider"):
                side = {"side": "inside"} if strategy == "profile" else {}
                for depths in ({"depth": 6, "max_depth": 2}, {"depth": 6}):
                    program = self.planned(operation(strategy, layer, output="arcs", **side, **depths))
                    self.assertLess(len(program.splitlines()), 100, f"{strategy} {layer} {depths}")
                    self.assertLess(self.stats()[-1]["estimated_s"], 20)
                    self.assertGreater(len(re.findall(r"^G3.* Z", program, re.M)), 3)
                    self.holds()

    def test_ramps_along_curves_are_arcs(self):
        program = self.planned(operation("profile", "disc", depth=4, max_depth=2, output="arcs"))
        self.assertLess(len(program.splitlines()), 50)
        self.assertGreater(len(re.findall(r"^G[23].* Z", program, re.M)), 1)

    def test_a_profile_stays_down_between_levels(self):
        for layer in ("outline", "disc"):
            for direction in ("climb", "conventional"):
                for more in ({}, {"lead_in": 0}, {"lead_in": 2}, {"entry": "plunge"}):
                    self.planned(operation("profile", layer, depth=8, max_depth=2, direction_of_cut=direction, **more))
                    self.assertEqual(1, self.stats()[0]["retracts"], f"{layer} {direction} {more}")
                    self.assertIn("rapid_cut_max_mm: 0.0\n", self.cusp_any("verify", "job.toml", "p.ngc"))

    def cusp_any(self, *arguments):
        """The output, whatever the status."""
        return subprocess.run([CUSP, *arguments], cwd=self.folder, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=600, check=False).stdout

    def test_an_open_curve_is_engraved_back_and_forth(self):
        self.planned(operation("engrave", "open", depth=3, max_depth=1, tool=2))
        self.assertEqual(1, self.stats()[0]["retracts"])

    def test_slots_deeper_than_the_mill_is_wide_are_warned_of(self):
        for strategy, more in (("profile", {}), ("pocket", {}), ("face", {}), ("engrave", {})):
            layer = {"face": ""}.get(strategy, "outline")
            self.planned(operation(strategy, layer, depth=12, tool=4, **more))
            self.assertIn("tool 4 of 3 mm cuts 12 mm deep in one level, 4 times its diameter: a max_depth of 3 mm "
                          "would make 4 levels of 3 mm", self.said, strategy)
        for more in ({"depth": 12, "max_depth": 3}, {"depth": 3}):
            self.planned(operation("profile", "outline", tool=4, **more))
            self.assertNotIn("in one level", self.said)
        self.planned(operation("profile", "outline", depth=12, max_depth=3, tool=4) +
                     operation("profile", "outline", depth=12, tool=4))
        self.assertNotIn("in one level", self.said)

    def test_sheets_are_cut_in_short_tours_and_holes_before_their_outline(self):
        seed = 48
        draw = random.Random(seed)
        cells = [(i, j) for i in range(12) for j in range(10)]
        draw.shuffle(cells)
        for strategy in ("profile", "pocket", "engrave", "drill"):
            parts = []
            for i, j in cells:
                size = draw.uniform(8, 14)
                parts.append(circle("sheet", 25 * i + 12, 25 * j + 12, size / 2))
                if strategy == "profile":
                    parts.append(circle("sheet", 25 * i + 12, 25 * j + 12, 2))
            self.write("plate.dxf", drawing(*parts))
            tool = {"drill": 3, "engrave": 2}.get(strategy, 4)
            program = self.planned(operation(strategy, "sheet", depth=1, tool=tool))
            rapid = sum(one["rapid_length_mm"] for one in self.stats())
            # 25 mm from part to part, up to 8 mm from hole to outline, down and up
            many = len(cells)
            self.assertLess(rapid, many * (1.25 * 25 + 12) + (many * 20 if strategy == "profile" else 0),
                            f"{strategy}, seed {seed}")
            if strategy == "profile":
                self.holes_come_first(program, cells)

    def holes_come_first(self, program, cells):
        order, at = [], {}
        for line in program.splitlines():
            words = dict(re.findall(r"([GXYZ])(-?[\d.]+)", re.sub(r"\(.*?\)", "", line)))
            at.update({axis: float(words[axis]) for axis in "XY" if axis in words})
            if line.startswith("G0 X"):
                cell = (int(at["X"] // 25), int(at["Y"] // 25))
                inside = math.hypot(at["X"] - 25 * cell[0] - 12, at["Y"] - 25 * cell[1] - 12) < 3
                order.append((cell, inside))
        for cell in cells:
            self.assertLess(order.index((cell, True)), order.index((cell, False)), cell)


class Carvings(CuspCase):
    # Forks of the axis, and a tool that goes back through what it has cut.
    def test_a_carving_is_lifted_over_stock_alone(self):
        vee = head().replace("tip_diameter = 1\n", "")
        star = [((9 if k % 2 else 20) * math.cos(k * math.pi / 7) + 30, (9 if k % 2 else 20) * math.sin(k * math.pi / 7) + 30)
                for k in range(14)]
        comb = [(0, 60), (60, 60), (60, 64)] + [p for k in range(5) for p in (
            (60 - 12 * k, 76), (56 - 12 * k, 76), (54 - 12 * k, 64), (50 - 12 * k, 64))] + [(0, 64)]
        self.write("plate.dxf", drawing(polygon("star", star), polygon("comb", comb)))
        for layer, lifts in (("star", 1), ("comb", 3)):
            self.write("job.toml", vee + operation("v_carve", layer, tool=2, depth=4))
            self.cusp(0, "plan", "job.toml", "-o", "p.ngc", "--stats", "p.json")
            planned = json.loads((self.folder / "p.json").read_text())["operations"][0]
            # on a level floor loops lie beside each other
            floors = planned["floor_loops"]
            self.assertLessEqual(planned["retracts"], lifts + floors, layer)
            self.assertGreater(planned["branches"], 5)
            self.cusp(0, "verify", "job.toml", "p.ngc")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]], verbosity=2)
