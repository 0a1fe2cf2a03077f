#!/usr/bin/env python3
"""Calls cusp as a user does, mostly with mistakes, and checks exit statuses and messages.

usage: cli_test.py CUSP
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

CUSP = str(pathlib.Path(sys.argv[1]).resolve())

PLANE = {"shape": {"type": "surface", "count": 1, "data": [{
    "degree_u": 1, "degree_v": 1, "size_u": 2, "size_v": 2,
    "knotvector_u": [0, 0, 1, 1], "knotvector_v": [0, 0, 1, 1],
    "control_points": {"points": [[-5, -5, -4], [-5, 45, -4], [55, -5, -4], [55, 45, -4]]}}]}}


def square(low_x, low_y, high_x, high_y):
    corners = [[low_x, low_y], [high_x, low_y], [high_x, high_y], [low_x, high_y], [low_x, low_y]]
    return {"shape": {"type": "curve", "count": 1, "data": [
        {"degree": 1, "knotvector": [0, 0, 1, 2, 3, 4, 4], "control_points": {"points": corners}}]}}


JOB = """
units = "mm"
[tool]
shape = "ball"
diameter = 6
[cutting]
feed = 1000
[stock]
top = 0
[[operation]]
strategy = "contour_pocket"
floor = "floor.json"
boundary = "boundary.json"
scallop = 0.2
"""


class Cli(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.scratch.name)
        self.write("floor.json", json.dumps(PLANE))
        self.write("boundary.json", json.dumps(square(0, 0, 50, 40)))
        self.write("job.toml", JOB)

    def tearDown(self):
        self.scratch.cleanup()

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def run_cusp(self, *arguments):
        return subprocess.run([CUSP, *arguments], cwd=self.folder, text=True, timeout=300,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def expect(self, status, words, *arguments):
        result = self.run_cusp(*arguments)
        self.assertEqual(status, result.returncode, result.stdout)
        self.assertIn(words, result.stdout)

    def refused_plan(self, words, job=JOB):
        self.write("job.toml", job)
        self.expect(2, words, "plan", "job.toml", "-o", "p.ngc")
        self.assertFalse((self.folder / "p.ngc").exists())

    # The floor lies in the top of the stock instead of 4 mm below it: hull_rough has nothing to cut.
    def test_nothing_to_rough_is_a_warning_where_another_operation_cuts(self):
        rough = '[[operation]]\nstrategy = "hull_rough"\nfloor = "floor.json"\nmax_depth = 2\n'
        head, finish = JOB.replace("top = 0", "top = -4").split("[[operation]]")
        why = "hull_rough: nothing is roughed: the part is flat"
        self.write("job.toml", head + rough + "[[operation]]" + finish)
        self.expect(0, "cusp: warning: " + why, "plan", "job.toml", "-o", "p.ngc",
                    "--stats", "p.json")
        stats = json.loads((self.folder / "p.json").read_text())
        self.assertIn(why, stats["warnings"][0])
        self.assertEqual(["contour_pocket"], [o["strategy"] for o in stats["operations"]])
        (self.folder / "p.ngc").unlink()
        self.refused_plan("there is nothing to cut: " + why, head + rough)

    def finish_job(self, top):
        head, finish = JOB.replace("top = 0", f"top = {top}").split("[[operation]]")
        return head + '[[operation]]\nstrategy = "adaptive_isocurve"\nroughing = true\n' \
            'max_depth = 3\nfloor = "floor.json"\nscallop = 0.2\n'

    # The floor is level at z = -4.
    def test_a_stock_far_from_the_part_is_a_warning_with_the_share_of_air(self):
        self.write("job.toml", self.finish_job(30))
        self.expect(0, "stock: its top, z = 30 mm, is 34 mm above the part's, z = -4 mm", "plan",
                    "job.toml", "-o", "p.ngc", "--stats", "p.json")
        self.assertRegex(json.loads((self.folder / "p.json").read_text())["warnings"][0],
                         r"m of feed moves \(9\d %\) are above the part, in air where")
        self.write("job.toml", self.finish_job(-6))
        self.expect(0, "z = -6 mm, is 2 mm below the part's, z = -4 mm", "plan", "job.toml", "-o",
                    "p.ngc")
        self.write("job.toml", self.finish_job(-4))
        said = self.run_cusp("plan", "job.toml", "-o", "p.ngc")
        self.assertNotIn("stock:", said.stdout)

    def test_the_estimate_is_the_time_that_the_core_takes(self):
        self.write("job.toml", self.finish_job(0))
        self.expect(0, "wrote", "plan", "job.toml", "-o", "p.ngc", "--stats", "p.json")
        self.expect(0, "", "sim", "p.ngc", "--stats", "s.json")
        plan = json.loads((self.folder / "p.json").read_text())
        sim = json.loads((self.folder / "s.json").read_text())
        self.assertAlmostEqual(1, plan["estimated_s"] / sim["duration_s"], delta=0.002)
        each = [operation["estimated_s"] for operation in plan["operations"]]
        self.assertEqual(2, len(each))
        self.assertAlmostEqual(plan["estimated_s"], sum(each), delta=1e-6)
        self.assertGreater(min(each), 1)

    def test_help_and_version_are_no_errors(self):
        self.expect(0, "Exit status", "--help")
        self.expect(0, "scallop", "verify", "--help")
        self.expect(0, "cusp 0", "--version")

    def test_wrong_calls_have_status_2(self):
        self.expect(2, "subcommand")
        self.expect(2, "no command \"polish\"", "polish")
        self.expect(2, "required", "plan", "job.toml")
        self.expect(2, "--shine", "verify", "job.toml", "p.ngc", "--shine")

    def test_plans_and_verifies_a_pocket(self):
        self.expect(0, "wrote p.ngc", "plan", "job.toml", "-o", "p.ngc", "--stats", "plan.json")
        stats = json.loads((self.folder / "plan.json").read_text())
        for key in ("strategy", "passes", "levels", "cl_points", "moves", "cut_length_mm",
                    "rapid_length_mm", "retracts", "planning_s", "gouge_bound_mm",
                    "scallop_bound_mm", "estimated_s"):
            self.assertIn(key, stats)
            self.assertIn(key, stats["operations"][0])
        program = (self.folder / "p.ngc").read_text()
        lines = [line for line in program.splitlines() if not line.startswith("(")]
        self.assertEqual("G17 G21 G40 G49 G54 G80 G90 G94", lines[0])
        self.assertEqual("G0 Z5", lines[1])
        self.assertEqual(["M5", "M30"], lines[-2:])
        self.expect(0, "all bounds hold", "verify", "job.toml", "p.ngc", "--stats", "v.json",
                    "--path-picture", "path.svg", "--left-picture", "left.svg")
        figures = json.loads((self.folder / "v.json").read_text())
        self.assertEqual(0, figures["gouge_max_mm"])
        self.assertIn("</svg>", (self.folder / "path.svg").read_text())
        left = (self.folder / "left.svg").read_text()
        self.assertIn(f"{figures['scallop_bound_mm']:.3g}: scallop bound<", left)
        self.assertIn("</svg>", left)
        self.expect(0, "", "sim", "p.ngc", "--picture", "run.svg")
        run = (self.folder / "run.svg").read_text()
        for words in (">Speed, mm/s<", ">Z, % of its limits<", "up to 4000 mm/s³ of jerk is rounding.<"):
            self.assertIn(words, run)

    # A slot of 40 mm through the stock, 50 mm x 40 mm, and back; then a pass beside it at 60 degrees.
    def test_the_engagement_of_any_program(self):
        self.write("job.toml", JOB.replace('"ball"', '"flat"'))
        self.write("slot.ngc", "G21 G90 F600\nG0 Z5\nG0 X5 Y20\nG1 Z-2\nG1 X45\nG1 X5\nG1 Y21.5\nG1 X45\n"
                               "G0 Z5\nM30\n")
        plain = self.run_cusp("verify", "job.toml", "slot.ngc").stdout
        self.assertNotIn("engagement", plain)
        self.run_cusp("verify", "job.toml", "slot.ngc", "--stats", "v.json")
        free = json.loads((self.folder / "v.json").read_text())
        self.assertNotIn("over_engagement_mm", free)
        self.assertNotIn("max_engagement_deg", free)
        said = self.run_cusp("verify", "job.toml", "slot.ngc", "--stats", "v.json", "--max-engagement", "90",
                             "--engagement-picture", "e.svg").stdout
        figures = json.loads((self.folder / "v.json").read_text())
        self.assertEqual(90, figures["max_engagement_deg"])
        self.assertAlmostEqual(180, figures["engagement_limited_max_deg"], delta=0.01)
        self.assertAlmostEqual(180, figures["engagement_max_deg"], delta=0.01)
        self.assertEqual(5, figures["engagement_max_line"])
        x, y, z = figures["engagement_max_at_mm"]
        self.assertTrue(5 <= x <= 45 and abs(y - 20) < 1e-6 and abs(z + 2) < 1e-6)
        self.assertAlmostEqual(40 + 1.5, figures["over_engagement_mm"], delta=1)
        self.assertAlmostEqual(5 + 40, figures["air_mm"], delta=1)
        removed = 2 * (40 * 7.5 + 6 * 1.5 + 28.27)  # a slot of 7.5 mm with round ends
        self.assertAlmostEqual(removed, figures["removed_mm3"], delta=0.02 * removed)
        # F600: 7 + 40 + 40 + 1.5 + 40 mm; rapids at the default machine's 100 mm/s, 50 in z
        minutes = (128.5 / 10 + 20.62 / 100 + 7 / 50) / 60
        self.assertAlmostEqual(1, figures["removed_mm3_per_min"] * minutes / figures["removed_mm3"], delta=0.02)
        for key in ("engagement_max_deg: 180.0", "engagement_max_line: 5", "over_engagement_mm: ", "air_mm: ",
                    "removed_mm3_per_min: "):
            self.assertIn(key, said)
        self.assertIn("over 90°", (self.folder / "e.svg").read_text())
        for value in ("200", "nan", "0", "-5", "inf", "wide"):
            self.expect(2, f"--max-engagement: {value} degrees is not between 1 and 180 degrees", "verify", "job.toml",
                        "slot.ngc", "--max-engagement=" + value)

    def examples_with(self, settings):
        demo = self.folder / "examples" / "demo"
        demo.mkdir(parents=True, exist_ok=True)
        for name in ("floor.json", "boundary.json"):
            (demo / name).write_text((self.folder / name).read_text())
        (demo / "pocket.toml").write_text(JOB)
        (demo / "mill.settings").write_text(settings)

    def test_the_demo_writes_its_files_and_says_what_came_out(self):
        self.examples_with("$100=200\n")
        self.expect(0, "deepest cut", "demo", "--out", "a/b", "--examples", "examples")
        out = self.folder / "a" / "b"
        files = {"RUN.html", "left.svg", "path.svg", "plan.json", "pocket.ngc", "sim.json", "verify.json", "verify.txt"}
        self.assertEqual(files, {file.name for file in out.iterdir()})
        self.expect(0, "pocket.vcd", "demo", "--traces", "--out", "a/traced", "--examples", "examples")
        traced = {file.name for file in (self.folder / "a" / "traced").iterdir()}
        self.assertEqual(files | {"pocket.vcd", "samples.csv"}, traced)
        self.assertTrue((out / "verify.txt").read_text().endswith("all bounds hold\n"))
        cut, run = (json.loads((out / name).read_text()) for name in ("verify.json", "sim.json"))
        self.assertEqual([cut["cut_depth_max_mm"]], [tool["cut_depth_max_mm"] for tool in cut["tools"]])
        self.assertEqual([1], [tool["number"] for tool in run["tools"]])
        self.assertEqual(0, run["tool_changes"])
        picture = (out / "path.svg").read_text()
        for words in (">T1 ball 6 mm<", ">10 mm<", ">tip z, mm<", ">rapid<"):
            self.assertIn(words, picture)
        self.run_cusp("plan", "examples/demo/pocket.toml", "-o", "p.ngc")
        self.assertEqual((self.folder / "p.ngc").read_text(), (out / "pocket.ngc").read_text())

    def test_the_demo_finds_what_is_wrong(self):
        self.examples_with("$20=1\n$22=1\n$130=20\n")
        self.expect(1, "ALARM", "demo", "--examples", "examples")
        self.examples_with("$100=0\n")
        self.expect(2, "mill.settings", "demo", "--out", "new", "--examples", "examples")
        self.expect(2, "--examples nowhere", "demo", "--out", "new", "--examples", "nowhere")
        self.assertFalse((self.folder / "new").exists())
        self.examples_with("")
        self.write("file", "")
        self.expect(2, "--out file: can't be written: Not a directory", "demo", "--out", "file", "--examples", "examples")
        self.expect(2, "--out file/x: can't be written: Not a directory", "demo", "--out", "file/x", "--examples", "examples")

    def test_a_lowered_program_is_found_wrong(self):
        self.run_cusp("plan", "job.toml", "-o", "p.ngc")
        text = (self.folder / "p.ngc").read_text()
        self.write("low.ngc", text.replace("G90 G94\n", "G90 G94\nG92 Z0.1\n", 1))
        self.expect(1, "broken: ", "verify", "job.toml", "low.ngc")

    def test_files_that_are_missing_or_broken(self):
        self.expect(2, "none.ngc", "verify", "job.toml", "none.ngc")
        self.expect(2, "nowhere.toml", "plan", "nowhere.toml", "-o", "p.ngc")
        self.refused_plan("gone.json", JOB.replace("floor.json", "gone.json"))
        self.refused_plan("not TOML", JOB + "[[[")
        self.write("floor.json", "{")
        self.refused_plan("floor.json: not JSON")
        self.write("floor.json", "\x00\xff" * 50)
        self.refused_plan("floor.json: not JSON")
        self.refused_plan("floor.obj", JOB.replace("floor.json", "floor.obj"))

    def with_floor(self, **changes):
        floor = json.loads(json.dumps(PLANE))
        shape = floor["shape"]["data"][0]
        control = shape["control_points"]
        for key, value in changes.items():
            (control if key in ("points", "weights") else shape)[key] = value
        self.write("floor.json", json.dumps(floor))

    def test_surfaces_that_are_none(self):
        points = PLANE["shape"]["data"][0]["control_points"]["points"]
        self.with_floor(weights=[1, 1, -2, 1])
        self.refused_plan("weight 2 is -2, it must be above 0")
        self.with_floor(knotvector_u=[0, 1, 0, 1])
        self.refused_plan("knotvector_u")
        self.with_floor(points=[[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]])
        self.refused_plan("has no area")
        self.with_floor(points=points[:3])
        self.refused_plan("3 control points")

    def test_trims_that_contradict_each_other(self):
        def loop(*corners):
            corners = [list(corner) for corner in corners + corners[:1]]
            knots = [0, *range(len(corners)), len(corners) - 1]
            return {"type": "spline", "reversed": 0, "degree": 1, "knotvector": knots,
                    "control_points": {"points": corners}}

        outer = loop((.1, .1), (.4, .1), (.4, .4), (.1, .4))
        for words, trims in (
                ("leaves the domain", [loop((.1, .1), (1.4, .1), (.4, .4))]),
                ("cross", [loop((.1, .1), (.4, .4), (.4, .1), (.1, .4))]),
                ("cross", [outer, loop((.2, .2), (.2, .6), (.6, .2))]),
                ("outside every outer loop", [outer, loop((.6, .6), (.6, .9), (.9, .6))]),
                ("a hole runs clockwise", [outer, loop((.2, .2), (.3, .2), (.2, .3))])):
            self.with_floor(trims={"count": len(trims), "data": trims})
            self.refused_plan(words)
        self.with_floor(trims={"count": 3, "data": [outer]})
        self.refused_plan("count is 3, data holds 1")

    def test_a_floor_from_a_mesh(self):
        corners = ("-5 -5 -4", "55 -5 -4", "55 45 -5", "-5 45 -5")
        text = "solid sheet\n"
        for facet in ((0, 1, 2), (0, 2, 3), (0, 1, 1)):
            text += "facet normal 0 0 1\nouter loop\n"
            text += "".join(f"vertex {corners[k]}\n" for k in facet)
            text += "endloop\nendfacet\n"
        self.write("floor.stl", text + "endsolid sheet\n")
        job = JOB.replace("floor.json", "floor.stl")
        self.write("job.toml", job)
        self.expect(0, "1 facet without area left out", "plan", "job.toml", "-o", "p.ngc")
        self.expect(0, "all bounds hold", "verify", "job.toml", "p.ngc")
        (self.folder / "p.ngc").unlink()
        self.write("floor.stl", text)
        self.refused_plan("floor.stl:23: truncated", job)
        self.write("floor.stl", text.replace("55 -5 -4", "nan -5 -4"))
        self.refused_plan("floor.stl:5: a corner has x = nan mm", job)

    def test_cad_files_that_are_none(self):
        self.write("floor.step", "no model")
        self.refused_plan("floor.step: ", JOB.replace("floor.json", "floor.step"))

    def test_an_output_that_cannot_be_written(self):
        self.expect(2, "can't be written", "plan", "job.toml", "-o", "no/such/folder/p.ngc")

    def test_loops_that_bound_nothing(self):
        broken = square(0, 0, 50, 40)
        broken["shape"]["data"][0]["control_points"]["points"][-1] = [0, 5]
        self.write("boundary.json", json.dumps(broken))
        self.refused_plan("open")

    def with_boundary(self, *corners):
        loop = square(0, 0, 50, 40)
        curve = loop["shape"]["data"][0]
        curve["control_points"]["points"] = [list(corner) for corner in corners]
        curve["knotvector"] = [0, *range(len(corners)), len(corners) - 1]
        self.write("boundary.json", json.dumps(loop))

    def test_boundaries_that_are_no_loops(self):
        self.with_boundary((0, 0), (50, 40), (50, 0), (0, 20), (0, 0))
        self.refused_plan("boundary.json: the loop crosses itself near x 16.667 y 13.333")
        self.with_boundary((0, 0), (50, 0), (50, 0), (50, 0))
        self.refused_plan("boundary.json")
        self.with_boundary((5, 5), (5, 5))
        self.refused_plan("boundary.json")

    def test_points_that_stand_twice(self):
        self.with_boundary((0, 0), (50, 0), (50, 0), (50, 40), (0, 40), (0, 0))
        self.refused_plan("boundary.json: a curve has no length at (50, 0) mm")

    def test_islands_that_cross(self):
        islands = JOB + 'islands = ["one.json", "two.json"]\n'
        self.write("one.json", json.dumps(square(20, 20, 30, 30)))
        for corners, words in (((25, 25, 35, 35), "one.json: crosses"),
                               ((45, 10, 60, 15), "boundary.json: crosses"),
                               ((22, 22, 28, 28), "lies inside another"),
                               ((20, 20, 30, 30), "one.json")):
            self.write("two.json", json.dumps(square(*corners)))
            self.refused_plan(words, islands)

    def test_a_floor_that_does_not_reach_under_the_pocket(self):
        self.write("boundary.json", json.dumps(square(0, 0, 50, 60)))
        self.refused_plan("floor.json: the floor does not cover the pocket at")

    def test_an_island_outside_the_boundary(self):
        self.write("island.json", json.dumps(square(80, 80, 90, 90)))
        self.refused_plan("outside the boundary", JOB + 'islands = ["island.json"]\n')

    def test_a_tool_too_large_for_the_pocket(self):
        self.refused_plan("fits nowhere", JOB.replace("diameter = 6", "diameter = 60"))

    def test_keys_and_numbers_out_of_range(self):
        self.refused_plan("nearest known one is scallop", JOB + "skallop = 1\n")
        self.refused_plan("feed: is -1000", JOB.replace("feed = 1000", "feed = -1000"))
        self.refused_plan("known are", JOB.replace("contour_pocket", "contur_pocket"))

    def test_tolerances_out_of_range_of_the_tool(self):
        limit = " is not in the range above 0 to 0.75 mm"
        for key in ("plan_tolerance", "floor_tolerance"):
            job = JOB.replace("scallop = 0.2", "scallop = 2.5") + f"{key} = 2\n"
            self.refused_plan(f"job.toml: operation 1: contour_pocket: {key} 2 mm" + limit, job)
            self.refused_plan(f"{key}: is 0", JOB + f"{key} = 0\n")
            self.refused_plan(key, JOB + f'{key} = "wide"\n')
        self.refused_plan("scallop 2.8 mm is not", JOB.replace("scallop = 0.2", "scallop = 2.8"))
        self.refused_plan("not above the floor_tolerance", JOB + "floor_tolerance = 0.2\n")
        self.refused_plan("max_depth: is -1", JOB + "max_depth = -1\n")
        self.refused_plan("layers", JOB + "layers = [3, 2]\n")
        self.refused_plan("allowance 3.5 mm is not in", JOB + "max_depth = 1\nallowance = 3.5\n")

    def test_programs_that_cannot_be_run(self):
        for name, text, words in (
                ("unknown.ngc", "G0 X1\nG77 X2\n", "unknown.ngc:2"),
                ("arc.ngc", "G0 X0 Y0\nG2 X10 Y0 I9 J3 F100\n", "arc.ngc:2"),
                ("number.ngc", "G0 X99999999999999\n", "number.ngc:1"),
                ("feed.ngc", "G1 X1\n", "feed.ngc:1"),
                ("curve.ngc", "F100\nG6.2 P3 K0 X0 Y0\nK0 X1 Y1\n", "curve.ngc"),
                ("tool.ngc", "T9\nG0 Z-1\n", "T9"),
                ("empty.ngc", "", "no move")):
            self.write(name, text)
            self.expect(2, words, "verify", "job.toml", name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
