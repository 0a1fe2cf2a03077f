#!/usr/bin/env python3
"""Texts in place of drawings: what is engraved are the outlines that the font file holds, read here by a few lines of its
own; size, alignment, lines, circles; letters of single lines; refusals.

usage: text_test.py CUSP FONT
"""
import math
import pathlib
import struct
import sys

import unittest

from cusp_case import CuspCase
from program_cuts import away, cuts

FONT = sys.argv[2]
TOLERANCE = 0.01
JOB = f"""
[tool]
shape = "vee"
diameter = 6
tip_angle = 60
[cutting]
feed = 1000
plunge_feed = 300
[stock]
top = 0
[[operation]]
strategy = "engrave"
depth = 0.5
plan_tolerance = {TOLERANCE}
"""


class Font:
    """Simple glyphs of a TrueType file, by the tables cmap (format 4), loca, glyf and hmtx."""

    def __init__(self, file):
        data = self.data = pathlib.Path(file).read_bytes()
        count = struct.unpack(">H", data[4:6])[0]
        self.at = {data[12 + 16 * k:16 + 16 * k].decode(): struct.unpack(">I", data[20 + 16 * k:24 + 16 * k])[0] for k in range(count)}
        self.long = struct.unpack(">h", data[self.at["head"] + 50:self.at["head"] + 52])[0]
        self.metrics = struct.unpack(">H", data[self.at["hhea"] + 34:self.at["hhea"] + 36])[0]

    def glyph(self, character):
        cmap, data = self.at["cmap"], self.data
        tables = [struct.unpack(">HHI", data[cmap + 4 + 8 * k:cmap + 12 + 8 * k]) for k in range(struct.unpack(">H", data[cmap + 2:cmap + 4])[0])]
        at = cmap + next(o for p, e, o in tables if struct.unpack(">H", data[cmap + o:cmap + o + 2])[0] == 4)
        n = struct.unpack(">H", data[at + 6:at + 8])[0] // 2
        def row(k):
            return struct.unpack(f">{n}H", data[at + 14 + 2 * n * k + (2 if k else 0):][:2 * n])
        ends, starts, deltas, offsets = row(0), row(1), row(2), row(3)
        k = next(k for k in range(n) if ends[k] >= ord(character))
        assert starts[k] <= ord(character)
        if offsets[k] == 0:
            return (ord(character) + deltas[k]) % 65536
        place = at + 16 + 6 * n + 2 * k + offsets[k] + 2 * (ord(character) - starts[k])
        return (struct.unpack(">H", data[place:place + 2])[0] + deltas[k]) % 65536

    def advance(self, character):
        k = min(self.glyph(character), self.metrics - 1)
        return struct.unpack(">H", self.data[self.at["hmtx"] + 4 * k:][:2])[0]

    def outlines(self, character):
        """Contours, each as points on it, closely."""
        g, data = self.glyph(character), self.data
        loca = self.at["loca"]
        at = self.at["glyf"] + (struct.unpack(">I", data[loca + 4 * g:][:4])[0] if self.long else 2 * struct.unpack(">H", data[loca + 2 * g:][:2])[0])
        contours = struct.unpack(">h", data[at:at + 2])[0]
        assert contours > 0, "a simple glyph is needed"
        ends = struct.unpack(f">{contours}H", data[at + 10:][:2 * contours])
        at += 10 + 2 * contours
        at += 2 + struct.unpack(">H", data[at:at + 2])[0]
        flags = []
        while len(flags) <= ends[-1]:
            flag, at = data[at], at + 1
            flags.append(flag)
            if flag & 8:
                flags += [flag] * data[at]
                at += 1
        axes = []
        for short, same in ((2, 16), (4, 32)):
            values, value = [], 0
            for flag in flags:
                if flag & short:
                    value, at = value + (data[at] if flag & same else -data[at]), at + 1
                elif not flag & same:
                    value, at = value + struct.unpack(">h", data[at:at + 2])[0], at + 2
                values.append(value)
            axes.append(values)
        out, first = [], 0
        for end in ends:
            points = [((axes[0][k], axes[1][k]), flags[k] & 1) for k in range(first, end + 1)]
            first = end + 1
            whole = []  # with the points on the curve between two that are off it
            for (p, on), (q, next_on) in zip(points, points[1:] + points[:1]):
                whole.append((p, on))
                if not on and not next_on:
                    whole.append((((p[0] + q[0]) / 2, (p[1] + q[1]) / 2), 1))
            begin = next(k for k, (_, on) in enumerate(whole) if on)
            whole = whole[begin:] + whole[:begin + 1]
            samples, k = [], 0
            while k < len(whole) - 1:
                a, (b, on) = whole[k][0], whole[k + 1]
                c, step = (b, 1) if on else (whole[k + 2][0], 2)
                b = ((a[0] + c[0]) / 2, (a[1] + c[1]) / 2) if on else b
                samples += [tuple((1 - t) ** 2 * u + 2 * t * (1 - t) * v + t * t * w for u, v, w in zip(a, b, c)) for t in [i / 12 for i in range(12)]]
                k += step
            out.append(samples + samples[:1])
        return out


