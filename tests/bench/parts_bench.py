#!/usr/bin/env python3
"""Times `cusp plan` and `cusp verify` on a dozen parts of kinds that users have, all made here.

usage: parts_bench.py CUSP [--part NAME ...] [--threads N ...] [--keep FOLDER]

Prints one row a part: processor time of one thread (user and system), wall time for each number of threads, the most
memory, and whether the bytes of all runs are equal. Wall times are meaningful on an idle machine only.
Exit status: 0 all planned and equal, 1 otherwise. Figures: docs/benchmarks.md.
"""
import argparse
import json
import math
import os
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import time

LIMIT = 900  # s


def write_stl(path, triangles):
    data = b"".join(struct.pack("<12fH", 0, 0, 0, *a, *b, *c, 0) for a, b, c in triangles)
    path.write_bytes(b"\0" * 80 + struct.pack("<I", len(triangles)) + data)


def grid_triangles(point, nu, nv):
    out = []
    for i in range(nu):
        for j in range(nv):
            a, b, c, d = point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)
            out += [(a, b, c), (a, c, d)]
    return out


def plate(x0, y0, x1, y1, z):
    a, b, c, d = (x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)
    return [(a, b, c), (a, c, d)]


def post(x, y, lean, turn, radius, height, sides=32):
    """A cylinder that leans by `lean` (tangent) towards `turn`, with a flat top."""
    dx, dy = lean * height * math.cos(turn), lean * height * math.sin(turn)

    def ring(k, top):
        angle = 2 * math.pi * k / sides
        return (x + radius * math.cos(angle) + top * dx, y + radius * math.sin(angle) + top * dy, -height + top * height)

    out = []
    for k in range(sides):
        out += [(ring(k, 0), ring(k + 1, 0), ring(k + 1, 1)), (ring(k, 0), ring(k + 1, 1), ring(k, 1)),
                (ring(k, 1), ring(k + 1, 1), (x + dx, y + dy, 0.0))]
    return out


def box(x0, y0, x1, y1, bottom, top, draft=0.0):
    """Four walls, drafted inwards by `draft` mm, and a top."""
    low = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    high = [(x0 + draft, y0 + draft), (x1 - draft, y0 + draft), (x1 - draft, y1 - draft), (x0 + draft, y1 - draft)]
    out = plate(x0 + draft, y0 + draft, x1 - draft, y1 - draft, top)
    for k in range(4):
        a, b = (*low[k], bottom), (*low[(k + 1) % 4], bottom)
        c, d = (*high[(k + 1) % 4], top), (*high[k], top)
        out += [(a, b, c), (a, c, d)]
    return out


