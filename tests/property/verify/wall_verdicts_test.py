#!/usr/bin/env python3
"""Verdicts of cusp verify on walls and curves: pockets with islands, open pockets, profiles, engravings, v_carve, by flat,
bull, ball ends and vees, in mm and inch, by all posts. A sound program holds. One point of its path moved by 0.05, 0.1 or
0.17 mm, into the part or away from it, is found with its line, its place and the size that brute force says.

usage: wall_verdicts_test.py CUSP [CASES [FIRST_SEED]]; CUSP_PROPERTY_CASES and CUSP_PROPERTY_FIRST count too
"""
import math
import pathlib
import random
import re
import shutil
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from verdicts_test import INCH, POSTS, entity, polyline, property_cases, property_seed, run, verify  # noqa: E402

CASES = property_cases(int(sys.argv[2]) if len(sys.argv) > 2 else 10)
FIRST = property_seed(sys.argv[3] if len(sys.argv) > 3 else 1)
KINDS = ("islands", "open", "profile", "engrave", "v_carve", "on")
TOLERANCE = 0.0205  # mm: plan_tolerance and the judge's own


def ring(points):
    return list(zip(points, points[1:] + points[:1]))


def star(r, count, low, high, x=0.0, y=0.0):
    turn = r.uniform(0, 2 * math.pi)
    out = []
    for k in range(count):
        radius, angle = r.uniform(low, high), turn + 2 * math.pi * k / count
        out.append((round(x + radius * math.cos(angle), 5), round(y + radius * math.sin(angle), 5)))
    return out


def circle(x, y, radius, count=720):
    return [(x + radius * math.cos(2 * math.pi * k / count), y + radius * math.sin(2 * math.pi * k / count))
            for k in range(count)]


def away(p, segment):
    (ax, ay), (bx, by) = segment
    dx, dy = bx - ax, by - ay
    squared = dx * dx + dy * dy
    t = 0.0 if squared == 0 else min(1.0, max(0.0, ((p[0] - ax) * dx + (p[1] - ay) * dy) / squared))
    foot = (ax + t * dx, ay + t * dy)
    return math.hypot(p[0] - foot[0], p[1] - foot[1]), foot


def nearest(p, segments):
    return min((*away(p, s), s) for s in segments)


