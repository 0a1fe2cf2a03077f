#!/usr/bin/python3
"""Plans pockets with bounded engagement by `cusp` and by FreeCAD's Adaptive, and judges both by one raster cutter.

usage: freecad_adaptive.py CUSP [--pocket NAME ...] [--angle DEG] [--keep FOLDER] [--planner cusp|freecad ...]

Debian's freecad-python3 has area.Adaptive2d: apt-get install --no-install-recommends freecad-python3. Its paths become
G-code as PathAdaptive.py of FreeCAD 0.20 writes them, with its defaults: tolerance 0.1 mm, keep-down ratio 3, a finish
pass. Both planners: flat 6 mm, one layer of 4 mm, 1200 mm/min, plunges 300, helices of 3 degrees. FreeCAD's step-over is
the width of a straight cut at the angle.

The judge is apart from both. A raster of 0.05 mm, inside the pocket and a wide margin, is cut in steps of 0.1 mm; the
engagement is the angle of the points just outside the front half of the circle that stand. Accuracy: 1.5 degrees.

Prints a table: planning, s CPU; feed way in stock and in air, mm; lifts; share of the cut over the angle by more than
5 % and 1.5 degrees; the greatest angle; mm2 that stand though the tool reaches them (0.1 mm in); gouge, mm2 beyond the
walls by 0.1 mm; machine time by `cusp sim`, s. Exit status: 0 if cusp keeps all bounds and 0.9 of the time, else 1.
Figures: docs/benchmarks.md.
"""
import argparse
import json
import math
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np

RADIUS, DEPTH, FEED, PLUNGE = 3.0, 4.0, 1200.0, 300.0
GRID, STEP = 0.05, 0.1
CLEARANCE, LIFTED = 5.0, 1.0  # mm: z of lifts; a rapid above this z is one
FREECAD = ["/usr/lib/freecad-python3/lib", "/usr/lib/freecad/Mod/Path"]


def circle(x, y, r, n=180):
    return [(x + r * math.cos(2 * math.pi * k / n), y + r * math.sin(2 * math.pi * k / n)) for k in range(n)]


def box(x0, y0, x1, y1):
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


def spiral_arm():
    """A channel 16 mm wide along a spiral of 1.4 turns."""
    def at(t, side):
        r = 14 + 24 * t / (2 * math.pi) + side
        return r * math.cos(t), r * math.sin(t)

    ts = [2.8 * math.pi * k / 160 for k in range(161)]
    return [at(t, 8) for t in ts] + [at(t, -8) for t in reversed(ts)]


def star():
    return [((38 if k % 2 == 0 else 17) * math.cos(math.pi * k / 5), (38 if k % 2 == 0 else 17) * math.sin(math.pi * k / 5))
            for k in range(10)]


# the boundary, then islands
POCKETS = {
    "plain": [box(0, 0, 90, 70)],
    "notch": [[(0, 0), (40, 0), (40, 25), (50, 25), (50, 0), (90, 0), (90, 70), (0, 70)]],
    "round": [circle(0, 0, 40)],
    "round island": [box(0, 0, 90, 70), circle(45, 35, 12)],
    "three islands": [box(0, 0, 90, 70), box(15, 15, 30, 30), circle(60, 45, 10), [(55, 10), (80, 12), (66, 26)]],
    "neck": [[(0, 0), (35, 0), (35, 16), (55, 16), (55, 0), (90, 0), (90, 40), (55, 40), (55, 26), (35, 26), (35, 40), (0, 40)]],
    "corner": [[(0, 0), (90, 0), (90, 25), (25, 25), (25, 70), (0, 70)]],
    "star": [star()],
    "spiral": [spiral_arm()],
    "comb": [[(0, 0), (90, 0), (90, 60), (78, 60), (78, 20), (66, 20), (66, 60), (54, 60), (54, 20), (42, 20), (42, 60),
              (30, 60), (30, 20), (12, 20), (12, 60), (0, 60)]],
}


def write_dxf(path, loops):
    rows = ["0", "SECTION", "2", "HEADER", "9", "$INSUNITS", "70", "4", "0", "ENDSEC", "0", "SECTION", "2", "ENTITIES"]
    for loop in loops:
        rows += ["0", "LWPOLYLINE", "8", "pocket", "90", str(len(loop)), "70", "1"]
        for x, y in loop:
            rows += ["10", f"{x:.6f}", "20", f"{y:.6f}"]
    path.write_text("\n".join([*rows, "0", "ENDSEC", "0", "EOF", ""]))


