#!/usr/bin/env python3
"""Random models with rims beside each other, planned with adaptive_isocurve and cut in memory by `cusp verify`.

usage: rim_models.py CUSP SEED...

A seed makes the whole case: a trimmed patch over another one, a narrow strip over one, patches with a narrow gap or a
step between them, a steep patch between two others. There the ball reaches many places only from beyond a rim. With a
one-sided tolerance the stock left over the reachable height must be within scallop and tolerance everywhere. With a
two-sided one slivers beside rims may be higher, on as much of the floor as `cusp verify` allows. Exit status 1 where
a bound does not hold.
"""
import math
import pathlib
import random
import sys
import tempfile

sys.dont_write_bytecode = True
import model_jobs
from model_jobs import clamped

HALF = math.sqrt(0.5)
JUDGEMENT = 0.005  # mm: by maps of heights


def patch(rng, x0, x1, y0, y1, z, wave, tilt):
    degree_u, degree_v = rng.choice([(3, 3), (2, 2), (3, 2), (1, 3), (1, 1)])
    rows = degree_u + 1 if degree_u == 1 else rng.randint(degree_u + 1, 6)
    columns = degree_v + 1 if degree_v == 1 else rng.randint(degree_v + 1, 6)
    points = []
    for i in range(rows):
        for j in range(columns):
            s, t = i / (rows - 1), j / (columns - 1)
            height = tilt[0] * (s - 0.5) * (x1 - x0) + tilt[1] * (t - 0.5) * (y1 - y0) + wave * rng.uniform(-1, 1)
            points.append([x0 + (x1 - x0) * s, y0 + (y1 - y0) * t, z + height])
    return {"degree_u": degree_u, "degree_v": degree_v, "size_u": rows, "size_v": columns,
            "knotvector_u": clamped(rows, degree_u), "knotvector_v": clamped(columns, degree_v),
            "control_points": {"points": points}}


def ellipse(u, v, radius_u, radius_v, outer):
    ring = [(1, 0, 1), (1, 1, HALF), (0, 1, 1), (-1, 1, HALF), (-1, 0, 1), (-1, -1, HALF), (0, -1, 1), (1, -1, HALF),
            (1, 0, 1)]
    ring = ring if outer else ring[::-1]
    return {"type": "spline", "rational": True, "reversed": 0, "degree": 2,
            "knotvector": [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4],
            "control_points": {"points": [[u + radius_u * a, v + radius_v * b] for a, b, _ in ring],
                               "weights": [w for _, _, w in ring]}}


def rectangle(u, v, half_u, half_v, turn):
    c, s = math.cos(turn), math.sin(turn)
    points = [[u + c * a * half_u - s * b * half_v, v + s * a * half_u + c * b * half_v]
              for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1))]
    return {"type": "spline", "rational": False, "reversed": 0, "degree": 1, "knotvector": [0, 0, 1, 2, 3, 4, 4],
            "control_points": {"points": points}}


def trimmed(surface, loops):
    surface["trims"] = {"count": len(loops), "data": loops}
    return surface


def leaning(rng, most):
    return rng.uniform(-most, most), rng.uniform(-most, most)


def stepped(rng, size):
    low = patch(rng, 0, size, 0, size, -4, rng.choice([0, 0.4, 1]), leaning(rng, 0.3))
    high = patch(rng, 0, size, 0, size, -4 + rng.choice([0.2, 0.6, 1.5, 3]), rng.choice([0, 0.3, 0.8]), leaning(rng, 0.6))
    part = rng.choice([
        [ellipse(rng.uniform(0.3, 0.7), rng.uniform(0.3, 0.7), rng.uniform(0.06, 0.2), rng.uniform(0.06, 0.2), True)],
        [rectangle(rng.uniform(0.4, 0.6), rng.uniform(0.4, 0.6), rng.uniform(0.04, 0.2), rng.uniform(0.04, 0.2),
                   rng.uniform(0, 3))],
        [ellipse(0.5, 0.5, 0.47, 0.47, True), ellipse(0.5, 0.5, rng.uniform(0.04, 0.25), rng.uniform(0.04, 0.25), False)]])
    return [low, trimmed(high, part)]


