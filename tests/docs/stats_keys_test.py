#!/usr/bin/env python3
"""Compares docs/stats.md with the keys that cusp writes.

usage: stats_keys_test.py CUSP TOP
Each key of a command's --stats, on examples of all strategies, is in the first column of its section. Each key of the
page is written by one of these runs, or is a string in the sources of host_tools (a key that only some faults have).
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

JOBS = ("plate/plate", "plate/two_sides", "sign/sign", "adaptive/pocket", "hull_rough/tap", "grid_pocket/rectangle",
        "adaptive_isocurve/trimmed", "rest_machining/second-tool")
SIMULATED = JOBS[:3]
PARTS = ("tutorial/tray.step", "plate/plate.dxf", "parts/sine-hills.json")
STL = "solid a\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n  endloop\n endfacet\nendsolid a\n"
SECTION = re.compile(r"^## `cusp (\w+)`$")
KEY = re.compile(r"`(\w+)`")
OF_A_PLACE = ("_at_mm", "_line", "_tool")


def documented(page):
    """Keys of each section: the words in backticks in the first cell of its rows."""
    keys, section = {}, None
    for line in page.splitlines():
        heading = SECTION.match(line)
        if heading:
            section = keys.setdefault(heading[1], set())
        elif line.startswith("| `") and section is not None:
            section.update(KEY.findall(line.split("|")[1]))
    return keys


def keys_of(value):
    if isinstance(value, dict):
        return set(value).union(*map(keys_of, value.values()))
    return set().union(*map(keys_of, value)) if isinstance(value, list) else set()


def complaints(section, known, written, sources):
    """Keys that the page lacks, and keys that nothing writes."""
    for key in sorted(written - known):
        yield f"cusp {section}: the page lacks {key}"
    for key in sorted(known - written):
        stems = [key[:-len(ending)] for ending in OF_A_PLACE if key.endswith(ending)]
        if not any(f'"{name}"' in sources for name in (key, *stems, *(stem + "_mm" for stem in stems))):
            yield f"cusp {section}: nothing writes {key}"


class StatsPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.page = documented((TOP / "docs/stats.md").read_text())
        cls.sources = "".join(file.read_text() for file in sorted((TOP / "host_tools").rglob("*.cpp")))
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = pathlib.Path(scratch.name)

    def keys_written(self, *arguments):
        stats = self.folder / "stats.json"
        run = subprocess.run([CUSP, *map(str, arguments), "--stats", stats], capture_output=True, text=True, cwd=self.folder)
        self.assertIn(run.returncode, (0, 1), run.stderr)
        return keys_of(json.loads(stats.read_text()))

    def compare(self, section, written):
        self.assertTrue(written)
        self.assertEqual([], list(complaints(section, self.page[section], written, self.sources)))

    def test_a_key_too_few_and_a_key_too_many_are_noticed(self):
        text = "## `cusp plan`\n\n| `passes`, `moves`: `lines` | of `x` |\n## Other\n## `cusp sim`\n| `steps` | |\n"
        self.assertEqual({"plan": {"passes", "moves", "lines"}, "sim": {"steps"}}, documented(text))
        self.assertEqual({"a", "b", "c"}, keys_of({"a": [{"b": 1}, {"c": [2]}]}))
        known = {"passes", "gouge_line", "cell"}
        self.assertEqual(["cusp plan: the page lacks loops", "cusp plan: nothing writes cell"],
                         list(complaints("plan", known, {"passes", "loops"}, 'add("gouge")')))

    def test_plan_verify_and_sim(self):
        planned, verified, simulated = set(), set(), set()
        for job in JOBS:
            file = TOP / "examples" / f"{job}.toml"
            for old in self.folder.glob("*.ngc"):
                old.unlink()
            subprocess.run([CUSP, "plan", file, "-o", "p.ngc", "--stats", "plan.json"], check=True, capture_output=True,
                           cwd=self.folder)
            for stats in self.folder.glob("plan*.json"):
                planned |= keys_of(json.loads(stats.read_text()))
                stats.unlink()
            for program in sorted(self.folder.glob("p*.ngc")):
                verified |= self.keys_written("verify", file, program)
                # A run's keys depend on its moves and tools, not on the strategy.
                simulated |= self.keys_written("sim", program) if job in SIMULATED else set()
        self.compare("plan", planned)
        self.compare("verify", verified)
        self.compare("sim", simulated)

    def test_info(self):
        mesh = self.folder / "mesh.stl"
        mesh.write_text(STL)
        self.compare("info", self.keys_written("info", *(TOP / "examples" / part for part in PARTS), mesh))

    def test_fit(self):
        self.compare("fit", self.keys_written("fit", TOP / "tests/programs/rsq.ngc", "-o", "out.ngc", "--tolerance", "0.01"))

    def test_the_record_of_a_transfer(self):
        source = (TOP / "host_tools/controller/stream/transfer_record.cpp").read_text()
        self.compare("stream", set(re.findall(r'\{"(\w+)"', source)))


if __name__ == "__main__":
    CUSP, TOP = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
