#!/usr/bin/env python3
"""Applies the blocks of docs/add_a_strategy.md to a copy of the tree: the checks pass, and the strategy plans.

usage: add_a_strategy_test.py TOP PLAN_WITH_IT CUSP
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import page_blocks

JOB = """units = "mm"
[tool]
shape = "ball"
diameter = 6.0
[cutting]
feed = 1000.0
[stock]
top = 0.0
bottom = -40.0
[[operation]]
strategy = "{strategy}"
floor = ["{parts}/suh-lee-floor.json"]
boundary = "{parts}/suh-lee-boundary.json"
{keys}
"""


class Page(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def plan(self, strategy, keys):
        job = self.folder / "job.toml"
        job.write_text(JOB.format(strategy=strategy, parts=TOP / "examples/parts", keys=keys))
        program = self.folder / "job.ngc"
        run = subprocess.run([PLAN_WITH_IT, job, program], capture_output=True, text=True)
        return run, program

    def test_keeps_the_checks_of_the_tree(self):
        tree = self.folder / "tree"
        for name in ("firmware", "hal", "boards", "host_tools", "docs", "cmake", "tests/checks"):
            shutil.copytree(TOP / name, tree / name, ignore=shutil.ignore_patterns("node_modules"))
        self.assertEqual(page_blocks.main(TOP / "docs/add_a_strategy.md", TOP, tree, []), 0)
        for check in ("includes.py", "front_doors.py", "type_names.py"):
            run = subprocess.run([sys.executable, tree / "tests/checks" / check, tree], capture_output=True, text=True)
            self.assertEqual(run.returncode, 0, f"{check}: {run.stdout}{run.stderr}")

    def test_plans_a_program_that_cuts_nothing_below_the_floor(self):
        run, program = self.plan("trace", "point_spacing = 0.5\nfloor_tolerance = 0.02")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("trace: gouge at most 0.0", run.stdout)
        lines = program.read_text().splitlines()
        self.assertIn("(trace: one pass along the boundary)", lines)
        self.assertGreater(sum(line.startswith(("G1", "X", "Y")) for line in lines), 1000)
        # the pocket's own strategy gives verify a job it knows: the same floor, tool and tolerance
        job = self.folder / "floor.toml"
        job.write_text(JOB.format(strategy="adaptive_isocurve", parts=TOP / "examples/parts", keys="iso_distance = 1.0")
                       .replace("boundary", "# boundary"))
        run = subprocess.run([CUSP, "verify", job, program, "--grid", "1", "--step", "0.5"], capture_output=True, text=True)
        gouge = [float(line.split(": ")[1]) for line in run.stdout.splitlines() if line.startswith("ball_gouge_max_mm")]
        self.assertEqual(len(gouge), 1, run.stdout + run.stderr)
        self.assertLessEqual(gouge[0], 0.02)

    def test_refuses_what_the_page_says(self):
        run, _ = self.plan("trace", "point_spacing = 40.0\nfloor_tolerance = 0.0001")
        self.assertEqual(run.returncode, 2)
        self.assertIn("lower point_spacing", run.stderr)
        run, _ = self.plan("grid_pocket", "grid = [1.0, 1.0]\npoint_spacing = 1.0")
        self.assertEqual(run.returncode, 2)
        self.assertIn("is a key of trace, not of grid_pocket", run.stderr)

    def test_a_block_that_does_not_fit_is_named(self):
        page = self.folder / "page.md"
        page.write_text("text\n```diff file=host_tools/CMakeLists.txt\n add_subdirectory(no_such)\n+more\n```\n")
        with self.assertRaisesRegex(page_blocks.PageFault, "page.md:2: what is to be replaced occurs 0 times in host_tools/CMakeLists.txt"):
            page_blocks.applied(page, TOP)


if __name__ == "__main__":
    TOP, PLAN_WITH_IT, CUSP = (pathlib.Path(name).resolve() for name in sys.argv[1:4])
    unittest.main(argv=sys.argv[:1])
