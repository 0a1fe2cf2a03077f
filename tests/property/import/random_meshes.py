#!/usr/bin/env python3
"""Random STL parts with vertical walls, planned and judged against their triangles, not against the surfaces made of them.

usage: random_meshes.py CUSP [--first SEED] [--count N] [--keep FOLDER]

Boxes and steps on a plate, cylinders, domes and barrels on walls, drafted blocks, half pipes, wavy
lids. Every place of the path is
compared with all triangles near it: the ball with facets, sides and corners, the shank over it seen from above. What is
left is compared with the ball's lowest positions over the part's own heights. Exit status 1 where a bound does not hold.
"""
import argparse
import json
import math
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import time

import numpy

SIZE = 24.0  # mm
GRID = 0.2
STEP = 0.15


def quad(a, b, c, d):
    return [(a, b, c), (a, c, d)]


def prism(outline, z0, z1):
    """A closed vertical prism over a counter-clockwise outline, its ends as fans about their middles."""
    n = len(outline)
    middle = (sum(p[0] for p in outline) / n, sum(p[1] for p in outline) / n)
    out = []
    for k in range(n):
        a, b = outline[k], outline[(k + 1) % n]
        out += quad((*a, z0), (*b, z0), (*b, z1), (*a, z1))
        out.append(((*a, z1), (*b, z1), (*middle, z1)))
        out.append(((*b, z0), (*a, z0), (*middle, z0)))
    return out


def rectangle(x0, x1, y0, y1):
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


def circle(x, y, r, n):
    return [(x + r * math.cos(2 * math.pi * k / n), y + r * math.sin(2 * math.pi * k / n)) for k in range(n)]


def plate():
    return prism(rectangle(0, SIZE, 0, SIZE), -12, -10)


def terraces(rng):
    """One closed skin over a net of rectangles of different heights."""
    xs = [0] + sorted(rng.uniform(3, SIZE - 3) for _ in range(rng.randint(1, 3))) + [SIZE]
    ys = [0] + sorted(rng.uniform(3, SIZE - 3) for _ in range(rng.randint(0, 2))) + [SIZE]
    height = {(i, j): rng.choice([-10.0, -8.0, -6.5, -3.0]) for i in range(len(xs) - 1) for j in range(len(ys) - 1)}
    out = []
    for (i, j), z in height.items():
        x0, x1, y0, y1 = xs[i], xs[i + 1], ys[j], ys[j + 1]
        out += quad((x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z))
        out += quad((x0, y1, -12), (x1, y1, -12), (x1, y0, -12), (x0, y0, -12))
        for (di, dj), a, b in (((1, 0), (x1, y0), (x1, y1)), ((-1, 0), (x0, y1), (x0, y0)), ((0, 1), (x1, y1), (x0, y1)),
                               ((0, -1), (x0, y0), (x1, y0))):
            beside = height.get((i + di, j + dj), -12.0)
            if z > beside:
                out += quad((*a, beside), (*b, beside), (*b, z), (*a, z))
    return out


def boxes(rng):
    out = plate()
    for _ in range(rng.randint(1, 4)):
        x, y = rng.uniform(2, 15), rng.uniform(2, 15)
        turn = rng.uniform(0, 1.5)
        w, d = rng.uniform(3, 8), rng.uniform(3, 8)
        corners = [(x + math.cos(turn) * a - math.sin(turn) * b, y + math.sin(turn) * a + math.cos(turn) * b)
                   for a, b in rectangle(0, w, 0, d)]
        corners = [(min(max(px, 0.5), SIZE - 0.5), min(max(py, 0.5), SIZE - 0.5)) for px, py in corners]
        out += prism(corners, -10, -10 + rng.uniform(1, 7))
    return out


def cylinders(rng):
    out = plate()
    for x in (7, 17):
        out += prism(circle(x, rng.uniform(8, 16), rng.uniform(2, 4.5), rng.choice([24, 48, 96])), -10, rng.uniform(-8, -3))
    return out


def dome(rng):
    """A cap on a vertical wall, on a plate."""
    n, rings = rng.choice([32, 64]), rng.choice([8, 16])
    r, wall = rng.uniform(5, 9), rng.uniform(1, 3)
    most = rng.uniform(0.5, 1.3)  # radians from the top to where the wall begins
    ball = r / math.sin(most)
    out = plate()
    top = [circle(12, 12, ball * math.sin(most * k / rings), n) for k in range(1, rings + 1)]
    z = [-10 + wall + ball * (math.cos(most * k / rings) - math.cos(most)) for k in range(rings + 1)]
    for k in range(n):
        m = (k + 1) % n
        out.append(((12, 12, z[0]), (*top[0][k], z[1]), (*top[0][m], z[1])))
        for ring in range(rings - 1):
            out += quad((*top[ring][k], z[ring + 1]), (*top[ring + 1][k], z[ring + 2]), (*top[ring + 1][m], z[ring + 2]),
                        (*top[ring][m], z[ring + 1]))
        out += quad((*top[-1][k], -10), (*top[-1][m], -10), (*top[-1][m], z[-1]), (*top[-1][k], z[-1]))
    return out


