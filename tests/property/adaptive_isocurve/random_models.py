#!/usr/bin/env python3
"""Random models of NURBS surfaces, planned with adaptive_isocurve and cut in memory by `cusp verify`.

usage: random_models.py CUSP [--first SEED] [--count N] [--keep FOLDER]

A seed makes the whole case: surfaces, tool, bounds, form of the output. All kinds of surfaces that have caused faults
in tool paths occur: wavy, steep, sheared, folded over itself, with poles, closed, with creases, and several surfaces
that meet in concave and convex edges. Exit status 1 where a bound does not hold.
"""
import argparse
import math
import pathlib
import random
import sys
import tempfile

sys.dont_write_bytecode = True
import model_jobs
from model_jobs import clamped

SIZE = 14.0  # mm
TOP = 0.0


def surface(net, degree_u, degree_v, weights=None, knots_u=None, knots_v=None):
    points = {"points": [p for row in net for p in row]}
    if weights:
        points["weights"] = [w for row in weights for w in row]
    return {"degree_u": degree_u, "degree_v": degree_v, "size_u": len(net), "size_v": len(net[0]),
            "knotvector_u": knots_u or clamped(len(net), degree_u),
            "knotvector_v": knots_v or clamped(len(net[0]), degree_v), "control_points": points}


def knots_by_chance(rng, count, degree):
    inner = sorted(rng.uniform(0.05, 0.95) for _ in range(count - degree - 1))
    return clamped(count, degree, inner)


def sheet(rng, rise, shake=0.0, shear=0.0, rational=False, uneven=False):
    """A sheet over a square: random control heights, moved sideways by `shake` of a cell."""
    degree_u, degree_v = rng.choice([(3, 3), (3, 3), (2, 3), (3, 2), (2, 2), (4, 3)])
    rows, columns = rng.randint(degree_u + 1, 7), rng.randint(degree_v + 1, 7)
    cell_x, cell_y = SIZE / (rows - 1), SIZE / (columns - 1)
    net = []
    for i in range(rows):
        row = []
        for j in range(columns):
            inside = 0 < i < rows - 1 and 0 < j < columns - 1
            aside = shake if inside else 0
            row.append([i * cell_x + shear * j * cell_y + aside * cell_x * rng.uniform(-1, 1),
                        j * cell_y + aside * cell_y * rng.uniform(-1, 1), TOP - 1 - rise * rng.random()])
        net.append(row)
    weights = [[rng.uniform(0.4, 2.5) for _ in row] for row in net] if rational else None
    knots_u = knots_by_chance(rng, rows, degree_u) if uneven else None
    knots_v = knots_by_chance(rng, columns, degree_v) if uneven else None
    return surface(net, degree_u, degree_v, weights, knots_u, knots_v)


def wavy(rng):
    return [sheet(rng, rng.uniform(1, 6), shake=0.2, rational=rng.random() < 0.5, uneven=rng.random() < 0.5)]


def steep(rng):
    return [sheet(rng, rng.uniform(15, 40), shake=0.2)]


def sheared(rng):
    return [sheet(rng, rng.uniform(2, 8), shake=0.3, shear=rng.uniform(0.5, 1.5))]


def folded(rng):
    """Overhangs: control points moved by more than a cell."""
    return [sheet(rng, rng.uniform(4, 10), shake=rng.uniform(0.8, 1.6))]


def creased(rng):
    """Degree 1 one way or both: creases, concave and convex, inside one surface."""
    rows, columns = rng.randint(3, 5), rng.randint(4, 6)
    net = [[[SIZE * i / (rows - 1), SIZE * j / (columns - 1), TOP - 1 - rng.uniform(0, 5)]
            for j in range(columns)] for i in range(rows)]
    return [surface(net, 1, rng.choice([1, 3]))]


def dome(rng):
    """A quarter turn of a profile about the z axis: a pole where the profile meets the axis."""
    turn = rng.choice([1, 2, 4])  # quarters
    radius, height = 0.5 * SIZE, rng.uniform(3, 16)
    profile = [(0.0, 0.0), (0.55 * radius, 0.0), (radius, -0.45 * height), (radius, -height)]
    if rng.random() < 0.4:
        profile = [(0.0, -height), (0.4 * radius, -height), (radius, -0.6 * height), (radius, 0.0)]
    half = math.sqrt(0.5)
    ring = [(1, 0, 1), (1, 1, half), (0, 1, 1), (-1, 1, half), (-1, 0, 1), (-1, -1, half),
            (0, -1, 1), (1, -1, half), (1, 0, 1)][:2 * turn + 1]
    net = [[[r * x, r * y, TOP - 1 + z] for x, y, _ in ring] for r, z in profile]
    weights = [[w for _, _, w in ring] for _ in profile]
    breaks = [k / turn for k in range(1, turn) for _ in range(2)]
    made = surface(net, 3, 2, weights, None, clamped(len(ring), 2, breaks))
    return [transposed(made) if rng.random() < 0.5 else made]