JOB = """units = "mm"
[tool]
shape = "flat"
diameter = {diameter}
[cutting]
feed = {feed}
plunge_feed = {plunge}
[[operation]]
strategy = "pocket"
boundary = "pocket.dxf#pocket"
depth = {depth}
{keys}
output = "arcs"
"""


def plan_by_cusp(cusp, loops, angle, folder, keys=None):
    """(program, s CPU)"""
    write_dxf(folder / "pocket.dxf", loops)
    keys = keys or f'max_depth = {DEPTH}\nclearing = "adaptive"\nmax_engagement = {angle}'
    (folder / "job.toml").write_text(JOB.format(diameter=2 * RADIUS, feed=FEED, plunge=PLUNGE, depth=DEPTH, keys=keys))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    out = folder / "cusp.ngc"
    subprocess.run([cusp, "plan", folder / "job.toml", "-o", out], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return out, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def plan_by_freecad(loops, angle, folder):
    """(program, s CPU)"""
    sys.path[:0] = FREECAD
    import FreeCAD  # noqa: F401  (area needs it)
    import area

    planner = area.Adaptive2d()
    planner.stepOverFactor = 0.5 * (1 - math.cos(math.radians(angle)))
    planner.toolDiameter = 2 * RADIUS
    planner.helixRampDiameter = 0.0
    planner.keepToolDownDistRatio = 3.0
    planner.stockToLeave = 0.0
    planner.tolerance = 0.1
    planner.forceInsideOut = False
    planner.finishingProfile = True
    planner.opType = area.AdaptiveOperationType.ClearingInside
    xs, ys = [p[0] for p in loops[0]], [p[1] for p in loops[0]]
    stock = box(min(xs) - 10, min(ys) - 10, max(xs) + 10, max(ys) + 10)
    begin = time.process_time()
    results = planner.Execute([[list(p) for p in [*stock, stock[0]]]], [[list(p) for p in [*loop, loop[0]]] for loop in loops],
                              lambda paths: False)
    spent = time.process_time() - begin
    out = folder / "freecad.ngc"
    out.write_text(freecad_program(results, area.AdaptiveMotionType))
    return out, spent


def freecad_program(results, kinds):
    """GenerateGCode() of PathAdaptive.py for one layer, helices of lines."""
    rows = ["G21 G90 G17 G94", f"G0 Z{CLEARANCE}"]
    for region in results:
        (cx, cy), (sx, sy) = region.HelixCenterPoint, region.StartPoint
        radius = math.hypot(cx - sx, cy - sy)
        if radius > 0.01:
            r = radius - 0.01
            most = DEPTH / (2 * math.pi * radius * math.tan(math.radians(3))) * 2 * math.pi
            first = math.atan2(sy - cy, sx - cx) - most - math.pi / 16
            rows += [f"G0 X{cx + r * math.cos(first):.4f} Y{cy + r * math.sin(first):.4f}", f"G1 Z0 F{PLUNGE}"]
            fi = 0.0
            while fi < most + 2 * math.pi:
                z = -DEPTH * min(1.0, fi / most)
                rows.append(f"G1 X{cx + r * math.cos(first + fi):.4f} Y{cy + r * math.sin(first + fi):.4f} Z{z:.4f} "
                            f"F{PLUNGE if fi < most else FEED}")
                fi += math.pi / 16
        else:
            rows += [f"G0 X{sx:.4f} Y{sy:.4f}", f"G1 Z{-DEPTH} F{PLUNGE}"]
        z_now = -DEPTH
        for kind, points in region.AdaptivePaths:
            cuts = kind == int(kinds.Cutting)
            z = CLEARANCE if kind == int(kinds.LinkNotClear) else -DEPTH
            for x, y in points:
                if z != z_now:
                    rows.append(f"G1 Z{z} F{PLUNGE}" if cuts else f"G0 Z{z}")
                    z_now = z
                rows.append(f"G{1 if cuts else 0} X{x:.4f} Y{y:.4f}" + (f" F{FEED}" if cuts else ""))
        rows.append(f"G0 Z{CLEARANCE}")
    return "\n".join([*rows, "M2", ""])


def moves_of(text):
    """(rapid, points) of G0 to G3 in millimetres, absolute, arcs in XY by I and J."""
    at, mode = np.array([0.0, 0.0, CLEARANCE]), 0
    word = re.compile(r"([A-Z])\s*([-+]?\d*\.?\d+)")
    for line in text.splitlines():
        words = word.findall(re.sub(r"\([^)]*\)", "", line.split(";")[0]))
        for letter, value in words:
            if letter == "G" and float(value) in (0, 1, 2, 3):
                mode = int(float(value))
        values = {letter: float(value) for letter, value in words if letter in "XYZIJ"}
        if not values:
            continue
        end = np.array([values.get(a, at[k]) for k, a in enumerate("XYZ")])
        if mode < 2:
            yield mode == 0, np.stack([at, end])
        else:
            centre = at[:2] + [values.get("I", 0.0), values.get("J", 0.0)]
            r = math.hypot(*(at[:2] - centre))
            a0, a1 = math.atan2(*(at[:2] - centre)[::-1]), math.atan2(*(end[:2] - centre)[::-1])
            turn = (a1 - a0) % (2 * math.pi) if mode == 3 else -((a0 - a1) % (2 * math.pi))
            turn = turn or (2 * math.pi if mode == 3 else -2 * math.pi)
            n = max(2, math.ceil(abs(turn) / 0.02))
            share = np.arange(n + 1) / n
            yield False, np.stack([centre[0] + r * np.cos(a0 + turn * share), centre[1] + r * np.sin(a0 + turn * share),
                                   at[2] + (end[2] - at[2]) * share], axis=1)
        at = end


class Raster:
    """One layer of stock over the pocket and 2 mm beyond its walls."""

    def __init__(self, loops):
        xs, ys = [p[0] for p in loops[0]], [p[1] for p in loops[0]]
        pad = RADIUS + 2.0
        self.x0, self.y0 = min(xs) - pad, min(ys) - pad
        self.nx, self.ny = int((max(xs) + pad - self.x0) / GRID) + 1, int((max(ys) + pad - self.y0) / GRID) + 1
        self.depth = np.zeros((self.nx, self.ny), np.float32)
        self.loops = loops

    def cell(self, x, y):
        return np.clip(np.rint((x - self.x0) / GRID).astype(int), 0, self.nx - 1), np.clip(
            np.rint((y - self.y0) / GRID).astype(int), 0, self.ny - 1)

    def inside(self):
        x, y = self.x0 + GRID * np.arange(self.nx), self.y0 + GRID * np.arange(self.ny)
        odd = np.zeros((self.nx, self.ny), bool)
        for loop in self.loops:
            for (ax, ay), (bx, by) in zip(loop, loop[1:] + loop[:1]):
                rows = np.nonzero((ay > y) != (by > y))[0]
                for j in rows:
                    odd[: max(0, int(np.ceil((ax + (y[j] - ay) / (by - ay) * (bx - ax) - self.x0) / GRID))), j] ^= True
        return odd

    def near_walls(self, reach):
        """Cells within `reach` of the walls."""
        near = np.zeros((self.nx, self.ny), bool)
        for loop in self.loops:
            for a, b in zip(loop, loop[1:] + loop[:1]):
                a, b = np.array(a), np.array(b)
                lo, hi = np.minimum(a, b) - reach, np.maximum(a, b) + reach
                i0, j0 = self.cell(lo[0], lo[1])
                i1, j1 = self.cell(hi[0], hi[1])
                x, y = np.meshgrid(self.x0 + GRID * np.arange(i0, i1 + 1), self.y0 + GRID * np.arange(j0, j1 + 1), indexing="ij")
                d = b - a
                t = np.clip(((x - a[0]) * d[0] + (y - a[1]) * d[1]) / max(d @ d, 1e-12), 0, 1)
                near[i0:i1 + 1, j0:j1 + 1] |= (x - a[0] - t * d[0])**2 + (y - a[1] - t * d[1])**2 < reach * reach
        return near


def disc_cells(reach):
    n = int(reach / GRID) + 1
    k = GRID * np.arange(-n, n + 1)
    i, j = np.nonzero(np.add.outer(k * k, k * k) <= reach * reach)
    return i - n, j - n


def judge(program, loops, angle):
    raster = Raster(loops)
    theta = np.radians(np.arange(-90, 90.5, 1.0))
    cos, sin = (RADIUS + 0.75 * GRID) * np.cos(theta), (RADIUS + 0.75 * GRID) * np.sin(theta)
    n = int(RADIUS / GRID) + 1
    found = dict.fromkeys(("cut", "air", "over", "worst", "entries", "rapid"), 0.0)
    lifts, up = 0, True
    for rapid, points in moves_of(program.read_text()):
        d = np.linalg.norm(np.diff(points, axis=0), axis=1)
        way = np.r_[0.0, np.cumsum(d)]
        if way[-1] < 1e-9:
            continue
        high = points[-1][2] > LIFTED
        lifts += high and not up
        up = high
        at = np.linspace(0.0, way[-1], max(1, math.ceil(way[-1] / STEP)) + 1)
        q = np.stack([np.interp(at, way, points[:, k]) for k in range(3)], axis=1)
        for a, b in zip(q[:-1], q[1:]):
            step = np.linalg.norm(b - a)
            flat = np.hypot(b[0] - a[0], b[1] - a[1])
            enters = b[2] - a[2] < -0.02 * step
            if min(a[2], b[2]) > 0:
                found["air"] += 0 if rapid else step
                continue
            i, j = raster.cell(b[0], b[1])
            i0, j0 = max(0, i - n), max(0, j - n)
            x = raster.x0 + GRID * np.arange(i0, min(raster.nx, i + n + 1)) - b[0]
            y = raster.y0 + GRID * np.arange(j0, min(raster.ny, j + n + 1)) - b[1]
            part = raster.depth[i0:i0 + len(x), j0:j0 + len(y)]
            hit = (np.add.outer(x * x, y * y) <= RADIUS * RADIUS) & (part > b[2])
            if not enters and not rapid and flat > 0:
                c, s = (b[:2] - a[:2]) / flat
                k, l = raster.cell(a[0] + c * cos - s * sin, a[1] + s * cos + c * sin)
                open_angle = float(np.count_nonzero(raster.depth[k, l] > max(a[2], b[2]) + 1e-4)) * 180 / len(theta)
                found["cut" if open_angle > 0 else "air"] += step
                found["over"] += step if open_angle > 1.05 * angle + 1.5 else 0.0
                found["worst"] = max(found["worst"], open_angle)
            elif not rapid:
                found["entries"] += step
            if hit.any():
                if rapid:
                    found["rapid"] = max(found["rapid"], float((part[hit] - b[2]).max()))
                part[hit] = b[2]
    inside = raster.inside()
    standing = raster.depth > -DEPTH + 1e-3
    found["gouge"] = np.count_nonzero((raster.depth < -1e-3) & ~inside & ~raster.near_walls(0.1)) * GRID**2
    centres = inside & ~raster.near_walls(RADIUS + 0.05)
    di, dj = disc_cells(RADIUS - 0.1)
    stays = 0
    for i, j in zip(*np.nonzero(standing & inside)):
        ci, cj = i + di, j + dj
        ok = (ci >= 0) & (cj >= 0) & (ci < raster.nx) & (cj < raster.ny)
        stays += centres[ci[ok], cj[ok]].any()
    found["uncut"] = stays * GRID**2
    found["lifts"] = lifts
    return found


def machine_time(cusp, program):
    stats = program.with_suffix(".sim.json")
    subprocess.run([cusp, "sim", program, "--stats", stats], check=True, stdout=subprocess.DEVNULL)
    return json.loads(stats.read_text())["total_s"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cusp")
    parser.add_argument("--pocket", action="append", choices=POCKETS)
    parser.add_argument("--planner", action="append", choices=["cusp", "freecad"])
    parser.add_argument("--angle", type=float, default=60.0)
    parser.add_argument("--keep", type=pathlib.Path)
    args = parser.parse_args()
    print("| pocket | planner | plan, s | cut, mm | air, mm | lifts | over | most, deg | uncut, mm2 | gouge, mm2 | time, s | ratio |\n"
          "|---|---|---|---|---|---|---|---|---|---|---|---|")
    good = True
    with tempfile.TemporaryDirectory() as scratch:
        for name in args.pocket or POCKETS:
            loops = POCKETS[name]
            folder = (args.keep or pathlib.Path(scratch)) / name.replace(" ", "_")
            folder.mkdir(parents=True, exist_ok=True)
            peer = None
            for planner in args.planner or ["freecad", "cusp"]:
                program, spent = (plan_by_freecad(loops, args.angle, folder) if planner == "freecad" else
                                  plan_by_cusp(args.cusp, loops, args.angle, folder))
                seconds = machine_time(args.cusp, program)
                found = judge(program, loops, args.angle)
                share = found["over"] / max(found["cut"], 1e-9)
                ratio = ""
                if planner == "freecad":
                    peer = seconds
                elif peer:
                    ratio = f"{seconds / peer:.2f}"
                if planner == "cusp":
                    good = good and share <= 0.001 and found["uncut"] < 0.05 and found["gouge"] == 0 and not (
                        peer and seconds > 0.9 * peer)
                if found["rapid"] > 0.01:
                    print(f"{planner}: rapid moves of {name} cut {found['rapid']:.3f} mm", file=sys.stderr)
                print(f"| {name} | {planner} | {spent:.2f} | {found['cut']:.0f} | {found['air']:.0f} | {found['lifts']} | "
                      f"{100 * share:.3f} % | {found['worst']:.0f} | {found['uncut']:.2f} | {found['gouge']:.2f} | {seconds:.1f} | "
                      f"{ratio} |", flush=True)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
