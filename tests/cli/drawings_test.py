#!/usr/bin/env python3
"""Drawings as people have them: units, other entities, common edges, fit points, code pages, planes, places.

usage: drawings_test.py CUSP
"""
import json
import math
import sys
import unittest

from cusp_case import CuspCase

JOB = """
units = "{units}"
[tool]
shape = "flat"
diameter = {diameter}
[cutting]
feed = 1000
plunge_feed = 300
[stock]
top = 0
{placing}
[[operation]]
strategy = "{strategy}"
boundary = "{boundary}"
depth = {depth}
{keys}
"""


def groups(*pairs):
    return "".join(f"{code}\n{value}\n" for code, value in pairs)


def polyline(*points, layer="o"):
    return groups((0, "LWPOLYLINE"), (8, layer), (90, len(points)), (70, 1)) + groups(
        *[pair for x, y in points for pair in ((10, x), (20, y))])


def rectangle(x, y, width, height, layer="o"):
    return polyline((x, y), (x + width, y), (x + width, y + height), (x, y + height), layer=layer)


def line(x0, y0, x1, y1):
    return groups((0, "LINE"), (8, "o"), (10, x0), (20, y0), (11, x1), (21, y1))


def other(kind):
    return groups((0, kind), (8, "o"), (10, 1), (20, 2), (30, 0), (11, 5), (21, 4), (31, 0))


def drawing(entities, *header):
    return (groups((0, "SECTION"), (2, "HEADER"), *header, (0, "ENDSEC"), (0, "SECTION"), (2, "ENTITIES")) + entities +
            groups((0, "ENDSEC"), (0, "EOF")))