def transposed(s):
    rows, columns = s["size_u"], s["size_v"]
    turn = lambda flat: [flat[i * columns + j] for j in range(columns) for i in range(rows)]
    control = {key: turn(value) for key, value in s["control_points"].items()}
    return {"degree_u": s["degree_v"], "degree_v": s["degree_u"], "size_u": columns, "size_v": rows,
            "knotvector_u": s["knotvector_v"], "knotvector_v": s["knotvector_u"], "control_points": control}


def tube(rng):
    """A closed surface: only its upper side can be reached."""
    radius, half = rng.uniform(3, 7), math.sqrt(0.5)
    ring = [(1, 0, 1), (1, 1, half), (0, 1, 1), (-1, 1, half), (-1, 0, 1), (-1, -1, half),
            (0, -1, 1), (1, -1, half), (1, 0, 1)]
    stations = rng.randint(4, 5)
    wide = [radius * rng.uniform(0.6, 1.4) for _ in range(stations)]
    net = [[[SIZE * i / (stations - 1), wide[i] * x, TOP - 12 + wide[i] * z] for x, z, _ in ring]
           for i in range(stations)]
    weights = [[w for _, _, w in ring] for _ in range(stations)]
    made = surface(net, 3, 2, weights, None, clamped(9, 2, [0.25, 0.25, 0.5, 0.5, 0.75, 0.75]))
    return [transposed(made) if rng.random() < 0.5 else made]


def plane(corners):
    a, b, c, d = corners
    return surface([[a, b], [c, d]], 1, 1)


def block(x0, x1, y0, y1, bottom, top, slope):
    """A frustum: four walls and a lid."""
    s = slope
    low = [[x0 - s, y0 - s, bottom], [x1 + s, y0 - s, bottom], [x1 + s, y1 + s, bottom], [x0 - s, y1 + s, bottom]]
    high = [[x0, y0, top], [x1, y0, top], [x1, y1, top], [x0, y1, top]]
    walls = [plane([low[k], low[(k + 1) % 4], high[k], high[(k + 1) % 4]]) for k in range(4)]
    return walls + [plane([high[0], high[1], high[3], high[2]])]


def house(rng):
    """A block on a hill: concave edges where the walls meet the hill, convex ones at the lid."""
    hill = sheet(rng, rng.uniform(1, 4), shake=0.1)
    for p in hill["control_points"]["points"]:
        p[2] -= 5
    x, y = rng.uniform(3, 5), rng.uniform(3, 5)
    return [hill] + block(x, x + rng.uniform(3, 6), y, y + rng.uniform(3, 6), -14, -rng.uniform(1, 4), rng.choice([0, 0, 1, 3]))


def crossing(rng):
    """Two sheets through each other: their union has concave edges where they cross."""
    return [sheet(rng, rng.uniform(4, 9)), sheet(rng, rng.uniform(4, 9))]


def roof(rng):
    """Two planes that meet in a ridge or in a valley, tilted."""
    up, tilt, m = rng.choice([-1, 1]) * rng.uniform(2, 9), rng.uniform(-3, 3), rng.uniform(0.35, 0.65) * SIZE
    ridge = [[m, 0.0, up], [m + rng.uniform(-4, 4), SIZE, up + tilt]]
    left, right = [[0.0, 0.0, 0.0], [0.0, SIZE, 0.0]], [[SIZE, 0.0, 0.0], [SIZE, SIZE, tilt]]
    made = [plane([left[0], left[1], ridge[0], ridge[1]]), plane([ridge[0], ridge[1], right[0], right[1]])]
    high = max(p[2] for s in made for p in s["control_points"]["points"])
    for s in made:
        s["control_points"]["points"] = [[p[0], p[1], p[2] - high - 1] for p in s["control_points"]["points"]]
    return made


KINDS = [wavy, steep, sheared, folded, creased, dome, tube, house, crossing, roof]

def make_case(seed, folder):
    rng = random.Random(seed)
    kind = KINDS[seed % len(KINDS)]
    surfaces = kind(rng)
    case = {"diameter": 2 * rng.choice([1.0, 1.5, 2.0, 3.0]), "tolerance": rng.choice([0.005, 0.01]),
            "scallop": rng.choice([0.02, 0.04, 0.08]), "top": max(TOP, model_jobs.highest(surfaces)),
            "output": rng.choice(["lines", "lines", "arcs", "nurbs"]), "side": rng.choice(["outside", "outside", "both"]),
            "direction": rng.choice("uv"), "traversal": rng.choice(["zigzag", "zigzag", "one_way"])}
    model_jobs.write(folder, surfaces, case)
    return kind.__name__, case


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("cusp")
    p.add_argument("--first", type=int, default=0)
    p.add_argument("--count", type=int, default=len(KINDS))
    p.add_argument("--keep")
    a = p.parse_args()
    bad = 0
    for seed in range(a.first, a.first + a.count):
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(a.keep, str(seed)) if a.keep else pathlib.Path(scratch)
            folder.mkdir(parents=True, exist_ok=True)
            name, case = make_case(seed, folder)
            fault, _ = model_jobs.judged(a.cusp, folder)
            if fault:
                bad += 1
                print(f"seed {seed} {name} {case}: {fault}", file=sys.stderr)
    print(f"{a.count} models from seed {a.first}, {bad} failed")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
