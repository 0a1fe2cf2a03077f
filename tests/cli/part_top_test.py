#!/usr/bin/env python3
"""Parts seen from above: ground that is the stock's top gets no pass, and holes of a mesh are closed and named.

usage: part_top_test.py CUSP
"""
import math
import re
import sys
import unittest

from cusp_case import CuspCase
from plate_mesh import plate, stl

CALL = ("p.stl", "--tool", "flat:6", "ball:4", "--scallop", "0.1", "--strategy", "adaptive_isocurve")
WIDE, DEEP, TOP = 10, 8, 12


def squares(height, changed=()):
    heights = [[height] * DEEP for _ in range(WIDE)]
    for (i, j), other in dict(changed).items():
        heights[i][j] = other
    return heights


def block(low, high):
    return {(i, j) for i in range(low[0], high[0]) for j in range(low[1], high[1])}


POCKET = squares(TOP, {at: 6 for at in block((3, 2), (7, 6))})
BOSS = squares(6, {at: TOP for at in block((3, 2), (7, 6))})
STEP = squares(TOP, {at: 8 for at in block((0, 0), (4, DEEP))})


def feed_moves(program):
    """(z of start, z of end, length) of the moves in G1."""
    at, mode, moves = {"X": 0.0, "Y": 0.0, "Z": 50.0}, "G0", []
    for line in program.splitlines():
        line = re.sub(r"\(.*?\)", "", line)
        words = re.findall(r"([GXYZ])(-?[\d.]+)", line)
        for letter, value in words:
            if letter == "G" and value in ("0", "1", "2", "3"):
                mode = "G" + value
        if re.search(r"G53|G4|M6", line):
            continue
        after = {**at, **{letter: float(value) for letter, value in words if letter != "G"}}
        if after != at and mode == "G1":
            moves.append((at["Z"], after["Z"], math.dist(at.values(), after.values())))
        at = after
    return moves


class PartTop(CuspCase):
    def planned(self, mesh, *more):
        self.write("p.stl", mesh)
        said = self.cusp(0, "plan", *CALL, *more, "-o", "p.ngc")
        return (self.folder / "p.ngc").read_text(), said

    def verified(self, *more):
        self.write_job(*more)
        self.assertIn("all bounds hold", self.cusp(0, "verify", "job.toml", "p.ngc"))

    def write_job(self, *more):
        said = self.cusp(0, "plan", *CALL, *more, "--print-job")
        self.write("job.toml", said[said.index("# The job of"):])

    def on_top(self, program, top):
        """Shares of the finish's feed moves at the height or over it."""
        moves = feed_moves(program[program.rindex("T2"):])
        over = sum(length for a, b, length in moves if min(a, b) > top - 1e-3)
        return over / sum(length for _, _, length in moves)

    def test_ground_on_the_stock_s_top_gets_no_pass(self):
        for heights in (POCKET, BOSS, STEP):
            program, _ = self.planned(stl(plate(heights)))
            self.assertLess(self.on_top(program, TOP), 0.1)
            self.verified()

    def test_a_top_under_stock_is_finished_by_the_flat_end(self):
        program, _ = self.planned(stl(plate(POCKET)), "--stock-top", "13")
        self.assertLess(self.on_top(program, TOP), 0.1)
        at_top = sum(length for a, b, length in feed_moves(program[:program.rindex("T2")])
                     if abs(a - TOP) < 1e-3 and abs(b - TOP) < 1e-3)
        ground = 4 * 4 * sum(height == TOP for row in POCKET for height in row)
        self.assertGreater(at_top, ground / 6)
        self.verified("--stock-top", "13")

    def test_a_top_under_stock_is_finished_by_a_ball_alone(self):
        self.write("p.stl", stl(plate(POCKET)))
        self.cusp(0, "plan", "p.stl", "--tool", "ball:4", *CALL[4:], "--stock-top", "13", "-o", "p.ngc")
        moves = feed_moves((self.folder / "p.ngc").read_text())
        finish = [length for a, b, length in moves if max(abs(a - TOP), abs(b - TOP)) < 0.02]
        self.assertGreater(sum(finish), 4 * 4 * (WIDE * DEEP - 16) / 4)

    def test_a_plate_as_high_as_the_stock_is_said_to_need_nothing(self):
        for hole, words in (((), ""), ({(4, 3)}, "1 hole of the part open above: 4 x 4 mm at x 18 y 14 z 12 mm")):
            self.write("p.stl", stl(plate(squares(TOP), hole)))  # a closed hole is no ground to finish
            said = self.cusp(2, "plan", *CALL, "-o", "p.ngc")
            self.assertIn("there is nothing to cut: no surface is below the stock's top, z = 12 mm", said)
            self.assertIn(words, said)

    def test_holes_of_a_mesh_are_closed_and_named(self):
        for heights, hole, words in (
                (POCKET, {(4, 3), (5, 3)}, "1 hole of the part open above: 8 x 4 mm at x 20 y 14 z 6 mm"),
                (POCKET, {(4, 3), (9, 7)}, "2 holes of the part open above: 4 x 4 mm at x "),
                (STEP, {(0, 3)}, "1 hole of the part open above: 4 x 4 mm at x 2 y 14 z 8 mm")):
            program, said = self.planned(stl(plate(heights, hole)))
            self.assertIn("p.stl: facets are missing: " + words, said)
            whole, _ = self.planned(stl(plate(heights)))
            for measure in (lambda moves: min(min(a, b) for a, b, _ in moves),
                            lambda moves: sum(length for _, _, length in moves)):
                self.assertAlmostEqual(measure(feed_moves(whole)), measure(feed_moves(program)), delta=0.1)
            self.planned(stl(plate(heights, hole)))
            self.verified()

    def test_the_program_of_a_mesh_milled_through_is_broken(self):
        program, _ = self.planned(stl(plate(POCKET, {(4, 3)})))
        end = program.rindex("M5")
        self.write("p.ngc", program[:end] + "G0 X18 Y14\nG1 Z0 F100\nG0 Z20\n" + program[end:])
        self.write_job()
        self.assertIn("broken", self.cusp(1, "verify", "job.toml", "p.ngc"))

    def test_sheets_and_parts_without_underside_are_accepted(self):
        solid = plate(STEP)
        sheet = [facet for facet in solid if any(z > 0 for _, _, z in facet)]
        for mesh in (solid, sheet):
            _, said = self.planned(stl(mesh))
            self.assertNotIn("facets are missing", said)

    def test_info_names_them(self):
        self.write("p.stl", stl(plate(POCKET, {(4, 3)})))
        self.assertIn("open above, 4 x 4 mm at x 18 y 14 z 6 mm: plan closes it", self.cusp(0, "info", "p.stl"))
        self.write("p.stl", stl(plate(POCKET)))
        self.assertNotIn("open above", self.cusp(0, "info", "p.stl"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
