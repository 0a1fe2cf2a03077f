"""2.5-D jobs that can't be or should not be: an error or a warning with operation and place.

usage: bad_operations_test.py CUSP
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

CUSP = str(pathlib.Path(sys.argv[1]).resolve())
TOP = pathlib.Path(__file__).resolve().parents[2]

HEAD = """
[[tool]]
shape = "flat"
diameter = 6
[[tool]]
shape = "drill"
diameter = 5
[[tool]]
shape = "vee"
diameter = 6
tip_angle = 90
[cutting]
feed = 1000
[stock]
top = 0
bottom = -10
x = [-20, 120]
y = [-20, 80]
"""
PLANE = {"shape": {"type": "surface", "count": 1, "data": [{
    "degree_u": 1, "degree_v": 1, "size_u": 2, "size_v": 2, "knotvector_u": [0, 0, 1, 1], "knotvector_v": [0, 0, 1, 1],
    "control_points": {"points": [[0, 0, -1], [0, 60, -1], [100, 0, -3], [100, 60, -3]], "weights": [1, 1, 1, 1]}}]}}


def polygon(layer, *points, closed=1):
    return (f"0\nLWPOLYLINE\n8\n{layer}\n90\n{len(points)}\n70\n{closed}\n" +
            "".join(f"10\n{x}\n20\n{y}\n" for x, y in points))


def rectangle(layer, x0, y0, x1, y1):
    return polygon(layer, (x0, y0), (x1, y0), (x1, y1), (x0, y1))


def circle(layer, x, y, radius):
    return f"0\nCIRCLE\n8\n{layer}\n10\n{x}\n20\n{y}\n40\n{radius}\n"


DRAWING = "".join((
    rectangle("outline", 0, 0, 100, 60), rectangle("pocket", 10, 10, 40, 40), rectangle("other", 30, 30, 60, 50),
    rectangle("inner", 15, 15, 30, 30), rectangle("slot", 70, 10, 74, 40), circle("holes", 80, 50, 2.5),
    circle("holes", 90, 50, 1.5), circle("at_wall", 40, 20, 2.5), circle("in_pocket", 20, 20, 2.5),
    polygon("open", (0, 0), (10, 0), (10, 10), closed=0), polygon("eight", (0, 0), (10, 10), (10, 0), (0, 10)),
    rectangle("crossing", 0, 0, 20, 20), rectangle("crossing", 10, 10, 30, 30),
    # a notch of 2 mm in a plate, which the tool does not enter
    polygon("notched", (0, 0), (40, 0), (40, 30), (21, 30), (21, 5), (19, 5), (19, 30), (0, 30)),
    circle("dot", 20, 20, 2)))


def operation(strategy, layer="", **keys):
    keys = {"boundary": f"plate.dxf#{layer}", **keys} if layer else keys
    return f'[[operation]]\nstrategy = "{strategy}"\n' + "".join(
        f"{key} = {value}\n" if key in ("tabs", "floor") or not isinstance(value, str) else f'{key} = "{value}"\n'
        for key, value in keys.items())


class BadOperations(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.scratch.name)
        self.write("plate.dxf", f"0\nSECTION\n2\nENTITIES\n{DRAWING}0\nENDSEC\n0\nEOF\n")
        self.write("plane.json", json.dumps(PLANE))

    def tearDown(self):
        self.scratch.cleanup()

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def said(self, status, operations, head=HEAD, post=""):
        (self.folder / "p.ngc").unlink(missing_ok=True)
        self.write("job.toml", head + operations)
        call = [CUSP, "plan", "--estimate-times", "job.toml", "-o", "p.ngc"] + (["--post", post] if post else [])
        result = subprocess.run(call, cwd=self.folder, text=True, timeout=600, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT)
        self.assertEqual(status, result.returncode, f"{operations}: {result.stdout}")
        return result.stdout

    def refused(self, words, operations, **more):
        said = self.said(2, operations, **more)
        self.assertIn(words, said)
        self.assertRegex(said, r"\w+\.(toml|dxf)|post|library")  # the file is named
        self.assertFalse((self.folder / "p.ngc").exists())

    def warned(self, words, operations, **more):
        self.assertRegex(self.said(0, operations, **more), words)

    def test_holes_that_are_all_smaller_than_the_tool(self):
        self.write("small.dxf", f"0\nSECTION\n2\nENTITIES\n{circle('small', 5, 5, 2)}0\nENDSEC\n0\nEOF\n")
        self.refused("the hole of 4 mm at x 5 y 5 mm is smaller than tool 2 of 5 mm",
                     operation("drill", "small", tool=2, depth=3).replace("plate.dxf", "small.dxf"))

    def test_a_hole_smaller_than_the_tool_beside_others(self):
        self.warned(r"the hole of 3 mm at x 90 y 50 mm is narrower than tool 2 of 5 mm: left out",
                    operation("drill", "holes", tool=2, depth=3))
        self.assertNotIn("X90 Y50", (self.folder / "p.ngc").read_text())

    def test_a_hole_wider_than_the_tool(self):
        self.write("wide.dxf", f"0\nSECTION\n2\nENTITIES\n{circle('wide', 5, 5, 4)}0\nENDSEC\n0\nEOF\n")
        self.warned("1 of 1 hole is wider than tool 2",
                    operation("drill", "wide", tool=2, depth=3).replace("plate.dxf", "wide.dxf"))

    def test_holes_drawn_as_arcs(self):
        arc = "0\nARC\n8\nholes\n10\n{}\n20\n8\n40\n2.5\n50\n{}\n51\n{}\n"
        polyline = "0\nLWPOLYLINE\n8\nholes\n90\n2\n70\n1\n10\n50\n20\n17.5\n42\n1\n10\n50\n20\n22.5\n42\n1\n"
        no_holes = arc.format(90, 0, 180) + arc.format(90, 0, 180)  # a half alone, drawn twice: one curve
        self.write("arcs.dxf", "0\nSECTION\n2\nENTITIES\n" + arc.format(8, 0, 180) + arc.format(8, 180, 360) + polyline +
                   arc.format(70, 0, 170) + no_holes + "0\nENDSEC\n0\nEOF\n")
        self.warned("arcs.dxf#holes: 2 curves are no circles and not drilled",
                    operation("drill", "holes", tool=2, depth=3).replace("plate.dxf", "arcs.dxf"))
        text = (self.folder / "p.ngc").read_text()
        self.assertIn("(drill: 2 holes, 3 mm deep)", text)
        self.assertRegex(text, r"X8 Y8\b")
        self.assertRegex(text, r"X50 Y20\b")

    def test_a_profile_inside_that_no_tool_enters(self):
        self.refused("tool 1 of 6 mm fits nowhere inside the loops", operation("profile", "dot", side="inside", depth=2))
        self.refused("fits nowhere", operation("pocket", "slot", depth=2))
        # in a job with other operations, too
        self.refused("plate.dxf#slot: operation 2: tool 1 of 6 mm fits nowhere into the pocket",
                     operation("pocket", "pocket", depth=2) + operation("pocket", "slot", depth=2))

    def test_a_scallop_that_hulls_do_not_bound(self):
        hulls = {"floor": '["plane.json"]', "max_depth": 2}
        self.refused("scallop", operation("hull_rough", **hulls, scallop=0.1))
        self.said(0, operation("hull_rough", **hulls))

    def test_a_corner_that_no_tool_enters(self):
        self.warned(r"tool 1 .*does not reach .* x [\d.]+ y [\d.]+", operation("profile", "notched", depth=2))

    def test_tabs_higher_than_the_cut(self):
        for height in (2, 3):
            self.refused(f"height is {height} mm, the cut is only 2 mm deep",
                         operation("profile", "outline", depth=2, tabs=f"{{ count = 4, width = 5, height = {height} }}"))

    def test_tabs_without_room(self):
        self.refused("has no room", operation("profile", "outline", depth=2,
                                              tabs="{ count = 90, width = 5, height = 1 }"))
        self.refused("the tab at x 50 y 90 mm is", operation("profile", "outline", depth=2,
                                                             tabs="{ places = [50, 90], width = 5, height = 1 }"))

    def test_a_vee_without_an_angle(self):
        self.refused("tool 3: tip_angle: is missing: a vee tool needs the angle between its flanks",
                     operation("engrave", "outline", tool=3, depth=1), head=HEAD.replace("tip_angle = 90\n", ""))

    def test_operations_that_overlap(self):
        two = operation("pocket", "pocket", depth=2) + operation("pocket", "other", depth=4)
        self.warned(r"operations 1 \(pocket\) and 2 \(pocket\) overlap: their outlines cross at x 30\.000 y 40\.000 mm|"
                    r"operations 1 \(pocket\) and 2 \(pocket\) overlap: their outlines cross at x 40\.000 y 30\.000 mm", two)
        self.warned(r"operations 1 \(pocket\) and 2 \(drill\) overlap: their outlines cross at x [34]\d",
                    operation("pocket", "pocket", depth=2) + operation("drill", "at_wall", tool=2, depth=4))
        for apart in (operation("pocket", "pocket", depth=2) + operation("pocket", "inner", top=-2, depth=2),
                      operation("pocket", "pocket", depth=2) + operation("drill", "in_pocket", tool=2, depth=4),
                      operation("pocket", "pocket", depth=2) + operation("profile", "pocket", side="inside", depth=2),
                      operation("pocket", "pocket", depth=2) + operation("profile", "outline", depth=5)):
            self.assertNotIn("overlap", self.said(0, apart))

    def test_depths(self):
        for depth in (-2, 0):
            self.refused(f"operation 1: depth: is {depth}", operation("profile", "outline", depth=depth))
        self.refused("depth: is missing", operation("profile", "outline"))
        self.refused("depth: is missing: drill needs how deep", operation("drill", "in_pocket", tool=2))
        self.refused("max_depth: is 0", operation("profile", "outline", depth=2, max_depth=0))
        self.refused("makes 10000 levels", operation("profile", "outline", depth=10, max_depth=0.001))

    def test_drawings(self):
        self.refused("plate.dxf", operation("profile", "nothing", depth=1))
        self.refused('no curve on the layer "Pocket"; layers of the drawing: "pocket", ', operation("pocket", "Pocket", depth=1))
        self.refused("gap", operation("profile", "open", depth=1))
        self.refused("crosses itself", operation("profile", "eight", depth=1))
        self.refused("cross each other at x", operation("profile", "crossing", depth=1))
        self.refused("no point and no circle to drill", operation("drill", "outline", tool=2, depth=1))
        self.refused("boundary: is missing", operation("profile", depth=1))
        self.refused("nowhere.dxf", operation("profile", "outline", depth=1).replace("plate.dxf", "nowhere.dxf"))

    def test_texts_beside_curves(self):
        text = "0\nTEXT\n8\ndot\n10\n18\n20\n21\n40\n3\n1\nA\n"
        self.write("plate.dxf", f"0\nSECTION\n2\nENTITIES\n{DRAWING}{text}0\nENDSEC\n0\nEOF\n")
        words = r"warning: plate.dxf#dot: a text at x 18 y 21 mm is not cut: convert text to curves"
        for strategy in ("engrave", "profile"):
            said = self.said(0, 2 * operation(strategy, "dot", tool=3 if strategy == "engrave" else 1, depth=0.2))
            self.assertRegex(said, words)
            self.assertEqual(1, said.count("a text at"))

    def test_tools(self):
        self.refused("tool 2 is a drill", operation("profile", "outline", tool=2, depth=1))
        self.refused("tool 3 is vee: pocket needs vertical flanks", operation("pocket", "pocket", tool=3, depth=1))
        self.refused("v_carve needs a vee or a taper, tool 1 is flat", operation("v_carve", "slot", tool=1))
        self.refused("chamfer needs a vee or a taper, tool 1 is flat", operation("chamfer", "outline", width=1))
        self.refused("tool: is 7", operation("profile", "outline", tool=7, depth=1))
        self.refused('is "6mm flat", but no tool has a name', operation("profile", "outline", tool="6mm flat", depth=1))
        self.refused('job.toml:1: library: library "steel": there is none of that name', operation("profile", "outline", depth=1),
                     head='library = "steel"\n' + HEAD)
        self.write("tools.toml", 'units = "mm"\n[[tool]]\nname = "big"\nshape = "flat"\ndiameter = 20\nfeed = 500\n')
        self.refused('no tool has that name, in tools.toml either; the nearest are "big"',
                     operation("profile", "outline", tool="bog", depth=1), head='library = "tools.toml"\n' + HEAD)
        for keys, words in (('shape = "taper"\ndiameter = 6\ntaper_angle = 10', "tip_diameter: is missing: a taper needs"),
                            ('shape = "taper"\ndiameter = 6\ntaper_angle = 10\ncorner_radius = 3', "corner_radius: is 3"),
                            ('shape = "taper"\ndiameter = 6\ntaper_angle = 10\ncorner_radius = 1\ntip_diameter = 1',
                             "corner_radius: is given beside tip_diameter"),
                            ('shape = "vee"\ndiameter = 6\ntip_angle = 190', "tip_angle: is 190"),
                            ('shape = "flat"\ndiameter = -6', "diameter: is -6"),
                            ('shape = "cube"\ndiameter = 6', 'shape: is "cube"')):
            self.refused(words, operation("profile", "outline", depth=1), head=HEAD + f"[[tool]]\n{keys}\n")
        ball = '[[tool]]\nshape = "taper"\ndiameter = 6\ntaper_angle = 20\ncorner_radius = 0.5\n'
        self.refused("tool 4 has a ball at its tip: v_carve needs a sharp or a flat one",
                     operation("v_carve", "slot", tool=4), head=HEAD + ball)

    def test_posts(self):
        one = operation("pocket", "pocket", depth=1)
        self.refused('the nearest is "fanuc"', one, post="fanuk")
        self.refused('job.toml:1: post: post "fanuk": there is none', one, head='post = "fanuk"\n' + HEAD)
        self.refused("job.toml:1: post: none.toml: can't be read", one, head='post = "none.toml"\n' + HEAD)
        post = (TOP / "posts/grbl.toml").read_text()
        for wrong, words in ((post.replace("footer", "fotter"), "fotter: unknown key; the nearest known one is footer"),
                             (post.replace("{units}", "{unit}"), "{unit} in"),
                             (post.replace("line_numbers = 0", "line_numbers = -1"), "line_numbers: is -1")):
            self.write("own.toml", wrong)
            said = self.said(2, one, post="own.toml")
            self.assertIn(words, said)
            self.assertIn("own.toml:", said)
        self.refused('coolant = "mist" of tool 1, but the post "grbl"', one + 'coolant = "mist"\n', post="grbl")
        self.said(0, one, post="fanuc")  # three decimals raise the default tolerance
        self.refused("floor_tolerance is 0.001 mm, but the post", one + "floor_tolerance = 0.001\n", post="fanuc")

    def test_a_profile_beside_a_part_without_a_sheet(self):
        both = operation("parallel_planes", floor='["plane.json"]', scallop=0.2, tool=4) + \
            operation("profile", "outline", depth=8, max_depth=4)
        head = HEAD + '[[tool]]\nshape = "ball"\ndiameter = 6\n'
        for without in ("x = [-20, 120]\n", "y = [-20, 80]\n"):
            self.refused("operation 2: profile: there is stock around the part, but operation 1 (parallel_planes) takes "
                         "the part's box for the stock", both, head=head.replace(without, ""))
        self.said(0, both, head=head)
        inside = both.replace("depth = 8", 'side = "inside"\ndepth = 8')
        self.said(0, inside, head=head.replace("x = [-20, 120]\n", ""))

    def test_levels_beside_the_stock(self):
        self.warned(r"operation 1 \(pocket\) ends at z = 1 mm, not below the stock's top, z = 0 mm: it cuts air",
                    operation("pocket", "pocket", depth=2, top=3))
        self.warned("operation 1, profile: it begins below stock that stands by then, up to 5.5 mm of it at x 47.000 y "
                    "66.000: tool 1 goes through it at the plunge feed, at 1 place", operation("profile", "outline", depth=2, top=-6.5))
        self.warned(r"operation 1 \(pocket\) goes 7 mm below the stock's bottom, z = -10 mm",
                    operation("pocket", "pocket", depth=17))
        self.assertNotIn("stock's", self.said(0, operation("drill", "in_pocket", tool=2, depth=12) +
                                              operation("profile", "outline", depth=10.5)))

    def test_plunges_through_standing_stock(self):
        def at(top, strategy="pocket", **keys):
            return operation(strategy, "pocket" if strategy == "pocket" else "in_pocket", depth=2, top=top, **keys)
        for text, depth, most in ((at(-8), 7, "6 mm at once (its diameter)"), (at(-8, "drill", tool=2), 7, "5 mm at once"),
                                  (at(-5, max_depth=1.5), 4, "1.5 mm at once (max_depth)")):
            self.refused(f"mm, below {depth} mm of stock that stands by then at x ", text)
            self.refused(f" plunges at most {most}", text)
        for text in (at(-5), at(-2, max_depth=1.5), at(-8, "drill", tool=2, peck=0.7)):
            self.warned("operation 1, .*: it begins below stock that stands by then", text)
        self.assertNotIn("stands by then", self.said(0, operation("pocket", "pocket", depth=5, max_depth=1.5) +
                                                     at(-5, max_depth=1.5)))

    def test_walls_that_end_within_the_round_of_the_tool(self):
        ball = HEAD.replace('"flat"', '"ball"')
        bull = HEAD.replace('"flat"', '"bull"\ncorner_radius = 1')
        for strategy, layer, head, depth, left in (("profile", "outline", ball, 1.2, 0.6), ("pocket", "pocket", ball, 2.4, 0.06061),
                                                   ("profile", "inner", bull, 0.4, 0.2), ("profile", "outline", ball, 3, 0),
                                                   ("profile", "inner", ball, 2.7, 0.01505), ("pocket", "pocket", HEAD, 0.1, 0)):
            job = operation(strategy, layer, depth=depth, **({"side": "inside"} if layer == "inner" else {}))
            said = self.said(0, job, head=head)
            with self.subTest(strategy=strategy, depth=depth):
                self.assertEqual(left > 0.02, f"operation 1, {strategy}: {left:.4g} mm are left on the upper edge" in said, said)
                self.assertEqual(left > 0.02, "round end" in said, said)
                judged = subprocess.run([CUSP, "verify", "job.toml", "p.ngc"], cwd=self.folder, capture_output=True, text=True,
                                        timeout=600).stdout
                found = re.search(r"broken: wall_stock_max_mm ([\d.]+)", judged)
                self.assertEqual(left > 0.02, found is not None, judged)
                if found:  # a pocket's path keeps some of the tolerance from its walls
                    self.assertAlmostEqual(left, float(found[1]), delta=0.012)

    def test_stock_and_faces(self):
        self.refused("bottom: is -10 mm, not below the top at -20 mm", operation("profile", "outline", depth=1),
                     head=HEAD.replace("top = 0", "top = -20"))
        self.refused("x", operation("face", depth=1), head=HEAD.replace("x = [-20, 120]\n", ""))
        self.refused("x: two numbers [min, max]", operation("face", depth=1),
                     head=HEAD.replace("[-20, 120]", "[120, -20]"))

    def test_carvings_and_chamfers(self):
        self.refused("depth: is 4 mm, the flank of tool 3 is only 3 mm high", operation("v_carve", "slot", tool=3, depth=4))
        self.refused("is more than the flank of tool 3 cuts", operation("chamfer", "outline", tool=3, width=4))
        self.refused("width: is missing", operation("chamfer", "outline", tool=3))
        self.warned(r"tool 3 is too narrow for the whole width at x [\d.]+ y [\d.]+", operation("v_carve", "pocket", tool=3))

    def test_keys_of_other_operations(self):
        self.refused("peck: is a key of drill, not of pocket", operation("pocket", "pocket", depth=1, peck=1))
        self.refused("deph: unknown key; the nearest known one is depth", operation("pocket", "pocket", deph=1))
        self.refused("floor: is no key of profile", operation("profile", "outline", depth=1, floor='["plane.json"]'))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
