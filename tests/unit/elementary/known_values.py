#!/usr/bin/env python3
"""Writes known_values.txt: arguments and results, correctly rounded, of mpmath (python3-mpmath).

usage: known_values.py > known_values.txt
"""
import math
import random

import mpmath

CASES = 110
EASY = {"sin": 7, "cos": 7, "tan": 7, "asin": 1, "acos": 1, "atan": 9, "cbrt": 1e4}


def rounded(value):
    return float(mpmath.mpf(value))  # to nearest


def arguments(name, number, draw):
    if number % 3 == 1 and name in ("sin", "cos", "tan"):  # next to a multiple of a right angle, up to a million
        return math.nextafter(rounded(draw.randrange(1, 10**6) * mpmath.pi / 2), draw.choice((-1e9, 1e9)))
    if number % 3 == 1 and name in ("asin", "acos"):
        return draw.choice((-1, 1)) * (1 - 10.0 ** draw.uniform(-15, -1))
    if number % 3 == 2:
        most = {"asin": 0, "acos": 0}.get(name, 6)
        return draw.choice((-1, 1)) * 10.0 ** draw.uniform(-12, most)
    return draw.uniform(-EASY[name], EASY[name])


def main():
    mpmath.mp.prec = 400
    draw = random.Random(1)
    cube_root = lambda x: mpmath.sign(x) * mpmath.cbrt(abs(x))
    for name in EASY:
        for number in range(CASES):
            x = arguments(name, number, draw)
            value = cube_root(mpmath.mpf(x)) if name == "cbrt" else getattr(mpmath, name)(mpmath.mpf(x))
            print(name, x.hex(), "0", rounded(value).hex())
    for name in ("atan2", "hypot"):
        for number in range(CASES):
            x, y = (draw.choice((-1, 1)) * 10.0 ** draw.uniform(*(((-9, 9), (-1, 1))[number % 2])) for _ in "xy")
            print(name, y.hex(), x.hex(), rounded(getattr(mpmath, name)(mpmath.mpf(y), mpmath.mpf(x))).hex())


main()