class Job:
    def __init__(self, seed):
        r = self.random = random.Random(seed)
        self.kind = KINDS[seed % len(KINDS)]
        self.post = POSTS[r.randrange(len(POSTS))]
        self.inch = r.random() < 0.5
        self.unit = INCH if self.inch else 1.0
        self.depth = round(r.uniform(2, 4), 2)
        self.shape = {"engrave": ("vee", "ball", "flat"), "v_carve": ("vee",), "open": ("flat",)}.get(
            self.kind, ("flat", "bull", "ball"))[r.randrange(3) % {"v_carve": 1, "open": 1}.get(self.kind, 3)]
        self.diameter = r.choice((1.0, 2.0)) if self.kind == "engrave" and self.shape != "vee" else r.choice((3.0, 4.0, 6.0))
        self.angle = r.choice((60, 90))
        self.corner = 0.5 if self.shape == "bull" else self.diameter / 2 if self.shape == "ball" else 0.0
        if self.kind == "engrave":
            self.depth = round(r.uniform(0.2, 0.6), 2)
        if self.shape == "ball" and self.kind != "engrave":
            self.depth = max(self.depth, self.diameter / 2 + 0.2)
        if self.kind == "v_carve":
            self.depth = 0.9 * self.diameter / 2 / math.tan(math.radians(self.angle / 2))
        self.side, self.outline = "inside", []
        getattr(self, "draw_" + self.kind)()

    def length(self, mm):
        return f"{mm / self.unit:.6f}"

    def loop(self, points):
        self.walls += ring(points)
        self.outline += ring(points)
        self.drawing += polyline("o", [(x, y, 0) for x, y in points])

    def draw_islands(self):
        self.walls, self.drawing = [], ""
        r = self.random
        self.loop(star(r, r.randint(4, 9), 17, 24))
        if r.random() < 0.7:
            self.loop(star(r, r.randint(3, 6), 2, 6))
        else:
            radius = round(r.uniform(2, 5), 3)
            self.walls += ring(circle(0, 0, radius))
            self.outline += ring(circle(0, 0, radius))
            self.drawing += entity("CIRCLE", "o", (10, 0), (20, 0), (40, radius))
        self.extra = r.choice(("", 'clearing = "adaptive"\n')) if self.shape == "flat" else ""
        self.words = f'strategy = "pocket"\n{self.extra}'

    def draw_open(self):
        self.walls, self.drawing = [], ""
        r = self.random
        low, high = -round(r.uniform(8, 14), 3), round(r.uniform(8, 14), 3)
        left, count = -round(r.uniform(8, 18), 3), r.randint(3, 6)
        points = [(30, low), (30, high)] + [
            (round(left + r.uniform(-4, 6), 3), round(high + (low - high) * k / count, 3)) for k in range(count + 1)]
        self.loop(points)
        self.walls = [s for s in self.walls if s[0][0] < 29 or s[1][0] < 29]
        self.words = 'strategy = "pocket"\nclearing = "adaptive"\n'

    def draw_profile(self):
        self.walls, self.drawing = [], ""
        r = self.random
        self.side = r.choice(("outside", "inside"))
        self.loop(star(r, r.randint(3, 9), 13, 20))
        self.words = (f'strategy = "profile"\nside = "{self.side}"\n' +
                      r.choice(("", f"lead_in = {self.length(r.choice((0, 1.5)))}\n")))

    def draw_on(self):
        self.draw_profile()
        self.words = 'strategy = "profile"\nside = "on"\n'

    def draw_engrave(self):
        self.walls, self.drawing = [], ""
        r = self.random
        for _ in range(r.randint(1, 4)):
            points = star(r, r.randint(3, 8), 3, 9, r.uniform(-10, 10), r.uniform(-10, 10))
            if r.random() < 0.5:
                self.loop(points)
                continue
            self.walls += list(zip(points, points[1:]))
            self.drawing += entity("LWPOLYLINE", "o", (90, len(points)), (70, 0), *(
                pair for x, y in points for pair in ((10, x), (20, y))))
        self.words = 'strategy = "engrave"\n'

    def draw_v_carve(self):
        self.walls, self.drawing = [], ""
        r = self.random
        self.loop(star(r, r.randint(3, 8), 6, 16))
        self.words = 'strategy = "v_carve"\n'

    def write(self, folder):
        number = self.length
        (folder / "part.dxf").write_text(
            "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" + self.drawing +
            "0\nENDSEC\n0\nEOF\n")
        tool = f'shape = "{self.shape}"\ndiameter = {number(self.diameter)}\n'
        if self.shape == "bull":
            tool += f"corner_radius = {number(self.corner)}\n"
        if self.shape == "vee":
            tool += f"tip_angle = {self.angle}\n"
        if self.random.random() < 0.4 and self.kind in ("profile", "on", "islands"):
            self.words += f"max_depth = {number(self.depth / 2)}\n"
        (folder / "job.toml").write_text(
            f'units = "{"inch" if self.inch else "mm"}"\n[[tool]]\n{tool}[cutting]\nfeed = {number(800)}\n'
            f"[stock]\ntop = 0\nbottom = {number(-12)}\nx = [{number(-27)}, {number(27)}]\n"
            f"y = [{number(-27)}, {number(27)}]\n"
            f'[[operation]]\nboundary = "part.dxf#o"\ndepth = {number(self.depth)}\n{self.words}')

    def radius_at(self, height):
        """Of the tool, over its tip."""
        if height < 0:
            return -math.inf
        if self.shape == "vee":
            return min(self.diameter / 2, height * math.tan(math.radians(self.angle / 2)))
        flat = self.diameter / 2 - self.corner
        return flat + math.sqrt(max(0.0, self.corner ** 2 - max(0.0, self.corner - height) ** 2))


class Moves:
    """Feed moves of a program in mm: (line's index, from, to), straight ones alone, with the modal words tracked."""

    def __init__(self, lines, unit):
        self.unit, at, motion, self.feeds = unit, {"X": 0.0, "Y": 0.0, "Z": 1000.0}, 0, []
        for k, line in enumerate(lines):
            words = re.findall(r"([A-Z])\s*(-?[\d.]+)", re.sub(r"\(.*?\)", "", line))
            codes = [float(v) for a, v in words if a == "G"]
            if any(code in (28, 30, 53, 10, 92) for code in codes):
                continue
            motion = next((int(c) for c in codes if c in (0, 1, 2, 3, 80, 81, 83)), motion)
            new = dict(at, **{a: float(v) * unit for a, v in words if a in at})
            if new != at and motion == 1:
                self.feeds.append((k, tuple(at.values()), tuple(new.values())))
            at = new