def strip(rng, size):
    high = patch(rng, 0, size, 0, size, -3, rng.choice([0, 0.5]), leaning(rng, 0.8))
    low = patch(rng, 0, size, 0, size, -3 - rng.choice([0.3, 1, 3]), rng.choice([0, 0.3]), leaning(rng, 0.3))
    return [trimmed(high, [rectangle(0.5, 0.5, 0.45, rng.uniform(0.01, 0.06), 0)]), low]


def gap(rng, size):
    middle, width = size / 2, rng.choice([0, 0.01, 0.05, 0.2])
    step = rng.choice([0.3, 1, 2.5]) * rng.choice([-1, 1])
    return [patch(rng, 0, middle - width / 2, 0, size, -4, rng.choice([0, 0.4, 1]), leaning(rng, 1)),
            patch(rng, middle + width / 2, size, 0, size, -4 + step, rng.choice([0, 0.4, 1]), leaning(rng, 1))]


def steep(rng, size):
    low, width, lean = -5, rng.uniform(0.5, 1.5), rng.choice([1.5, 2.5, 4]) * rng.choice([-1, 1])
    return [patch(rng, 0, size / 2, 0, size, low, rng.choice([0, 0.4]), leaning(rng, 0.3)),
            patch(rng, size / 2, size / 2 + width, 0, size, low + rng.uniform(-1, 2), rng.choice([0, 0.2]), (lean, 0)),
            patch(rng, size / 2 + width + 0.05, size, 0, size, low + rng.uniform(-1, 2), rng.choice([0, 0.4]),
                  leaning(rng, 0.5))]


def open_valley(rng, size):
    """Two slopes that end above a third patch: it is seen through the gap between them."""
    middle, half = size / 2, 0.5 * rng.uniform(0.1, 0.6)
    left = patch(rng, 0, middle - half, 0, size, -4, rng.choice([0, 0.4]), (-rng.uniform(0.3, 1), rng.uniform(-0.4, 0.4)))
    right = patch(rng, middle + half, size, 0, size, -4 + rng.uniform(-1, 1), rng.choice([0, 0.4]),
                  (rng.uniform(0.3, 1), rng.uniform(-0.4, 0.4)))
    low = min(p[2] for s in (left, right) for p in s["control_points"]["points"])
    under = patch(rng, rng.uniform(0, 2), size - rng.uniform(0, 2), rng.uniform(1, 3), size - rng.uniform(1, 3),
                  low + rng.uniform(-0.5, 0.5), 0.3, (0, 0))
    return [left, right, under]


KINDS = [stepped, strip, gap, steep]
VALLEYS = 1000  # seeds from here on: gaps over a third patch


def kind_of(seed):
    return open_valley if seed >= VALLEYS else KINDS[seed % len(KINDS)]


def make_case(seed, folder):
    rng = random.Random(seed)
    surfaces = kind_of(seed)(rng, rng.uniform(7, 9))
    case = {"diameter": 2 * rng.choice([1.5, 2, 2.5, 3]), "top": math.ceil(max(0, model_jobs.highest(surfaces)) + 0.5),
            "output": rng.choice(["lines", "arcs", "nurbs"]), "tolerance": rng.choice([0.01, 0.02]),
            "side": rng.choice(["outside", "outside", "both"]), "scallop": rng.choice([0.04, 0.06, 0.1]),
            "direction": rng.choice("uv"), "traversal": "zigzag"}
    model_jobs.write(folder, surfaces, case)
    return case


def fault_of(cusp, case, folder):
    fault, figures = model_jobs.judged(cusp, folder)
    if fault:
        return fault
    allowed = case["scallop"] + case["tolerance"] + JUDGEMENT
    left = figures["scallop_max_mm"]
    if case["side"] == "outside" and left > allowed:
        return f"scallop_max_mm {left} is over {allowed}"
    return None


def main():
    bad = 0
    for seed in map(int, sys.argv[2:]):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            case = make_case(seed, folder)
            fault = fault_of(sys.argv[1], case, folder)
        if fault:
            bad += 1
            print(f"seed {seed} {kind_of(seed).__name__} {case}: {fault}", file=sys.stderr)
    print(f"{len(sys.argv) - 2} models, {bad} failed")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
