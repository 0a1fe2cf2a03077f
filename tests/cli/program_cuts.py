"""Straight cuts of a program, for tests of drawings."""
import math
import re


def cuts(program):
    """Lines of the program below 0, as pairs of points."""
    at, z, out = (0.0, 0.0), 1.0, []
    for line in program.splitlines():
        code = line.split("(")[0]
        words = dict(re.findall(r"([XYZ])(-?[\d.]+)", code))
        to = float(words.get("X", at[0])), float(words.get("Y", at[1]))
        z = float(words.get("Z", z))
        if z < 0 and to != at and not re.search(r"G0*0\b", code):
            out.append((at, to))
        at = to
    return out


def away(point, pieces):
    """Distance of a point to the nearest of the pieces."""
    def one(a, b):
        d = b[0] - a[0], b[1] - a[1]
        square = d[0] ** 2 + d[1] ** 2
        share = 0 if square == 0 else max(0, min(1, ((point[0] - a[0]) * d[0] + (point[1] - a[1]) * d[1]) / square))
        return math.hypot(a[0] + share * d[0] - point[0], a[1] + share * d[1] - point[1])
    return min(one(a, b) for a, b in pieces)