class Drawings(CuspCase):
    def job(self, boundary="d.dxf#o", strategy="profile", units="mm", diameter=6, depth=2, keys="", placing=""):
        self.write("j.toml", JOB.format(boundary=boundary, strategy=strategy, units=units, diameter=diameter,
                                        depth=depth, keys=keys, placing=placing))

    def planned(self, text, encoding="utf-8", **job):
        """Output of cusp plan."""
        (self.folder / "d.dxf").write_bytes(text.encode(encoding))
        self.job(**job)
        return self.cusp(0, "plan", "j.toml", "-o", "o.ngc")

    def box(self):
        """Box of the program's cuts, in x and y."""
        places = {"X": [], "Y": []}
        for text in (self.folder / "o.ngc").read_text().splitlines():
            for word in text.split():
                if word[0] in places and text[:2] in ("G1", "G2", "G3"):
                    places[word[0]].append(float(word[1:]))
        return [f(places[axis]) for axis in "XY" for f in (min, max)]

    def holds(self):
        self.assertIn("all bounds hold", self.cusp(0, "verify", "j.toml", "o.ngc"))

    def cuts_inside(self, width, height, x=0, y=0, diameter=6):
        """A profile inside a rectangle stays a radius off its sides."""
        wanted = [x + diameter / 2, x + width - diameter / 2, y + diameter / 2, y + height - diameter / 2]
        for found, value in zip(self.box(), wanted):
            self.assertAlmostEqual(value, found, delta=0.02)

    def test_units_scale_the_drawing(self):
        for code, size, said in ((5, (4, 3), "centimetres"), (6, (0.04, 0.03), "metres"), (13, (40e3, 30e3), "microns"),
                                 (14, (0.4, 0.3), "decimetres"), (1, (40 / 25.4, 30 / 25.4), "inches")):
            out = self.planned(drawing(rectangle(0, 0, *size), (9, "$INSUNITS"), (70, code)), keys='side = "inside"')
            self.assertIn(f"$INSUNITS {code} says {said}", out)
            self.cuts_inside(40, 30)
        out = self.planned(drawing(rectangle(0, 0, 40, 30), (9, "$INSUNITS"), (70, 4)), keys='side = "inside"')
        self.assertNotIn("INSUNITS", out)
        self.cuts_inside(40, 30)
        # a job in inches
        self.planned(drawing(rectangle(0, 0, 10.16, 7.62), (9, "$INSUNITS"), (70, 5)), units="inch", diameter=0.25,
                     depth=0.1, keys='side = "inside"')
        self.cuts_inside(4, 3, diameter=0.25)

    def test_units_of_stars_are_refused(self):
        self.write("d.dxf", drawing(rectangle(0, 0, 40, 30), (9, "$INSUNITS"), (70, 19)))
        self.job()
        self.assertIn("the drawing is in light years", self.cusp(2, "plan", "j.toml", "-o", "o.ngc"))

    def test_other_entities_are_left_out_with_a_note(self):
        kinds = ["SOLID", "XLINE", "RAY", "WIPEOUT", "REGION", "MLINE", "3DFACE", "MULTILEADER", "TRACE", "3DSOLID",
                 "TOLERANCE", "ACAD_TABLE", "HATCH", "DIMENSION"]
        out = self.planned(drawing(rectangle(0, 0, 40, 30) + "".join(other(kind) for kind in kinds)))
        for kind in kinds:
            self.assertIn(f"1 {kind}", out)
        self.holds()
        out = self.cusp(0, "info", "d.dxf")
        self.assertIn("left out, since they draw no curve", out)

    def test_pockets_with_a_common_edge_are_two(self):
        out = self.planned(drawing(rectangle(0, 0, 20, 20) + rectangle(20, 0, 20, 20)), strategy="pocket")
        self.assertNotIn("open", out)
        self.holds()
        self.planned(drawing(rectangle(0, 0, 20, 20) + rectangle(20, 5, 20, 10)), keys='side = "inside"')
        self.holds()

    def test_parts_with_a_common_edge_are_cut_around(self):
        for second, common in ((rectangle(20, 0, 20, 20), 20), (rectangle(20, 5, 20, 10), 10), (rectangle(20, -5, 10, 40), 20)):
            out = self.planned(drawing(rectangle(0, 0, 20, 20) + second), placing="bottom = -4\nmargin = 12")
            self.assertIn(f"loops have edges in common, {common} mm of them", out)
            self.holds()

    def test_fit_points_are_interpolated(self):
        turns = [2 * math.pi * k / 12 for k in range(13)]
        spline = groups((0, "SPLINE"), (8, "o"), (70, 0), (71, 3), (72, 0), (73, 0), (74, 13),
                        *[pair for t in turns for pair in ((11, 30 + 15 * math.cos(t)), (21, 20 + 15 * math.sin(t)))])
        out = self.planned(drawing(spline), keys='side = "inside"')
        self.assertIn("a SPLINE is given by fit points alone", out)
        self.holds()
        for found, wanted in zip(self.box(), (18, 42, 8, 32)):
            self.assertAlmostEqual(wanted, found, delta=0.03)

    def test_layers_of_a_code_page_are_named_in_utf8(self):
        for page, encoding, layer in (("ANSI_1252", "cp1252", "Außen"), ("ANSI_1251", "cp1251", "Контур"),
                                      ("ANSI_932", "cp932", "外形"), ("ANSI_936", "gbk", "轮廓")):
            text = drawing(rectangle(0, 0, 40, 30, layer), (9, "$ACADVER"), (1, "AC1015"), (9, "$DWGCODEPAGE"),
                           (3, page))
            self.planned(text, encoding, boundary=f"d.dxf#{layer}")
            self.cusp(0, "info", "d.dxf", "--stats", "s.json")
            stats = json.loads((self.folder / "s.json").read_text(encoding="utf-8"))
            self.assertEqual(layer, stats["files"][0]["layers"][0]["name"])
        self.planned("\ufeff" + drawing(rectangle(0, 0, 40, 30)))

    def test_other_formats_are_named(self):
        self.job()
        for content, said in ((b"AutoCAD Binary DXF\r\n\x1a\0\0\0SECTION\0", "binary DXF"),
                              (drawing(rectangle(0, 0, 4, 3)).encode("utf-16"), "UTF-16")):
            (self.folder / "d.dxf").write_bytes(content)
            self.assertIn(said, self.cusp(2, "plan", "j.toml", "-o", "o.ngc"))

    def test_gaps_are_closed_by_precision_or_by_their_key(self):
        gap = line(0, 0, 40, 0) + line(40, 0.3, 40, 30) + line(40, 30, 0, 30) + line(0, 30, 0, 0)
        (self.folder / "d.dxf").write_text(drawing(gap))
        self.job(keys='side = "inside"')
        said = self.cusp(2, "plan", "j.toml", "-o", "o.ngc")
        self.assertIn("x 40 y 0", said)
        self.assertIn("is 0.3 mm, the limit is 0.1 mm: join_gaps of the operation closes wider ones", said)
        self.assertIn("a gap of 0.3 mm is joined", self.planned(drawing(gap), keys='side = "inside"\njoin_gaps = 0.4'))
        inch = line(0, 0, 2, 0.001) + line(2, 0, 2, 1) + line(1.999, 1, 0, 1) + line(0, 1, 0, 0)
        self.assertIn("2 gaps of up to 0.0254 mm are joined", self.planned(drawing(inch, (9, "$INSUNITS"), (70, 1))))
        self.holds()

    def test_a_drawing_in_x_and_z_is_seen_from_the_front(self):
        front = groups((0, "LWPOLYLINE"), (8, "o"), (90, 4), (70, 1), (38, 5), (210, 0), (220, -1), (230, 0),
                       *[pair for x, z in ((0, 0), (40, 0), (40, 30), (0, 30)) for pair in ((10, x), (20, z))])
        out = self.planned(drawing(front), keys='side = "inside"')
        self.assertIn("drawn in x and z: z is taken for y", out)
        self.cuts_inside(40, 30)

    def test_survey_coordinates_are_moved_to_the_origin(self):
        far = drawing(rectangle(512345.67, 5401234.56, 0.04, 0.03), (9, "$INSUNITS"), (70, 6))
        (self.folder / "d.dxf").write_text(far)
        self.job(keys='side = "inside"')
        self.assertIn("[placing] with origin", self.cusp(2, "plan", "j.toml", "-o", "o.ngc"))
        self.planned(far, keys='side = "inside"', placing='[placing]\norigin = "corner"')
        self.cuts_inside(40, 30)
        self.holds()

    def test_stl_in_upper_case_is_read(self):
        corners = [(0, 0, 0), (40, 0, 0), (0, 30, 0), (40, 30, 3)]
        facets = "".join(
            "  FACET NORMAL 0 0 1\n    OUTER LOOP\n" + "".join("      VERTEX {} {} {}\n".format(*corners[i]) for i in facet) +
            "    ENDLOOP\n  ENDFACET\n" for facet in ((0, 1, 2), (1, 3, 2)))
        for text in (f"SOLID PLATE\n{facets}ENDSOLID PLATE\n", f"\n  Solid plate\r\n{facets}EndSolid\n",
                     f"\ufeffsolid\n{facets}endsolid\n"):
            (self.folder / "p.stl").write_text(text, encoding="utf-8", newline="")
            self.assertIn("x 0 to 40 mm, y 0 to 30 mm, z 0 to 3 mm", self.cusp(0, "info", "p.stl"))
        self.write("p.stl", f"SOLID PLATE\n{facets[:-30]}")
        self.assertIn("p.stl:13: truncated", self.cusp(2, "info", "p.stl"))
        self.write("p.stl", "<html>" + 200 * " this is no mesh" + "</html>")
        self.assertIn("no STL", self.cusp(2, "info", "p.stl"))
        # a binary one whose name begins like an ASCII one
        binary = b"solid facet".ljust(80) + (1).to_bytes(4, "little") + bytes(12)
        binary += b"".join(v for v in (bytes(12), bytes(4), b"\0\0\x20\x41", bytes(4), bytes(4), bytes(4), b"\0\0\x20\x41"))
        binary = binary[:84 + 12 + 36] + bytes(2)
        (self.folder / "p.stl").write_bytes(binary[:-10])
        self.assertIn("truncated: 1 facets need 134 bytes", self.cusp(2, "info", "p.stl"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
