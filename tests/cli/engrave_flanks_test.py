#!/usr/bin/env python3
"""cusp verify on grooves with steep flanks: a path within its plan tolerance leaves them by more than that along z.

usage: engrave_flanks_test.py CUSP
"""
import json
import re
import sys
import unittest

from cusp_case import CuspCase

ARC = "0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n8\nc\n90\n3\n70\n0\n10\n-15\n20\n-8\n42\n0\n10\n0\n20\n0\n42\n-0.55\n10\n15\n" \
      "20\n-8\n42\n0\n0\nENDSEC\n0\nEOF\n"

# Shape, diameter, further keys, depth: the flanks of these grooves are vertical or nearly so at the top.
GROOVES = (("bull", 3, "corner_radius = 0.5", 1.34), ("bull", 3, "corner_radius = 0.5", 0.46),
           ("bull", 6, "corner_radius = 1.5", 1.45), ("ball", 3, "", 1.49), ("ball", 3, "", 2.5), ("ball", 6, "", 2.7),
           ("vee", 6, "tip_angle = 20", 1.5), ("flat", 3, "", 1.34))


class EngraveFlanks(CuspCase):
    def plan(self, shape, diameter, more, depth):
        self.write("arc.dxf", ARC)
        self.write("job.toml", f'units = "mm"\n[[tool]]\nshape = "{shape}"\ndiameter = {diameter}\n{more}\n'
                               "[cutting]\nfeed = 800\n[stock]\ntop = 0\nbottom = -8\nx = [-25, 25]\ny = [-25, 25]\n"
                               f'[[operation]]\nstrategy = "engrave"\nboundary = "arc.dxf#c"\ndepth = {depth}\n')
        self.cusp(0, "plan", "job.toml", "-o", "p.ngc")
        return (self.folder / "p.ngc").read_text()

    def verdict(self, status, program, name):
        self.write("q.ngc", program)
        said = self.cusp(status, "verify", "job.toml", "q.ngc", "--stats", "v.json")
        return json.loads((self.folder / "v.json").read_text()).get(name), said

    def test_sound_grooves_hold(self):
        for groove in GROOVES:
            with self.subTest(groove=groove):
                self.verdict(0, self.plan(*groove), "gouge_max_mm")

    def test_too_deep_has_its_size(self):
        for groove in GROOVES:
            with self.subTest(groove=groove):
                program = self.plan(*groove)
                depth = groove[3]
                deeper = re.sub(rf"Z-{depth}\b", f"Z-{depth + 0.1:.3f}", program)
                self.assertNotEqual(program, deeper)
                gouge, said = self.verdict(1, deeper, "gouge_max_mm")
                self.assertAlmostEqual(0.1, gouge, delta=0.01, msg=said)

    def test_too_shallow_is_left(self):
        for groove in GROOVES:
            with self.subTest(groove=groove):
                depth = groove[3]
                # all of a vee's groove is flank, and what its path may leave there is not seen as left
                size = 0.3 if groove[0] == "vee" else 0.1
                higher = re.sub(rf"Z-{depth}\b", f"Z-{depth - size:.3f}", self.plan(*groove))
                left, said = self.verdict(1, higher, "level_left_mm")
                self.assertAlmostEqual(size, left, delta=0.12 if groove[0] == "vee" else 0.01, msg=said)

    def test_a_groove_beside_its_place_is_broken(self):
        for groove in GROOVES:
            with self.subTest(groove=groove):
                aside = self.plan(*groove).replace("G0 X-15 Y-8", "G10 L2 P1 Y0.15\nG0 X-15 Y-8", 1)
                _, said = self.verdict(1, aside, "gouge_max_mm")
                self.assertIn("gouge_max_mm", said.split("broken:", 1)[1])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