def candidates(job, moves, low):
    """Indices of feeds whose end lies on the path along a wall or a curve, with the wall's foot."""
    out = []
    for n in range(len(moves.feeds) - 1):
        k, a, v = moves.feeds[n]
        after, v2, b = moves.feeds[n + 1]
        if after != k + 1 or v2 != v or min(math.dist(a[:2], v[:2]), math.dist(v[:2], b[:2])) < 0.12:
            continue
        if max(abs(v[0]), abs(v[1])) > 24 or (job.kind != "v_carve" and max(a[2], v[2], b[2]) > low + 1e-4):
            continue
        distance, foot, segment = nearest(v, job.walls)
        wanted = 0.0 if job.kind in ("engrave", "on") else job.radius_at(-v[2])
        if v[2] < -0.3 * (job.kind == "v_carve") and abs(distance - wanted) < 0.025 and max(map(abs, foot)) < 25:
            out.append((n, foot, segment))
    return out


def moved(job, lines, moves, place, inward, size):
    n, foot, ((ax, ay), (bx, by)) = place
    k, _, v = moves.feeds[n]
    _, _, b = moves.feeds[n + 1]
    if job.kind in ("engrave", "on"):
        long = math.hypot(bx - ax, by - ay)
        way = ((by - ay) / long, (ax - bx) / long)
    else:
        long = math.hypot(foot[0] - v[0], foot[1] - v[1])
        way = ((foot[0] - v[0]) / long, (foot[1] - v[1]) / long)
    size = size if inward else -size
    new = (v[0] + size * way[0], v[1] + size * way[1])

    def at(line, x, y):
        head, *comment = line.partition("(")
        head = re.sub(r"\s*[XY]\s*-?[\d.]+", "", head)
        return f"{head} X{x / job.unit:.6f} Y{y / job.unit:.6f} " + "".join(comment)
    out = list(lines)
    out[k], out[k + 1] = at(lines[k], *new), at(lines[k + 1], b[0], b[1])
    return out, (*new, v[2]), k + 1


def true_size(job, lines, new, low, inward):
    """mm: by brute force; on curves the distance of the path from them. Then, for stock at a wall, the lines of the moves
    that come nearest, as another pass may: verify names one of them."""
    on = job.kind in ("engrave", "on")
    if on or inward:
        beside = [tuple(u + (w - u) * k / 50 for u, w in zip(a, b)) for _, a, b in Moves(lines, job.unit).feeds
                  if math.dist(a, new) < 1e-3 or math.dist(b, new) < 1e-3 for k in range(51)]
        return max(nearest(p, job.walls)[0] if on else job.radius_at(-p[2]) - nearest(p, job.walls)[0] for p in beside), None
    height = low + min(job.corner + 0.02, -low)
    feeds = Moves(lines, job.unit).feeds
    beside = [(a[:2], b[:2]) for _, a, b in feeds if math.dist(a, new) < 1e-3 or math.dist(b, new) < 1e-3]
    box = [[side(p[axis] for s in beside for p in s) for axis in (0, 1)] for side in (min, max)]
    reach = job.diameter + 1
    segments = [(a, b, k + 1) for k, a, b in pieces(feeds) if max(a[2], b[2]) <= height + 1e-6 and all(
        min(a[axis], b[axis]) < box[1][axis] + reach and max(a[axis], b[axis]) > box[0][axis] - reach for axis in (0, 1))]
    worst, lines_nearest = 0.0, set()
    for (ax, ay), (bx, by) in job.walls:
        steps = max(1, int(math.hypot(bx - ax, by - ay) / 0.05))
        for k in range(steps + 1):
            p = (ax + (bx - ax) * k / steps, ay + (by - ay) * k / steps)
            if max(map(abs, p)) > 26 or nearest(p, beside)[0] > job.diameter / 2 + 0.3 or not fits(job, p, (ax, ay), (bx, by)):
                continue
            found = sorted((away(p, (a[:2], b[:2]))[0] - job.radius_at(height - (a[2] + b[2]) / 2), number)
                           for a, b, number in segments)
            worst = max(worst, found[0][0])
            lines_nearest |= {number for thickness, number in found if found[0][0] > TOLERANCE and
                              thickness < found[0][0] + 0.002}
    return worst, lines_nearest