def turned(point, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return c * point[0] - s * point[1], s * point[0] + c * point[1]


class Text(CuspCase):
    def engraved(self, keys, units=""):
        self.write("sign.toml", units + JOB + keys)
        self.cusp(0, "plan", "sign.toml", "-o", "sign.ngc")
        self.assertIn("all bounds hold", self.cusp(0, "verify", "sign.toml", "sign.ngc"))
        return cuts((self.folder / "sign.ngc").read_text())

    def check_equal(self, wanted, cut):
        """The polylines of the font and the lines of the program lie on each other."""
        limit = TOLERANCE + 0.002
        drawn = [pair for line in wanted for pair in zip(line, line[1:])]
        worst = max(away(point, cut) for line in wanted for point in line[::2])
        self.assertLess(worst, limit, "not cut")
        self.assertLess(max(away(end, drawn) for _, end in cut), limit, "cut, but not in the font")

    def outlines(self, font, text, size, place):
        """place(point of the line, middle of its letter): both in mm from the line's beginning."""
        scale = size / max(y for line in font.outlines("H") for _, y in line)
        lines, x = [], 0.0
        for character in text:
            width = scale * font.advance(character)
            for line in font.outlines(character):
                lines.append([place((x + scale * px, scale * py), x + width / 2) for px, py in line])
            x += width
        return lines, x

    def test_letters_of_a_font_are_its_outlines(self):
        font = Font(FONT)
        plain, width = self.outlines(font, "HOB8e", 10, lambda p, _: p)
        for align, share in (("left", 0), ("centre", 0.5), ("right", 1)):
            with self.subTest(align):
                cut = self.engraved(f'text = "HOB8e"\nfont = "{FONT}"\nsize = 10\nat = [30, 20]\nalign = "{align}"\nangle = 30\n')
                wanted = [[tuple(map(sum, zip((30, 20), turned((x - share * width, y), 30)))) for x, y in line] for line in plain]
                self.check_equal(wanted, cut)

    def test_letters_stand_round_a_circle(self):
        font = Font(FONT)
        for radius in (25, -40):
            with self.subTest(radius):
                def place(point, middle):
                    x, y = point[0] - middle, point[1]
                    turn = -math.degrees((middle - half) / radius)
                    x, y = turned((x, y + radius), turn)
                    return 50 + x, 50 + y - radius
                half = self.outlines(font, "HOHO", 8, lambda p, _: p)[1] / 2
                wanted = self.outlines(font, "HOHO", 8, place)[0]
                self.check_equal(wanted, self.engraved(
                    f'text = "HOHO"\nfont = "{FONT}"\nsize = 8\nat = [50, 50]\nalign = "centre"\narc = {radius}\n'))

    def test_single_lines_have_the_size_asked_for(self):
        cut = self.engraved('text = "HI\\nE"\nsize = 12\nat = [5, 7]\n')
        # H is 4 of its 6 units wide, I follows after a gap of 1.4, the next line is 10 lower
        wanted = [[(5, 7), (5, 19)], [(13, 7), (13, 19)], [(5, 13), (13, 13)], [(15.8, 7), (15.8, 19)],
                  [(12, -13), (5, -13), (5, -1), (12, -1)], [(5, -7), (10, -7)]]
        self.check_equal(wanted, cut)

    def test_every_letter_of_single_lines_keeps_within_its_width(self):
        letters = [chr(k) for k in range(33, 127)] + list("°±µ·×ÄÖÜäöüßØø⌀")
        for begin in range(0, len(letters), 12):
            group = letters[begin:begin + 12]
            blocks = "".join(f"\n[[operation]]\nstrategy = \"engrave\"\ndepth = 0.5\ntext = '''{c}'''\nsize = 6\nat = [{20 * k}, 0]\n"
                             for k, c in enumerate(group))
            self.write("all.toml", JOB.split("[[operation]]")[0] + blocks)
            self.cusp(0, "plan", "all.toml", "-o", "all.ngc")
            ends = [end for pair in cuts((self.folder / "all.ngc").read_text()) for end in pair]
            for k, c in enumerate(group):
                mine = [(x - 20 * k, y) for x, y in ends if abs(x - 20 * k - 3) < 10]
                self.assertTrue(mine, c)
                self.assertGreater(min(x for x, _ in mine), -0.01, c)
                self.assertLess(max(x for x, _ in mine), 6.01, c)
                self.assertGreater(min(y for _, y in mine), -2.01, c)
                self.assertLess(max(y for _, y in mine), 7.51, c)

    def test_inches_scale_size_place_and_circle(self):
        cut = self.engraved('text = "H"\nsize = 0.5\nat = [1, 2]\n', 'units = "inch"\n')
        cut = [tuple((25.4 * x, 25.4 * y) for x, y in pair) for pair in cut]
        self.assertAlmostEqual(50.8, min(min(a[1], b[1]) for a, b in cut), delta=0.01)
        self.assertAlmostEqual(63.5, max(max(a[1], b[1]) for a, b in cut), delta=0.01)

    def test_pockets_profiles_and_v_carving_take_a_text(self):
        for strategy, tool in (("pocket", 'shape = "flat"\ndiameter = 1'), ("profile", 'shape = "flat"\ndiameter = 1'),
                               ("v_carve", 'shape = "vee"\ndiameter = 6\ntip_angle = 60')):
            with self.subTest(strategy):
                job = JOB.replace('shape = "vee"\ndiameter = 6\ntip_angle = 60', tool).replace("engrave", strategy)
                self.write("sign.toml", job.replace("depth = 0.5", "depth = 0.5\nmax_depth = 0.5" if strategy != "v_carve" else "depth = 0.5") +
                           f'text = "HB"\nfont = "{FONT}"\nsize = 20\n')
                self.cusp(0, "plan", "sign.toml", "-o", "sign.ngc")
                self.assertIn("all bounds hold", self.cusp(0, "verify", "sign.toml", "sign.ngc"))

    def test_what_can_not_be_written_is_refused_in_words(self):
        (self.folder / "no.ttf").write_bytes(b"no font at all")
        for keys, words in (
                ('text = "A"\n', "text: needs size: of text: height of its capitals"),
                ('size = 4\n', "size: needs text"),
                ('text = "A"\nsize = 4\nboundary = "a.dxf"\n', "one of them"),
                ('text = "A"\nsize = 4\nat = [1]\n', "at: has 1 numbers"),
                ('text = "A☃"\nsize = 4\n', "does not have ☃ (U+2603)"),
                (f'text = "☃\U0001f9ff"\nsize = 4\nfont = "{FONT}"\n', "does not have"),
                ('text = "  "\nsize = 4\n', "has no letter"),
                ('text = "A"\nsize = 4\nfont = "no.ttf"\n', "no font"),
                ('text = "A"\nsize = 4\nfont = "gone.ttf"\n', "gone.ttf"),
                ('text = "A"\nsize = 4\nfont = "No Such Font"\n', "No Such Font"),
                ('text = "AAAAAAAAAAAA"\nsize = 9\narc = 5\n', "the circle of radius 5 mm"),
                ('text = "A\\nA"\nsize = 9\narc = 12\n', "inside the first"),
                ('text = "A"\nsize = 0\n', "size")):
            with self.subTest(words):
                self.write("bad.toml", JOB + keys)
                said = self.cusp(2, "plan", "bad.toml", "-o", "bad.ngc")
                self.assertIn(words, said)
                self.assertIn("operation 1", said) if ".ttf" not in words and words != "no font" else None


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
