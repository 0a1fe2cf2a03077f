#!/usr/bin/env python3
"""Plans parts without a job file: messages, the result of the printed job, errors.

usage: one_line_test.py CUSP [--without-cad]
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

from step_solid import block_with_slope, step_solid

CUSP = str(pathlib.Path(sys.argv[1]).resolve())
WITH_CAD = "--without-cad" not in sys.argv
PARTS = pathlib.Path(__file__).resolve().parents[1] / "parts"


def plane(left, right):
    """60 x 40 mm, from z = left to z = right."""
    return json.dumps({"shape": {"type": "surface", "count": 1, "data": [{
        "degree_u": 1, "degree_v": 1, "size_u": 2, "size_v": 2,
        "knotvector_u": [0, 0, 1, 1], "knotvector_v": [0, 0, 1, 1],
        "control_points": {"points": [[0, 0, left], [0, 40, left],
                                      [60, 0, right], [60, 40, right]]}}]}})


def square(low, high):
    corners = [[low, low], [high, low], [high, high], [low, high], [low, low]]
    return json.dumps({"shape": {"type": "curve", "count": 1, "data": [
        {"degree": 1, "knotvector": [0, 0, 1, 2, 3, 4, 4], "control_points": {"points": corners}}]}})


def mesh(height):
    """A roof over 20 x 20 mm as STL."""
    corners = {"a": (0, 0, 0), "b": (20, 0, 0), "c": (20, 20, 0), "d": (0, 20, 0),
               "e": (10, 10, height)}
    text = "solid roof\n"
    for facet in ("abe", "bce", "cde", "dae"):
        text += "facet normal 0 0 1\nouter loop\n"
        text += "".join("vertex {} {} {}\n".format(*corners[k]) for k in facet)
        text += "endloop\nendfacet\n"
    return text + "endsolid roof\n"


def moves_of(program):
    """All but the header, which names the job."""
    lines = program.splitlines()
    while lines[0].startswith("("):
        lines.pop(0)
    return lines


class OneLine(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name)
        self.write("ramp.json", plane(-10, 5))
        self.write("plate.json", plane(7, 7))

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def plan(self, *arguments):
        return subprocess.run([CUSP, "plan", "--estimate-times", *map(str, arguments)], cwd=self.folder, text=True,
                              timeout=300, stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def program(self, *arguments):
        """Plans, and compares with what the printed job gives."""
        done = self.plan(*arguments, "-o", "p.ngc")
        self.assertEqual(0, done.returncode, done.stderr)
        printed = self.plan(*arguments, "--print-job")
        self.assertEqual(0, printed.returncode, printed.stderr)
        self.write("job.toml", printed.stdout)
        from_job = self.plan("job.toml", "-o", "job.ngc")
        self.assertEqual(0, from_job.returncode, from_job.stderr)
        program = (self.folder / "p.ngc").read_text()
        self.assertEqual(moves_of((self.folder / "job.ngc").read_text()), moves_of(program))
        return program, done.stdout

    def verified(self):
        result = subprocess.run([CUSP, "verify", "job.toml", "p.ngc"], cwd=self.folder, text=True,
                                timeout=300, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(0, result.returncode, result.stdout)
        self.assertIn("all bounds hold", result.stdout)
        return result.stdout

    def refused(self, words, *arguments, output=("-o", "p.ngc")):
        result = self.plan(*arguments, *output)
        self.assertEqual(2, result.returncode, result.stdout + result.stderr)
        self.assertIn(words, result.stderr)
        self.assertFalse((self.folder / "p.ngc").exists())

    def test_one_tool_roughs_and_finishes_a_deep_part(self):
        program, said = self.program("ramp.json", "--tool", "ball:6", "--scallop", 0.05)
        self.assertIn("part: 60 x 40 mm from above, 15 deep; the file names no unit", said)
        self.assertIn("top z = 5 (the part's", said)
        self.assertIn("feed 1200 mm/min, plunge feed 300, spindle 12000 rpm: defaults", said)
        self.assertIn("roughing: ball 6 mm, layers of at most 3 mm (half the diameter", said)
        self.assertIn("finish: adaptive_isocurve, ball 6 mm, scallop 0.05 mm, tolerance 0.01", said)
        self.assertIn("one-line job of ramp.json", program.splitlines()[0])
        self.assertIn("\nG0 Z10\n", program)
        self.verified()

    def test_each_tool_has_a_feed_of_its_own(self):
        program, said = self.program("ramp.json", "--tool", "flat:6", "ball:3", "--scallop", 0.05)
        self.assertIn("feed 1200 (flat 6 mm), 600 (ball 3 mm) mm/min, "
                      "plunge feed 300 (flat 6 mm), 150 (ball 3 mm)", said)
        rough, finish = program.split("T2", 1)
        self.assertIn("F1200", rough)
        self.assertNotIn("F600", rough)
        self.assertIn("F600", finish)
        self.assertNotIn("F1200", finish)
        program, said = self.program("ramp.json", "--tool", "flat:6", "ball:3", "--scallop", 0.05,
                                     "--feed", 900)
        self.assertIn("feed 900 mm/min, plunge feed 225", said)
        self.assertEqual({"F900", "F225"}, {word for line in moves_of(program)
                                            for word in line.split() if word.startswith("F")})

    def test_two_tools_rough_and_finish_whichever_way_they_are_given(self):
        program, said = self.program("ramp.json", "--tool", "flat:8", "ball:6", "--scallop", 0.05)
        self.assertIn("roughing: flat 8 mm, layers of at most 4 mm", said)
        self.assertEqual(["T1", "T2"], [word for line in program.splitlines()
                                        for word in line.split() if word in ("T1", "T2")])
        self.verified()
        again, _ = self.program("--scallop", 0.05, "--tool", "flat:8", "--tool", "ball:6",
                                "ramp.json")
        self.assertEqual(program, again)

    def nothing_to_cut(self, *arguments):
        done = self.plan(*arguments, "--scallop", 0.05, "-o", "p.ngc")
        self.assertEqual(2, done.returncode, done.stderr)
        self.assertIn("roughing: none", done.stdout)
        self.assertIn("there is nothing to cut: no surface is below the stock's top", done.stderr)

    def test_flat_parts_as_high_as_the_stock_need_nothing(self):
        for tools in (["ball:6"], ["flat:8", "ball:6"]):
            self.nothing_to_cut("plate.json", "--tool", *tools)

    def test_stock_over_a_flat_part_is_roughed(self):
        _, said = self.program("plate.json", "--tool", "flat:8", "ball:6", "--scallop", 0.05,
                               "--stock-top", 12)
        self.assertIn("roughing: flat 8 mm", said)
        self.verified()

    def test_a_mesh(self):
        self.write("roof.stl", mesh(8))
        _, said = self.program("roof.stl", "--tool", "flat:6", "ball:4", "--scallop", 0.05)
        self.assertIn("part: 20 x 20 mm from above, 8 deep", said)
        self.verified()

    def test_every_end_finishes_a_mesh(self):
        self.write("pit.stl", mesh(-5))
        for end in ("bull:4:1", "taper:4:8:0.8"):
            _, said = self.program("pit.stl", "--tool", "flat:6", end, "--scallop", 0.05)
            self.assertIn("scallop at most 0.0500 mm where the end can touch", said)
            self.assertIn("scallop of tool 2 is proved where its end can touch", self.verified())

    def test_a_flat_end_finishes_slanted_ground_to_a_scallop(self):
        self.write("pit.stl", mesh(-5))
        _, said = self.program("pit.stl", "--tool", "flat:6", "flat:4", "--scallop", 0.1)
        self.assertIn("finish: adaptive_isocurve, flat 4 mm", said)
        self.assertIn("scallop of tool 2 is proved where its end can touch", self.verified())

    def test_several_parts_are_one(self):
        self.write("roof.stl", mesh(8))
        _, said = self.program("roof.stl", "plate.json", "--tool", "ball:6", "--scallop", 0.05)
        self.assertIn("part: 60 x 40 mm from above, 8 deep", said)

    @unittest.skipUnless(WITH_CAD, "this build reads no STEP")
    def test_step_solids_wherever_they_lie(self):
        for bottom, low, high in ((0, 20, 30), (-50, -45, -38)):
            self.write("part.step", step_solid(block_with_slope(40, 30, bottom, low, high)))
            program, said = self.program("part.step", "--tool", "ball:6", "--scallop", 0.05)
            self.assertIn(f"part: 40 x 30 mm from above, {high - low} deep; the unit is the "
                          "file's own", said)
            self.assertIn(f"top z = {high} (", said)
            self.assertIn(f"\nG0 Z{high + 5}\n", program)
            self.verified()
        self.write("part.step", step_solid(block_with_slope(40, 30, 0, 30, 30)))
        self.nothing_to_cut("part.step", "--tool", "ball:6")

    def test_pockets_have_a_boundary(self):
        self.write("outer.json", square(5, 35))
        self.write("inner.json", square(15, 22))
        self.write("floor.json", plane(-9, -6))
        call = ("floor.json", "--boundary", "outer.json", "--island", "inner.json",
                "--scallop", 0.2)
        program, said = self.program(*call, "--tool", "flat:6", "ball:4")
        self.assertIn("finish: contour_pocket, ball 4 mm", said)
        self.assertIn("top z = 0", said)
        self.assertIn("\nG0 Z5\n", program)
        self.verified()
        _, said = self.program(*call, "--tool", "flat:6")
        self.assertIn("finish: contour_pocket, flat 6 mm", said)
        self.verified()

    def test_inches(self):
        self.write("small.json", plane(0, 0.05))
        program, said = self.program("small.json", "--units", "inch", "--tool", "ball:2",
                                     "--scallop", 0.05)
        self.assertIn("part: 60 x 40 inch", said)
        self.assertIn("G20", moves_of(program)[0])
        self.assertIn("feed 47 inch/min", said)

    def test_arcs_and_planes(self):
        program, _ = self.program("ramp.json", "--tool", "ball:6", "--scallop", 0.05,
                                  "--moves", "nurbs", "--no-roughing")
        self.assertIn("G6.2", program)
        _, said = self.program("ramp.json", "--tool", "ball:6", "--scallop", 0.05,
                               "--strategy", "parallel_planes", "--no-roughing")
        self.assertIn("finish: parallel_planes", said)

    def test_the_job_alone_is_printed_and_programs_go_on_beside_it(self):
        call = ("ramp.json", "--tool", "ball:6", "--scallop", 0.05, "--print-job")
        alone = self.plan(*call)
        self.assertTrue(alone.stdout.startswith("#"), alone.stdout)
        self.assertIn("part: 60 x 40", alone.stderr)
        both = self.plan(*call, "-o", "p.ngc", "--stats", "p.json")
        self.assertEqual(alone.stdout, both.stdout)
        self.assertIn("wrote p.ngc", both.stderr)
        stats = json.loads((self.folder / "p.json").read_text())
        self.assertEqual("one-line job of ramp.json", stats["job"])

    def test_a_job_works_from_its_own_folder(self):
        (self.folder / "parts").mkdir()
        self.write("parts/deep.json", plane(-10, 5))
        self.program("parts/deep.json", "--tool", "ball:6", "--scallop", 0.1)

    def test_jobs_and_parts_do_not_mix(self):
        self.write("job.toml", "")
        self.refused("job.toml: is a job, which names its own parts", "job.toml", "ramp.json")
        self.refused("--tool: is for parts without a job file", "job.toml", "--tool", "ball:6")
        self.refused("--print-job: is for parts", "job.toml", "--print-job")
        self.refused("--no-roughing: is for parts", "job.toml", "--no-roughing")

    def test_parts_that_are_none(self):
        tool = ("--tool", "ball:6", "--scallop", "0.05")
        self.refused("gone.json: can't be read", "gone.json", *tool)
        self.refused("part.ply: parts end in .json", "part.ply", *tool)
        self.refused("plate.dxf: a drawing is a boundary", "plate.dxf", "ramp.json", *tool)
        self.refused("--scallop: is for surfaces", "plate.dxf", *tool)
        self.refused("a job file or a part is required", *tool)
        self.write("cut.json", "{")
        self.refused("cut.json: not JSON", "cut.json", *tool)
        wall = json.loads(plane(0, 0))
        wall["shape"]["data"][0]["control_points"]["points"] = [[0, 0, 0], [0, 0, 9], [50, 0, 0],
                                                                [50, 0, 9]]
        self.write("wall.json", json.dumps(wall))
        self.refused("there is nothing to cut", "wall.json", *tool)
        self.refused("gone.json: can't be read", "ramp.json", "--boundary", "gone.json", *tool)
        self.refused("--island: needs --boundary", "ramp.json", *tool, "--island", "i.json")

    def test_tools_that_are_none(self):
        for words, tool in (
                ("no shape is named \"cone\"", "cone:6"), ("the diameter is missing", "ball"),
                ("the diameter is missing", "ball:"), ("the diameter is 0", "ball:0"),
                ("the diameter is -6", "ball:-6"), ("\"nan\" is no diameter", "ball:nan"),
                ("the corner radius is 4, the tool's radius only 3", "bull:6:4"),
                ("its diameter is 200 mm, the part is only 60 x 40", "ball:200"),
                ("a taper has a diameter, the angle", "taper:6:5"),
                ("--tool taper:6:5:0.5: a taper only finishes", "taper:6:5:0.5")):
            self.refused(words, "ramp.json", "--tool", tool, "--scallop", "0.05")
        self.refused("--tool: is missing", "ramp.json", "--scallop", "0.05")
        self.refused("--tool: is missing", "ramp.json")
        self.refused("--tool: a tool is missing before -o", "ramp.json", "--tool")

    def test_numbers_and_outputs_that_are_none(self):
        call = ("ramp.json", "--tool", "ball:6")
        self.refused("--scallop: is missing", *call)
        self.refused("--scallop: is nan", *call, "--scallop", "nan")
        self.refused("--scallop: is -1", *call, "--scallop", "-1")
        self.refused("--scallop", *call, "--scallop", "high")
        self.refused("below the --scallop of 0.05", *call, "--scallop", "0.05", "--tolerance", "1")
        self.refused("rises to z = 5", *call, "--scallop", "0.05", "--stock-top", "-3")
        self.refused("--units", *call, "--scallop", "0.05", "--units", "feet")
        self.refused("-o is required", *call, "--scallop", "0.05", output=())
        self.refused("can't be written", *call, "--scallop", "0.05", output=("-o", "no/p.ngc"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