def leaning_posts(folder):
    triangles = plate(-10, -10, 90, 70, -20)
    for k in range(12):
        triangles += post(10 + 23 * (k % 4), 10 + 22 * (k // 4), 0.3, 0.7 * k, 4, 20)
    write_stl(folder / "part.stl", triangles)


def noisy_scan(folder, n=110, noise=0.06):
    pick = random.Random(7)
    z = [[-4 + 3 * math.sin(5 * i / n) * math.cos(4 * j / n) + pick.uniform(-noise, noise) for j in range(n + 1)]
         for i in range(n + 1)]
    write_stl(folder / "part.stl", grid_triangles(lambda i, j: (60 * i / n, 60 * j / n, z[i][j]), n, n))


def waves_mesh(folder, n=100):
    write_stl(folder / "part.stl", grid_triangles(
        lambda i, j: (80 * i / n, 80 * j / n, -5 + 4 * math.sin(9 * i / n) * math.cos(8 * j / n)), n, n))


def letter(folder):
    triangles = plate(-5, -5, 55, 75, -8)
    for x0, y0, x1, y1 in ((5, 0, 15, 70), (15, 60, 45, 70), (15, 32, 38, 42), (35, 42, 45, 60)):
        triangles += box(x0, y0, x1, y1, -8, 0)
    write_stl(folder / "part.stl", triangles)


def drafted_boxes(folder):
    triangles = plate(-5, -5, 85, 65, -12)
    for k in range(6):
        x, y = 5 + 27 * (k % 3), 5 + 30 * (k // 3)
        triangles += box(x, y, x + 20, y + 22, -12, -k * 0.7, 12 * math.tan(math.radians(0.3 + 0.9 * k)))
    write_stl(folder / "part.stl", triangles)


def terraces(folder, n=60):
    def point(i, j):
        wave = math.sin(7 * i / n) * math.cos(6 * j / n)
        return (70 * i / n, 70 * j / n, -6 + 4 * math.floor(1.5 * wave) / 1.5)
    write_stl(folder / "part.stl", grid_triangles(point, n, n))


def lying_bottle(n, folder):
    def point(i, j):
        x, angle = 120 * i / n, math.pi * j / n
        r = 18 + 4 * math.tanh((40 - x) / 6) * -1 + (6 if 20 < x < 24 else 0)
        return (x, -r * math.cos(angle), r * math.sin(angle) - 30)
    return point


def bottle_mesh(folder, n=90):
    write_stl(folder / "part.stl", grid_triangles(lying_bottle(n, folder), n, n))


def clamped(count, degree):
    inner = count - degree
    return [0.0] * (degree + 1) + [k / inner for k in range(1, inner)] + [1.0] * (degree + 1)


def surface(points, nu, nv, degree_u=3, degree_v=3, weights=None):
    """Control points with v fastest."""
    control = {"points": [list(p) for p in points]}
    if weights:
        control["weights"] = weights
    return {"type": "spline", "rational": weights is not None, "dimension": 3, "degree_u": degree_u, "degree_v": degree_v,
            "size_u": nu, "size_v": nv, "knotvector_u": clamped(nu, degree_u), "knotvector_v": clamped(nv, degree_v),
            "control_points": control}


def write_surfaces(folder, surfaces):
    shape = {"type": "surface", "count": len(surfaces), "data": surfaces}
    (folder / "part.json").write_text(json.dumps({"shape": shape}))


def hills(folder, n=30):
    write_surfaces(folder, [surface([(90 * i / (n - 1), 90 * j / (n - 1), -6 + 5 * math.sin(0.9 * i) * math.cos(0.8 * j))
                                     for j in range(n) for i in range(n)], n, n)])


def tiles(folder, side=6, n=6):
    """Many faces whose common edges are creases."""
    out = []
    for a in range(side):
        for b in range(side):
            out.append(surface([(14 * (a + i / (n - 1)), 14 * (b + j / (n - 1)),
                                 -5 - 4 * abs(math.sin(math.pi * i / (n - 1))) * (1 + 0.3 * a) / 2.5
                                 - math.sin(math.pi * j / (n - 1)) * (1 + 0.2 * b) / 2)
                                for j in range(n) for i in range(n)], n, n))
    write_surfaces(folder, out)


def half_cylinders(folder):
    """Rational faces beside each other on a plate, as turned parts have."""
    w = math.sqrt(0.5)
    out = [surface([(x, y, -10) for y in (-5, 85) for x in (-5, 95)], 2, 2, 1, 1)]
    for k in range(6):
        y, r = 8 + 14 * k, 5 + 0.5 * k
        for side in (-1, 1):
            arc = [(0, r, 1.0), (side * r, r, w), (side * r, 0, 1.0)]
            out.append(surface([(x, y + a, -10 + b) for a, b, _ in arc for x in (5, 85)], 3, 2, 2, 1,
                               [weight for *_, weight in arc for _ in range(2)]))
    write_surfaces(folder, out)


def sharp_crest(folder, n=12):
    """A smooth surface whose control points nearly meet in a crest: its curvature there is huge."""
    xs = [0, 10, 20, 26, 29.999, 30, 30, 30.001, 34, 40, 50, 60]
    zs = [-9, -8, -6, -4, -0.001, 0, 0, -0.001, -4, -6, -8, -9]
    write_surfaces(folder, [surface([(50 * i / (n - 1), xs[j], zs[j]) for j in range(n) for i in range(n)], n, n)])


# Name: the function that makes it, and the job's keys other than floor and strategy.
ROUGH = {"roughing": True, "max_depth": 4, "tools": [2], "allowance": 0.3}
PARTS = {
    "leaning posts": (leaning_posts, {"scallop": 0.05}),
    "noisy scan": (noisy_scan, {"scallop": 0.05}),
    "waves, mesh": (waves_mesh, {"scallop": 0.03}),
    "letter": (letter, {"scallop": 0.05, **ROUGH}),
    "drafted boxes": (drafted_boxes, {"scallop": 0.05, **ROUGH}),
    "terraces": (terraces, {"scallop": 0.05, **ROUGH}),
    "bottle, mesh": (bottle_mesh, {"scallop": 0.05, **ROUGH}),
    "hills": (hills, {"scallop": 0.03}),
    "hills, roughed": (hills, {"scallop": 0.05, **ROUGH}),
    "36 tiles": (tiles, {"scallop": 0.05, **ROUGH}),
    "half cylinders": (half_cylinders, {"scallop": 0.05, **ROUGH}),
    "sharp crest": (sharp_crest, {"scallop": 0.05}),
}


def write_part(folder, name):
    make, keys = PARTS[name]
    make(folder)
    floor = "part.stl" if (folder / "part.stl").exists() else "part.json"
    lines = ["[[tool]]", "number = 1", 'shape = "ball"', "diameter = 6", "[[tool]]", "number = 2", 'shape = "flat"',
             "diameter = 8", "[cutting]", "feed = 1200", "spindle = 12000", "[stock]", "top = 10", "[[operation]]",
             'strategy = "adaptive_isocurve"', f'floor = ["{floor}"]', "tool = 1"]
    lines += [f"{key} = {json.dumps(value)}" for key, value in keys.items()]
    (folder / "job.toml").write_text("\n".join(lines) + "\n")


def measured(words, folder):
    """Exit status, processor time, wall time in s, and the most memory in MB; -1 for a run over the limit."""
    begin = time.monotonic()
    child = subprocess.Popen(words, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while True:
        done, status, used = os.wait4(child.pid, os.WNOHANG)
        if done:
            return (os.waitstatus_to_exitcode(status), used.ru_utime + used.ru_stime, time.monotonic() - begin,
                    used.ru_maxrss / 1000)
        if time.monotonic() - begin > LIMIT:
            child.kill()
        time.sleep(0.005)


def row_of(cusp, name, folder, threads):
    write_part(folder, name)
    outputs, cells, memory, sound = set(), [], 0.0, True
    for number in threads:
        status, cpu, wall, most = measured([cusp, "plan", "job.toml", "-o", "out.ngc", "--threads", str(number)], folder)
        program = folder / "out.ngc"
        outputs.add(program.read_bytes() if program.exists() else b"")
        check, check_cpu, check_wall, check_most = measured(
            [cusp, "verify", "job.toml", "out.ngc", "--threads", str(number), "--stats", "verify.json"], folder)
        sound = sound and status == 0 and check in (0, 1)
        memory = max(memory, most, check_most)
        cells.append(f"{cpu:.1f} | {wall:.1f} | {check_cpu:.1f} | {check_wall:.1f}")
    equal = len(outputs) == 1
    print(f"| {name} | " + " | ".join(cells) + f" | {memory:.0f} | {'yes' if equal and sound else 'NO'} |", flush=True)
    return equal and sound


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("cusp")
    parser.add_argument("--part", nargs="*", default=list(PARTS), choices=list(PARTS))
    parser.add_argument("--threads", nargs="*", type=int, default=[1, 2])
    parser.add_argument("--keep")
    args = parser.parse_args()
    heads = [f"plan x{n}, s CPU | s wall | verify x{n}, s CPU | s wall" for n in args.threads]
    print("| part | " + " | ".join(heads) + " | MB | equal |")
    print("|---|" + "---|" * (4 * len(heads) + 2))
    with tempfile.TemporaryDirectory() as place:
        sound = True
        for name in args.part:
            folder = pathlib.Path(args.keep or place) / name.replace(", ", "_").replace(" ", "_")
            folder.mkdir(parents=True, exist_ok=True)
            sound = row_of(pathlib.Path(args.cusp).resolve(), name, folder, args.threads) and sound
    return 0 if sound else 1


if __name__ == "__main__":
    sys.exit(main())
