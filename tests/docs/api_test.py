#!/usr/bin/env python3
"""The index of the public headers is made without a warning, and a wrong comment gives one.

usage: api_test.py TOP
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

HEADER = """// Vectors.
#pragma once

// The length.
//
//   {name}  of which, mm
double length(double side);
"""


class Index(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def make(self, top):
        run = subprocess.run(["sh", str(top / "docs/api.sh"), str(self.folder / "out")], capture_output=True, text=True)
        return run.returncode, run.stdout + run.stderr

    def test_covers_the_headers_of_the_tree_without_a_warning(self):
        status, said = self.make(TOP)
        self.assertEqual(status, 0, said)
        html = self.folder / "out/html"
        classes = "\n".join(page.name for page in html.glob("class*.html"))
        for name in ("PartModel", "DropCutter", "Planner", "RegionOffset"):
            self.assertRegex(classes, rf"{name}\.html")
        self.assertIn("the distance of a tool from it, exact and proved", (html / "part__model_8hpp.html").read_text())

    def test_refuses_a_parameter_that_the_function_lacks(self):
        tree = self.folder / "tree"
        (tree / "docs").mkdir(parents=True)
        (tree / "firmware/base").mkdir(parents=True)
        for folder in ("hal", "boards/sim", "host_tools"):
            (tree / folder).mkdir(parents=True)
        for name in ("api.sh", "api_filter.py", "Doxyfile"):
            shutil.copy(TOP / "docs" / name, tree / "docs")
        (tree / "firmware/base/vec.hpp").write_text(HEADER.format(name="side"))
        self.assertEqual(self.make(tree)[0], 0)
        (tree / "firmware/base/vec.hpp").write_text(HEADER.format(name="width"))
        status, said = self.make(tree)
        self.assertEqual(status, 1)
        self.assertIn("firmware/base/vec.hpp:7", said)
        self.assertIn("width", said)


if __name__ == "__main__":
    TOP = pathlib.Path(sys.argv[1]).resolve()
    unittest.main(argv=sys.argv[:1])
