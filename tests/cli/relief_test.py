"""Pictures as reliefs: greys are heights, and the ball's path keeps them.

usage: relief_test.py CUSP
"""
import math
import random
import re
import struct
import sys
import unittest
import zlib

from cusp_case import CuspCase


def png(rows, bits=8, colour=0):
    """Rows of greys (or of red, green, blue for colour 2) from the top, as PNG."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    channels = 3 if colour == 2 else 1
    raw = b"".join(b"\0" + struct.pack(f">{len(row)}{'H' if bits == 16 else 'B'}", *row) for row in rows)
    header = struct.pack(">IIBBBBB", len(rows[0]) // channels, len(rows), bits, colour, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b"")


def hill(columns, rows, top):
    """A dome whose middle is white and whose corners are black."""
    return [[round(top * max(0, 1 - math.hypot((2 * x / (columns - 1) - 1), (2 * y / (rows - 1) - 1)) / 1.5))
             for x in range(columns)] for y in range(rows)]


class Relief(CuspCase):
    def picture(self, data, name="p.png"):
        (self.folder / name).write_bytes(data)

    def cuts(self, name="p.ngc"):
        """Ends of the cutting moves: x, y, z."""
        at, cuts = [0.0, 0.0, 99.0], []
        for line in (self.folder / name).read_text().splitlines():
            line = re.sub(r"\(.*?\)", "", line)
            rapid = "G0" in line.replace("G00", "G0").split() if line.startswith("G") else getattr(self, "rapid", False)
            self.rapid = rapid
            words = dict(re.findall(r"([XYZ])(-?[\d.]+)", line))
            if words:
                at = [float(words.get(axis, old)) for axis, old in zip("XYZ", at)]
                if not rapid:
                    cuts.append(tuple(at))
        return cuts

    def plan(self, status=0, *options):
        return self.cusp(status, "plan", "p.png", "--tool", "flat:6", "ball:3", "--scallop", "0.1", *options, "-o", "p.ngc")

    def test_the_ball_follows_the_greys(self):
        columns, rows, width, black, white = 81, 61, 60.0, -6.0, 0.0
        for bits, top in ((8, 255), (16, 65535)):
            greys = hill(columns, rows, top)
            self.picture(png(greys, bits))
            said = self.plan(0, "--width", "60", "--heights=-6,0")
            self.assertIn("60 x 45 mm from above", said)
            pitch = width / (columns - 1)
            lowest = min(z for _, _, z in self.cuts())
            self.assertLess(abs(lowest - black), 0.4)
            for x, y, z in self.cuts():  # the tip stays above the picture below it
                column, row = round(x / pitch), rows - 1 - round(y / pitch)
                if 0 <= column < columns and 0 <= row < rows:
                    height = black + greys[row][column] / top * (white - black)
                    self.assertGreater(z, height - 0.35)  # a pixel's slope
            self.write_job(self.plan(0, "--width", "60", "--heights=-6,0", "--print-job"))
            if bits == 8:
                self.assertIn("all bounds hold", self.cusp(0, "verify", "job.toml", "p.ngc"))

    def test_black_may_be_high(self):
        self.picture(png(hill(41, 41, 255)))
        self.plan(0, "--width", "40", "--heights=0,-5")
        deep = min(self.cuts(), key=lambda p: p[2])
        self.assertLess(math.hypot(deep[0] - 20, deep[1] - 20), 3)

    def test_colours_count_by_their_brightness_and_many_pixels_are_averaged(self):
        self.picture(png([[value for x in range(60) for value in (4 * x, 4 * x, 4 * x)] for _ in range(50)], colour=2))
        self.plan(0, "--width", "30", "--heights=-3,0")
        self.picture(png([[x * 255 // 1299 for x in range(1300)] for _ in range(1000)]))
        said = self.cusp(0, "plan", "p.png", "--tool", "ball:8", "--scallop", "0.5", "--width", "40", "--heights=-3,0",
                         "--no-roughing", "-o", "p.ngc")
        self.assertIn("1300 x 1000 pixels, averaged 2 by 2", said)

    def test_what_is_no_relief_is_refused_in_words(self):
        self.picture(png(hill(20, 20, 255)))
        self.assertIn("--width, --heights", self.plan(2))
        self.assertIn("shown 100 mm wide", self.cusp(0, "info", "p.png"))
        self.assertIn("needs both", self.plan(2, "--width", "60"))
        self.assertIn("needs both", self.plan(2, "--heights=-6,0"))
        self.assertIn("--width: is 0", self.plan(2, "--width", "0", "--heights=-6,0"))
        self.picture(png([[1], [2]]))
        self.assertIn("1 x 2 pixels", self.plan(2, "--width", "60", "--heights=-6,0"))
        self.picture(b"no picture")
        self.assertIn("not a PNG", self.plan(2, "--width", "60", "--heights=-6,0"))
        self.write("b.obj", "v 0 0 0\nv 9 0 0\nv 0 9 1\nf 1 2 3\n")
        self.assertIn("are for pictures", self.cusp(2, "plan", "b.obj", "--tool", "ball:1", "--scallop", "0.1", "--width", "9",
                                                    "--heights=-6,0", "-o", "p.ngc"))

    def test_spoiled_pictures_never_crash(self):
        sound = png(hill(24, 20, 255))
        draw = random.Random(7)
        for _ in range(60):
            data = bytearray(sound[:draw.randrange(8, len(sound) + 1)])
            for _ in range(draw.randrange(4)):
                data[draw.randrange(len(data))] = draw.randrange(256)
            self.picture(bytes(data))
            self.write("job.toml", 'units = "mm"\n[tool]\nshape = "ball"\ndiameter = 6\n[cutting]\nfeed = 900\n[placing]\n'
                       'width = 30\nheights = [-2, 0]\n[[operation]]\nstrategy = "parallel_planes"\nfloor = ["p.png"]\n'
                       "scallop = 0.5\n")
            try:
                self.cusp(0, "plan", "job.toml", "-o", "p.ngc")
            except AssertionError as error:
                self.assertIn("2 != ", str(error).replace("0 != 2", "2 != "))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
