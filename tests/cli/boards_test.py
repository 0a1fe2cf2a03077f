#!/usr/bin/env python3
"""Circuit boards from Gerber and Excellon files: what is read, the job of one line, what is refused.

usage: boards_test.py CUSP
"""
import math
import pathlib
import re
import sys
import unittest

from cusp_case import CuspCase

BOARD = pathlib.Path(__file__).resolve().parents[2] / "examples/board"
HEAD = "%FSLAX34Y34*%\n%MOMM*%\n%ADD10C,0.4*%\nD10*\n"
HOLES = ((5, 5, 0.8), (10.5, 5, 0.8), (-3.25, 7.5, 1.1))


class Boards(CuspCase):
    def refused(self, name, text, *wanted):
        self.write(name, text)
        said = self.cusp(2, "info", name)
        for words in (name, *wanted):
            self.assertIn(words, said)

    def test_a_board_of_one_line_is_isolated_drilled_and_cut_out(self):
        for file in BOARD.glob("board*"):
            (self.folder / file.name).write_bytes(file.read_bytes())
        call = ("plan", "board-F_Cu.gbr", "board.drl", "board-Edge_Cuts.gbr", "--tool", "flat:0.2", "drill:0.8", "drill:1",
                "flat:0.8", "--depth", "1.7", "--tabs", "3", "--moves", "arcs")
        said = self.cusp(0, *call, "-o", "b.ngc")
        for words in ("board-F_Cu.gbr#copper: 8 copper islands and 1 opening: profile outside, flat 0.2 mm, 0.1 mm deep",
                      "board.drl#holes: 12 holes of 0.8 mm: drill", "board.drl#holes: 5 holes of 1 mm: drill",
                      "board.drl#slot_holes: 1 hole: profile inside, flat 0.8 mm", "board-Edge_Cuts.gbr: 1 outline"):
            self.assertIn(words, said)
        self.assertNotIn("warning", said)
        self.cusp(0, "plan", "board.toml", "-o", "job.ngc")  # the example is what the call prints
        moves = [(self.folder / name).read_text().partition("\n")[2] for name in ("b.ngc", "job.ngc")]
        self.assertTrue(moves[0] == moves[1])
        self.assertIn("all bounds hold", self.cusp(0, "verify", "board.toml", "b.ngc"))

    def test_gaps_narrower_than_the_tool_are_told_with_their_place(self):
        self.write("b.gbr", HEAD + "X0Y0D02*\nX100000Y0D01*\nX0Y5500D02*\nX100000Y5500D01*\nM02*\n")  # a gap of 0.15 mm
        said = self.cusp(0, "plan", "b.gbr", "--tool", "flat:0.2", "--depth", "1", "-o", "b.ngc")
        self.assertRegex(said, r"tool 1 of 0\.2 mm does not reach 2\d\.\d+ mm of the loops.*y 0\.\d+ mm")

    def test_inches_and_millimetres_are_the_same_board(self):
        self.write("mm.gbr", HEAD + "X0Y0D02*\nX254000Y127000D01*\nX50800Y0D03*\nM02*\n")
        self.write("inch.gbr", "%FSLAX25Y25*%\n%MOIN*%\n%ADD10C,0.015748*%\nD10*\nX0Y0D02*\nX100000Y50000D01*\nX20000Y0D03*\nM02*\n")
        boxes = [re.search(r"box +(.*)", self.cusp(0, "info", name))[1] for name in ("mm.gbr", "inch.gbr")]
        self.assertEqual(*boxes)

    def test_excellon_in_all_forms_of_numbers_drills_the_same_holes(self):
        def program(head, number):
            tools = {0.8: "T1", 1.1: "T2"}
            lines = ["M48", *head]
            for tool in tools.values():
                lines.append(tool if tool == "T1" else "T2")
                lines += [f"X{number(x)}Y{number(y)}" for x, y, d in HOLES if tools[d] == tool]
            return "\n".join(lines) + "\nM30\n"

        def digits(scale, omit_trailing, width):
            def text(value):
                sign, whole = ("-" if value < 0 else ""), f"{round(abs(value) * scale):0{width}d}"
                return sign + (whole.rstrip("0") or "0" if omit_trailing else whole.lstrip("0") or "0")
            return text
        mm, inch = ["T1C0.8", "T2C1.1", "%"], [f"T1C{0.8 / 25.4:.6f}", f"T2C{1.1 / 25.4:.6f}", "%"]
        forms = {
            "point": program(["METRIC", *mm], lambda v: f"{v:.3f}"),
            "leading": program(["METRIC,LZ", *mm], digits(1000, True, 6)),
            "trailing": program(["METRIC,TZ", *mm], digits(1000, False, 6)),
            "format": program([";FILE_FORMAT=4:4", "METRIC,TZ", *mm], digits(10000, False, 8)),
            "zeros": program(["METRIC,LZ,0000.00000", *mm], digits(100000, True, 9)),
            "inch": program(["INCH", *inch], lambda v: f"{v / 25.4:.6f}"),
        }
        for form, text in forms.items():
            with self.subTest(form):
                self.write("h.drl", text)
                self.cusp(0, "plan", "h.drl", "--tool", "drill:0.8", "drill:1.1", "--depth", "2", "-o", "h.ngc")
                drilled = self.drilled()
                self.assertEqual(len(HOLES), len(drilled))
                for (x, y), (wanted_x, wanted_y, _) in zip(drilled, sorted(HOLES)):
                    self.assertLess(math.hypot(x - wanted_x, y - wanted_y), 2e-4)

    def drilled(self):
        """Places at which the program goes below the top."""
        at, found = [0.0, 0.0], set()
        for line in (self.folder / "h.ngc").read_text().splitlines():
            for axis, value in re.findall(r"([XYZ])(-?[\d.]+)", line.partition("(")[0]):
                if axis == "Z" and float(value) < 0:
                    found.add(tuple(at))
                elif axis != "Z":
                    at["XY".index(axis)] = float(value)
        return sorted(found)

    def test_the_tool_runs_around_copper_half_its_width_away(self):
        self.write("b.gbr", HEAD + "X0Y0D02*\nX100000Y0D01*\nM02*\n")
        self.cusp(0, "plan", "b.gbr", "--tool", "flat:0.2", "--depth", "1", "-o", "b.ngc")
        at, way = [0.0, 0.0, 1.0], 0.0
        for line in (self.folder / "b.ngc").read_text().splitlines():
            before = list(at)
            for axis, value in re.findall(r"([XYZ])(-?[\d.]+)", line.partition("(")[0]):
                at["XYZ".index(axis)] = float(value)
            if before[2] < -0.099 and at[2] < -0.099 and before != at:
                x = min(max(at[0], 0), 10)
                if math.hypot(at[0] - x, at[1]) < 0.32:  # chords are outside, within 0.02 mm
                    way += math.dist(before, at)
                self.assertGreater(math.hypot(at[0] - x, at[1]), 0.298)
        self.assertAlmostEqual(20 + 2 * math.pi * 0.3, way, delta=0.2)  # but for the leads

    def distances_of_cuts(self, half_length):
        """Of all cuts of b.ngc from a line along x from 0: the least and the greatest of the tip, and the way."""
        at, found, way = [0.0, 0.0, 1.0], [], 0.0
        for line in (self.folder / "b.ngc").read_text().splitlines():
            before = list(at)
            for axis, value in re.findall(r"([XYZ])(-?[\d.]+)", line.partition("(")[0]):
                at["XYZ".index(axis)] = float(value)
            if before[2] < -0.099 and at[2] < -0.099 and before != at:
                for k in range(51):
                    x, y = (a + (b - a) * k / 50 for a, b in zip(before[:2], at[:2]))
                    found.append(math.hypot(x - min(max(x, 0), half_length), y))
                way += math.dist(before, at)
        return min(found), max(found), way

    def test_a_vee_runs_around_copper_half_its_cut_away(self):
        self.write("b.gbr", HEAD + "X0Y0D02*\nX100000Y0D01*\nM02*\n")
        for tool, half in (("vee:3:60:0.1", 0.05 + 0.1 * math.tan(math.radians(30))), ("vee:3:30", 0.1 * math.tan(math.radians(15)))):
            call = ("plan", "b.gbr", "--tool", tool, "flat:0.8", "--depth", "1")
            self.assertIn("engrave outside, vee 3 mm", self.cusp(0, *call, "-o", "b.ngc"))
            least, greatest, way = self.distances_of_cuts(10)
            self.assertAlmostEqual(0.2 + half, least, delta=0.011)  # chords are within half of 0.02 mm
            self.assertAlmostEqual(0.2 + half, greatest, delta=0.011)
            self.assertAlmostEqual(20 + 2 * math.pi * (0.2 + half), way, delta=0.03)
            self.write_job(self.cusp(0, *call, "--print-job"))
            self.assertIn("all bounds hold", self.cusp(0, "verify", "job.toml", "b.ngc"))

    def test_the_narrower_cut_of_a_vee_and_a_mill_isolates(self):
        self.write("b.gbr", HEAD + "X0Y0D02*\nX100000Y0D01*\nM02*\n")
        for tools, words in ((("vee:3:60:0.1", "flat:0.2"), "profile outside, flat 0.2 mm"),
                             (("vee:3:60:0.05", "flat:0.2"), "engrave outside, vee 3 mm"),
                             (("vee:3:60:0.05",), "engrave outside, vee 3 mm")):
            self.assertIn(words, self.cusp(0, "plan", "b.gbr", "--tool", *tools, "--depth", "1", "-o", "b.ngc"))
        self.assertIn("for which a mill or a vee is needed", self.cusp(2, "plan", "b.gbr", "--tool", "drill:1", "--depth", "1",
                                                                       "-o", "b.ngc"))
        for tool, words in (("vee:3:60:0.1:1", "a vee has a diameter, the angle of its tip, and"),
                            ("vee:3:60:3", "the diameter of the tip is 3, the tool's only 3"), ("drill:3:60:1", "a drill has")):
            self.assertIn(words, self.cusp(2, "plan", "b.gbr", "--tool", tool, "--depth", "1", "-o", "b.ngc"))

    def test_copper_that_a_vee_does_not_part_is_told_with_its_place(self):
        self.write("b.gbr", HEAD + "X0Y0D02*\nX100000Y0D01*\nX0Y5500D02*\nX100000Y5500D01*\nM02*\n")  # a gap of 0.15 mm
        call = ("plan", "b.gbr", "--tool", "vee:3:60:0.1", "--depth", "1", "-o", "b.ngc")
        self.assertRegex(self.cusp(0, *call), r"the groove of tool 1 does not reach 20\.?\d* mm of the loops.*y 0\.\d+ mm")
        self.assertNotIn("does not reach", self.cusp(0, *call, "--layer", "copper=outside:0.04"))

    def test_what_is_wrong_is_refused_with_its_line(self):
        self.refused("no.gbr", "G01 X1 Y1\n", "no Gerber file")
        self.refused("undefined.gbr", HEAD + "D77*\n", "line 5", "aperture D77 is not defined")
        self.refused("macro.gbr", HEAD + "%ADD11NOPE,1*%\n", "line 5", "NOPE")
        self.refused("zero.gbr", "%FSLAX34Y34*%\n%MOMM*%\n%AMM*1,1,1/0,0,0*%\n%ADD10M*%\n", "divides by 0")
        self.refused("negative.gbr", HEAD + "%IPNEG*%\n", "line 5", "IPNEG")
        self.refused("radius.gbr", HEAD + "G75*\nG02X0Y0I0J0D01*\n", "line 6", "no radius")
        self.refused("open.gbr", HEAD + "%AMX*1,1,1,0,0*\n", "line 5", "does not end")
        self.refused("empty.gbr", HEAD + "M02*\n", "nothing is drawn")
        self.refused("far.gbr", HEAD + "X9999999999Y0D03*\n", "line 5", "X is 1e+06 mm: at most 100000")
        self.refused("no.drl", "X1Y1\n", "line 1", "no Excellon file")
        self.refused("tool.drl", "M48\nMETRIC\n%\nT3\nX1.0Y1.0\n", "line 5", "T3 has no diameter")
        self.refused("incremental.drl", "M48\nMETRIC\nT1C1\n%\nG91\n", "line 5", "G91")
        self.refused("nothing.drl", "M48\nMETRIC\nT1C1\n%\nM30\n", "nothing is drilled")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