def pieces(feeds):
    """Level ones as they are, others in pieces that hardly rise."""
    for k, a, b in feeds:
        count = max(1, math.ceil(abs(b[2] - a[2]) / 0.01))
        for n in range(count):
            yield (k, *(tuple(u + (v - u) * (n + more) / count for u, v in zip(a, b)) for more in (0, 1)))


def fits(job, p, a, b):
    """Whether the tool has room beside a place of the wall, on the side that is cut."""
    long = math.dist(a, b)
    reach = job.diameter / 2 + 0.02
    for s in (reach / long, -reach / long):
        q = (p[0] + s * (b[1] - a[1]), p[1] - s * (b[0] - a[0]))
        enclosed = sum((ay > q[1]) != (by > q[1]) and q[0] < ax + (q[1] - ay) * (bx - ax) / (by - ay)
                       for (ax, ay), (bx, by) in job.outline) % 2 == 1
        if enclosed == (job.side == "inside") and nearest(q, job.walls)[0] > reach - 1e-3:
            return True
    return False


def planted(job, folder, lines):
    moves = Moves(lines, job.unit)
    low = min((min(a[2], b[2]) for _, a, b in moves.feeds), default=0)
    places = candidates(job, moves, low)
    if len(places) < 3:
        return "", 0
    tried = 0
    for size in (0.05, 0.1, 0.17):
        for inward in (True, False):
            if job.kind == "v_carve" and not inward:
                continue
            place = job.random.choice(places)
            text, new, line = moved(job, lines, moves, place, inward, size)
            true, blamed = true_size(job, text, new, low, inward)
            name = f"{'in' if inward else 'out'}-{size}.ngc"
            (folder / name).write_text("\n".join(text) + "\n")
            status, figures, said = verify(folder, name)
            side = "gouge" if inward or job.kind in ("engrave", "on") else "stock"
            found = figures.get(f"wall_{side}_max_mm", 0)
            what = f"{name}: line {line}, {true:.4f} mm of wall, found {found:.4f}, status {status}: {said[-300:]}"
            if true < TOLERANCE + 0.004:
                continue
            tried += 1
            if status != 1 or abs(found - true) > 0.006:
                return what, tried
            said_lines = [re.match(r"N(\d+)|", text[number - 1]).group(1) or number
                          for number in (blamed if blamed is not None else (line, line + 1))]
            if not any(re.search(rf"line {number}\b", words) for words in figures["broken"] for number in said_lines):
                return f"another line: {figures['broken']}; {what}", tried
    return "", tried


def main():
    faults = tried = 0
    for seed in range(FIRST, FIRST + CASES):
        folder = pathlib.Path(tempfile.mkdtemp(prefix=f"walls-{seed}-"))
        job = Job(seed)
        job.write(folder)
        done = run(folder, "plan", "--estimate-times", "job.toml", "-o", "p.ngc", "--post", job.post)
        found, count = "", 0
        if done.returncode:
            found = "" if done.returncode == 2 and re.search("no room|fits nowhere", done.stderr) else done.stderr[-400:]
        else:
            status, _, said = verify(folder, "p.ngc")
            found = f"sound: {said[-400:]}" if status else ""
            if not found:
                found, count = planted(job, folder, (folder / "p.ngc").read_text().splitlines())
        tried += count
        print(f"seed {seed}: {job.kind}, {job.shape}, {'inch' if job.inch else 'mm'}, {job.post}: "
              f"{found or f'right, {count} faults'}", flush=True)
        if found:
            faults += 1
            print(f"  kept in {folder}")
        else:
            shutil.rmtree(folder)
    print(f"{CASES} jobs, {tried} faults planted, {faults} jobs with a wrong verdict")
    return 1 if faults or tried < 2 * CASES else 0


if __name__ == "__main__":
    sys.exit(main())
