#!/usr/bin/env python3
"""Ctrl-C and the end of memory: `cusp plan` ends at once, reports its progress, and leaves no half-written program.

usage: limits_test.py CUSP [--sanitized]
--sanitized: CUSP was built with a sanitizer, which leaves its memory without a limit.
"""
import json
import math
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
CUSP = ""
ANSWER = 1.0  # s, from Ctrl-C to the end
MEMORY = 60  # MB, less than the job needs


def waves(folder, n=24, side=80.0):
    """A bicubic surface of many waves, and a job that takes seconds."""
    knots = [0.0] * 4 + [k / (n - 3) for k in range(1, n - 3)] + [1.0] * 4
    points = [[side * i / (n - 1), side * j / (n - 1), -4 + 3 * math.sin(1.9 * i) * math.cos(1.7 * j)]
              for j in range(n) for i in range(n)]
    surface = {"type": "spline", "rational": False, "dimension": 3, "degree_u": 3, "degree_v": 3, "size_u": n, "size_v": n,
               "knotvector_u": knots, "knotvector_v": knots, "control_points": {"points": points}}
    (folder / "waves.json").write_text(json.dumps({"shape": {"type": "surface", "count": 1, "data": [surface]}}))
    (folder / "job.toml").write_text(
        '[tool]\nshape = "ball"\ndiameter = 6\n[cutting]\nfeed = 1200\n[[operation]]\n'
        'strategy = "adaptive_isocurve"\nfloor = ["waves.json"]\nscallop = 0.004\nfloor_tolerance = 0.001\n')


class Limits(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.addCleanup(self.place.cleanup)
        self.folder = pathlib.Path(self.place.name)
        waves(self.folder)
        self.program = self.folder / "out.ngc"
        self.program.write_text("what was there before\n")

    def start(self, *words):
        return subprocess.Popen([CUSP, "plan", "job.toml", "-o", self.program, *words], cwd=self.folder,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def interrupted(self, number, threads):
        run = self.start("--threads", threads)
        self.assertIn("operation 1 of 1", run.stdout.readline())
        time.sleep(0.5)
        self.assertIsNone(run.poll(), "the job is too short for this test")
        run.send_signal(number)
        begin = time.monotonic()
        _, said = run.communicate(timeout=60)
        wall = time.monotonic() - begin
        self.assertEqual(run.returncode, -number)
        self.assertRegex(said.splitlines()[-1], r"^cusp: interrupted while planning operation 1 of 1 "
                         r"\(adaptive_isocurve\) of job.toml.*: nothing is written$")
        self.assertEqual(self.program.read_text(), "what was there before\n")
        return wall

    def test_ctrl_c_ends_planning_at_once(self):
        for threads in ("1", "2"):
            # a machine that runs other work may be slow to run this process at all: the best of three
            self.assertLess(min(self.interrupted(signal.SIGINT, threads) for _ in range(3)), ANSWER)

    def test_a_polite_kill_does_the_same(self):
        self.interrupted(signal.SIGTERM, "1")

    @unittest.skipIf("--sanitized" in sys.argv, "a sanitizer's memory has no limit")
    def test_the_end_of_memory_names_the_place(self):
        run = self.start("--memory", f"{MEMORY}MB")
        _, said = run.communicate(timeout=300)
        self.assertEqual(run.returncode, 2, said)
        line = said.splitlines()[-1]
        self.assertRegex(line, r"^cusp: out of memory \(--memory 60 MB\) while planning operation 1 of 1 ")
        self.assertIn("waves.json", line)
        self.assertIn("face 1", line)
        self.assertEqual(self.program.read_text(), "what was there before\n")

    def test_memory_is_a_size(self):
        run = self.start("--memory", "much")
        _, said = run.communicate(timeout=60)
        self.assertEqual(run.returncode, 2)
        self.assertIn("--memory", said)


if __name__ == "__main__":
    CUSP = sys.argv[1]
    unittest.main(argv=sys.argv[:1])