def drafted(rng):
    out = plate()
    low, high, h = rng.uniform(6, 9), rng.uniform(3, 5.5), rng.uniform(3, 7)
    a = [(12 + x * low, 12 + y * low) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    b = [(12 + x * high, 12 + y * high) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    for k in range(4):
        m = (k + 1) % 4
        out += quad((*a[k], -10), (*a[m], -10), (*b[m], -10 + h), (*b[k], -10 + h))
    return out + quad(*[(*p, -10 + h) for p in b])


def half_pipe(rng):
    out = plate()
    r, n = rng.uniform(3, 7), rng.choice([24, 60])
    y0, y1 = 4, 20
    ring = [(12 + r * math.cos(math.pi * k / n), -10 + r * math.sin(math.pi * k / n)) for k in range(n + 1)]
    for k in range(n):
        (xa, za), (xb, zb) = ring[k], ring[k + 1]
        out += quad((xa, y0, za), (xa, y1, za), (xb, y1, zb), (xb, y0, zb))
        out.append(((12, y0, -10), (xa, y0, za), (xb, y0, zb)))
        out.append(((12, y1, -10), (xb, y1, zb), (xa, y1, za)))
    return out


def barrel(rng):
    """A cylinder's upper side on vertical walls, its facets long and narrow."""
    r, n = rng.uniform(12, 25), rng.choice([16, 48])
    a, b = rng.uniform(5, 9), rng.uniform(5, 9)
    out = plate()
    ys = [12 - b + 2 * b * k / n for k in range(n + 1)]
    zs = [-4 - r + math.sqrt(r * r - (y - 12)**2) for y in ys]
    for k in range(n):
        low, high = (ys[k], zs[k]), (ys[k + 1], zs[k + 1])
        out += quad((12 - a, *low), (12 + a, *low), (12 + a, *high), (12 - a, *high))
        for x in (12 - a, 12 + a):
            out += quad((x, ys[k], -10), (x, ys[k + 1], -10), (x, *high), (x, *low))
    for y, z in ((ys[0], zs[0]), (ys[-1], zs[-1])):
        out += quad((12 - a, y, -10), (12 + a, y, -10), (12 + a, y, z), (12 - a, y, z))
    return out


def wavy_lid(rng, n=24):
    a, f, g = rng.uniform(0.5, 1.5), rng.uniform(0.2, 0.45), rng.uniform(0.2, 0.45)
    x0, x1 = 4.0, 20.0

    def z(x, y):
        return -5 + a * math.sin(f * x) * math.cos(g * y)

    out = plate()
    at = [x0 + (x1 - x0) * k / n for k in range(n + 1)]
    for i in range(n):
        for j in range(n):
            p = [(x, y, z(x, y)) for x, y in ((at[i], at[j]), (at[i + 1], at[j]), (at[i + 1], at[j + 1]), (at[i], at[j + 1]))]
            out += quad(*p)
        for (xa, ya), (xb, yb) in (((at[i], x0), (at[i + 1], x0)), ((at[i + 1], x1), (at[i], x1)),
                                   ((x1, at[i]), (x1, at[i + 1])), ((x0, at[i + 1]), (x0, at[i]))):
            out += quad((xa, ya, -10), (xb, yb, -10), (xb, yb, z(xb, yb)), (xa, ya, z(xa, ya)))
    return out


KINDS = [terraces, boxes, cylinders, dome, drafted, half_pipe, wavy_lid, barrel]


def write_stl(path, triangles, binary):
    if binary:
        with open(path, "wb") as f:
            f.write(b" " * 80 + struct.pack("<I", len(triangles)))
            for t in triangles:
                f.write(struct.pack("<12fH", 0, 0, 0, *[c for p in t for c in p], 0))
        return
    with open(path, "w") as f:
        f.write("solid part\n")
        for t in triangles:
            f.write(" facet normal 0 0 0\n  outer loop\n")
            for p in t:
                f.write("   vertex {:.6e} {:.6e} {:.6e}\n".format(*p))
            f.write("  endloop\n endfacet\n")
        f.write("endsolid part\n")


def places(program):
    """Ends of moves below the clearance height, and places between them."""
    at = [0.0, 0.0, 100.0]
    out = []
    for line in pathlib.Path(program).read_text().splitlines():
        words = line.split("(")[0].split()
        if not any(w[0] in "XYZ" for w in words):
            continue
        to = list(at)
        for w in words:
            if w[0] in "XYZ":
                to["XYZ".index(w[0])] = float(w[1:])
        if min(at[2], to[2]) < 1:
            parts = 1 + int(math.dist(at, to) / STEP)
            out += [[a + (b - a) * k / parts for a, b in zip(at, to)] for k in range(1, parts + 1)]
        at = to
    return numpy.array(out)


def distances(points, t):
    """Distances of points from one triangle each: facets, sides, corners (Ericson, Real-Time Collision Detection, 5.1.5)."""
    a, b, c = t[:, 0], t[:, 1], t[:, 2]
    best = numpy.full(len(points), numpy.inf)
    for p, q in ((a, b), (b, c), (c, a)):
        side = q - p
        s = numpy.clip(((points - p) * side).sum(1) / numpy.maximum((side * side).sum(1), 1e-300), 0, 1)
        best = numpy.minimum(best, numpy.linalg.norm(points - p - side * s[:, None], axis=1))
    n = numpy.cross(b - a, c - a)
    n /= numpy.linalg.norm(n, axis=1)[:, None]
    off = ((points - a) * n).sum(1)
    foot = points - n * off[:, None]
    inside = numpy.ones(len(points), bool)
    for p, q in ((a, b), (b, c), (c, a)):
        inside &= (numpy.cross(q - p, foot - p) * n).sum(1) >= 0
    return numpy.where(inside, numpy.minimum(best, abs(off)), best)


def deepest(tips, radius, triangles):
    """Depth of ball and shank in triangles."""
    t = numpy.array(triangles)
    low, high = t.min(1), t.max(1)
    worst = 0.0
    for tip in tips:
        centre = tip + [0, 0, radius]
        near = numpy.all((low <= centre + radius) & (high >= centre - radius), axis=1)
        if near.any():
            d = distances(numpy.repeat(centre[None], near.sum(), 0), t[near])
            worst = max(worst, radius - d.min())
        over = (low[:, 0] < tip[0] + radius) & (high[:, 0] > tip[0] - radius) & (low[:, 1] < tip[1] + radius) & (
            high[:, 1] > tip[1] - radius) & (high[:, 2] > centre[2])
        for corners in t[over]:
            # Sampled where it is above the centre, from its highest corner downwards.
            for s in numpy.linspace(0, 1, 9):
                for u in numpy.linspace(0, 1, 9):
                    p = corners[0] + (corners[1] - corners[0]) * s * (1 - u) + (corners[2] - corners[0]) * u * s
                    if p[2] > centre[2]:
                        worst = max(worst, radius - math.hypot(p[0] - tip[0], p[1] - tip[1]))
    return worst


def heights(triangles, xs, ys):
    """Heights of the part seen from above, and the cosine of the slope there."""
    z = numpy.full((len(xs), len(ys)), -numpy.inf)
    cosine = numpy.ones((len(xs), len(ys)))
    for a, b, c in numpy.array(triangles):
        det = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
        if abs(det) < 1e-12:
            continue
        i0, i1 = numpy.searchsorted(xs, [min(a[0], b[0], c[0]) - 1e-9, max(a[0], b[0], c[0]) + 1e-9])
        j0, j1 = numpy.searchsorted(ys, [min(a[1], b[1], c[1]) - 1e-9, max(a[1], b[1], c[1]) + 1e-9])
        x, y = numpy.meshgrid(xs[i0:i1], ys[j0:j1], indexing="ij")
        s = ((x - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (y - a[1])) / det
        u = ((b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1])) / det
        inside = (s >= -1e-9) & (u >= -1e-9) & (s + u <= 1 + 1e-9)
        h = a[2] + s * (b[2] - a[2]) + u * (c[2] - a[2])
        n = numpy.cross(b - a, c - a)
        higher = inside & (h > z[i0:i1, j0:j1])
        cosine[i0:i1, j0:j1] = numpy.where(higher, abs(n[2]) / numpy.linalg.norm(n), cosine[i0:i1, j0:j1])
        z[i0:i1, j0:j1] = numpy.where(higher, h, z[i0:i1, j0:j1])
    return z, cosine


def under_ball(z, radius, sign):
    """sign 1: the lowest tips over heights z; sign -1: the heights that tips z leave."""
    n = int(radius / GRID)
    padded = numpy.pad(z, n, constant_values=-numpy.inf if sign > 0 else numpy.inf)
    out = numpy.full(z.shape, -numpy.inf if sign > 0 else numpy.inf)
    for i in range(-n, n + 1):
        for j in range(-n, n + 1):
            away = GRID * math.hypot(i, j)
            if away <= radius:
                rise = radius - math.sqrt(radius * radius - away * away)
                part = padded[n + i:n + i + z.shape[0], n + j:n + j + z.shape[1]]
                out = numpy.maximum(out, part - rise) if sign > 0 else numpy.minimum(out, part + rise)
    return out


def left(tips, radius, triangles):
    """Stock over the reachable height, along the normal, on a grid: 99th percentile, and maximum away from walls."""
    xs = numpy.arange(GRID / 2, SIZE, GRID)
    part, cosine = heights(triangles, xs, xs)
    reach = under_ball(under_ball(part, radius, 1), radius, -1)
    stock = numpy.zeros(part.shape)
    n = int(radius / GRID) + 1
    offsets = numpy.array([(i, j) for i in range(-n, n + 1) for j in range(-n, n + 1)])
    for tip in tips:
        at = numpy.floor(tip[:2] / GRID).astype(int) + offsets
        at = at[(at >= 0).all(1) & (at < len(xs)).all(1)]
        away = numpy.hypot(xs[at[:, 0]] - tip[0], xs[at[:, 1]] - tip[1])
        on = away <= radius
        z = tip[2] + radius - numpy.sqrt(radius * radius - away[on]**2)
        index = (at[on, 0], at[on, 1])
        stock[index] = numpy.minimum(stock[index], z)
    over = (stock - numpy.maximum(reach, part)) * cosine
    # Beside walls the grid resolves neither their positions nor the reach of the ball.
    n = int(radius / GRID) + 2
    padded = numpy.pad(part, n, mode="edge")
    around = numpy.full(part.shape, -numpy.inf)
    for i in range(2 * n + 1):
        for j in range(2 * n + 1):
            around = numpy.maximum(around, padded[i:i + part.shape[0], j:j + part.shape[1]])
    open_ground = over[around - part < 0.3]
    return float(numpy.percentile(over, 99)), float(open_ground.max()) if open_ground.size else 0.0


def judge(cusp, seed, folder):
    rng = random.Random(seed)
    kind = KINDS[seed % len(KINDS)]
    triangles = kind(rng)
    write_stl(folder / "part.stl", triangles, seed % 2 == 0)
    radius, scallop, tolerance = rng.choice([1.0, 1.5, 2.0]), rng.choice([0.04, 0.08]), 0.01
    (folder / "job.toml").write_text(f"""[tool]
shape = "ball"
diameter = {2 * radius}
[cutting]
feed = 1000.0
[stock]
top = 0.0
clearance = 5.0
[[operation]]
strategy = "adaptive_isocurve"
floor = ["part.stl"]
output = "lines"
scallop = {scallop}
floor_tolerance = {tolerance}
""")
    begin = time.time()
    run = subprocess.run([cusp, "plan", "--estimate-times", folder / "job.toml", "-o", folder / "part.ngc", "--stats", folder / "stats.json"],
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    seconds = time.time() - begin
    if run.returncode != 0:
        print(f"seed {seed} {kind.__name__}: {run.stdout}")
        return False
    stats = json.loads((folder / "stats.json").read_text())["operations"][0]
    tips = places(folder / "part.ngc")
    gouge = deepest(tips, radius, triangles)
    most, level = left(tips, radius, triangles)
    bound = stats["scallop_bound_mm"] + tolerance
    holds = gouge <= 2e-3 and level <= bound + 2e-3 and most <= bound + 0.05
    print(f"seed {seed} {kind.__name__}: {len(triangles)} triangles, R {radius}, scallop {scallop}: gouge {gouge:.4f}, "
          f"left {most:.3f} (99 of 100), {level:.3f} on open ground, bound {stats['scallop_bound_mm']:.3f}; {len(tips)} places, "
          f"{seconds:.1f} s{'' if holds else '  BROKEN'}")
    for line in run.stdout.splitlines():
        if "warning" in line or "note" in line:
            print("  ", line)
    return holds


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cusp")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=8)
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the cases, instead of a temporary one")
    options = parser.parse_args()
    good = True
    for seed in range(options.first, options.first + options.count):
        if options.keep:
            folder = options.keep / str(seed)
            folder.mkdir(parents=True, exist_ok=True)
            good = judge(options.cusp, seed, folder) and good
            continue
        with tempfile.TemporaryDirectory() as name:
            good = judge(options.cusp, seed, pathlib.Path(name)) and good
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
