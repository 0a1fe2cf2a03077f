#!/usr/bin/env python3
"""Verdicts of cusp verify on random 2.5-D programs: sound ones hold, by every post, in mm and inch, in one set-up and two;
those with one planted fault are broken, with the size of the fault, and its line where a move makes it.

usage: verdicts_test.py CUSP [CASES [FIRST_SEED]]

CUSP_PROPERTY_CASES and CUSP_PROPERTY_FIRST count too. Jobs and programs of cases that fail are kept, and named.
"""
import json
import math
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from property_cases import property_cases, property_seed  # noqa: E402

CUSP = pathlib.Path(sys.argv[1]).resolve()
CASES = property_cases(int(sys.argv[2]) if len(sys.argv) > 2 else 10)
FIRST = property_seed(sys.argv[3] if len(sys.argv) > 3 else 7000)
LISTED = subprocess.run([str(CUSP), "plan", "--list-posts"], capture_output=True, text=True, check=True).stdout
POSTS = re.findall(r"^(\w+):", LISTED, re.M)
INCH = 25.4


def entity(kind, layer, *pairs):
    return f"0\n{kind}\n8\n{layer}\n" + "".join(f"{code}\n{value}\n" for code, value in pairs)


def polyline(layer, points):
    return entity("LWPOLYLINE", layer, (90, len(points)), (70, 1), *(
        pair for x, y, bulge in points for pair in ((10, round(x, 6)), (20, round(y, 6)), (42, round(bulge, 9)))))


def rounded(layer, x, y, w, h, r):
    b = math.tan(math.pi / 8)
    return polyline(layer, [(x + r, y, 0), (x + w - r, y, b), (x + w, y + r, 0), (x + w, y + h - r, b),
                            (x + w - r, y + h, 0), (x + r, y + h, b), (x, y + h - r, 0), (x, y + r, b)])


class RandomJob:
    """A part of some 30 mm: its outline or opening, a pocket or holes inside."""

    def __init__(self, seed):
        r = self.random = random.Random(seed)
        self.inch = r.random() < 0.4
        self.unit = INCH if self.inch else 1.0
        self.diameter = r.choice((3.0, 4.0, 6.0))
        self.depth = round(r.uniform(1.5, 6.0), 2)
        self.side = r.choice(("outside", "outside", "inside"))
        self.two_setups = r.random() < 0.25
        self.shape = r.choice(("disc", "rounded", "convex", "concave"))
        self.entities = {"disc": self.disc, "rounded": self.rounded, "convex": self.polygon,
                         "concave": self.polygon}[self.shape]()

    def length(self, mm):
        return f"{mm / self.unit:.6f}"

    def disc(self):
        self.radius = self.inner = self.random.uniform(8, 16)
        return entity("CIRCLE", "o", (10, 0), (20, 0), (40, round(self.radius, 5)))

    def rounded(self):
        w, h = self.random.uniform(16, 30), self.random.uniform(16, 30)
        r = round(self.random.uniform(3.1, 7), 3)
        self.inner = min(w, h) / 2
        return rounded("o", -w / 2, -h / 2, w, h, r)

    def polygon(self):
        count = self.random.randint(4, 8)
        radii = [16.0] * count if self.shape == "convex" else [self.random.uniform(9, 16) for _ in range(count)]
        turn = self.random.uniform(0, 2 * math.pi)
        self.inner = 16 * math.cos(math.pi / count) if self.shape == "convex" else 0
        return polyline("o", [(radius * math.cos(turn + 2 * math.pi * k / count),
                               radius * math.sin(turn + 2 * math.pi * k / count), 0)
                              for k, radius in enumerate(radii)])

    def write(self, folder):
        r = self.random
        # units of the drawing are said: millimetres
        holes = "".join(entity("CIRCLE", "h", (10, x), (20, y), (40, 1.25)) for x, y in ((24, 24), (-24, 24), (24, -24)))
        (folder / "part.dxf").write_text(
            "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" + self.entities + holes +
            entity("CIRCLE", "q", (10, 0), (20, 0), (40, round(max(1, self.inner - 3), 4))) +
            polyline("p", [(-24, -30, 0), (12, -30, 0), (12, -21, 0), (-24, -21, 0)]) + "0\nENDSEC\n0\nEOF\n")
        number = self.length
        profile = f'strategy = "profile"\nboundary = "part.dxf#o"\nside = "{self.side}"\ndepth = {number(self.depth)}\n'
        self.tabs = r.random() < 0.3
        if self.tabs:
            profile += f"tabs = {{ count = 3, width = {number(4)}, height = {number(self.depth / 3)} }}\n"
        if r.random() < 0.5:
            profile += f"max_depth = {number(self.depth / 2)}\n"
        if r.random() < 0.5:
            profile += f"lead_in = {number(r.choice((0, 1.5, 4)))}\n"
        profile += r.choice(("", 'entry = "plunge"\n', 'entry = "ramp"\n', 'output = "arcs"\n', 'direction_of_cut = "conventional"\n'))
        back = 'setup = "back"\n' if self.two_setups else ""
        profile = (back if r.random() < 0.6 else "") + profile
        tool = 'strategy = "{}"\nboundary = "part.dxf#{}"\ntool = {}\ndepth = {}\n'
        operations = [profile, tool.format("pocket", "p", 1, number(2.5)), tool.format("drill", "h", 2, number(6))]
        self.chamfer = 0.0
        if r.random() < 0.6 and self.side == "outside":
            self.chamfer = round(r.uniform(0.3, 0.8), 2)
            chamfer = 'strategy = "chamfer"\nboundary = "part.dxf#{}"\ntool = 3\nwidth = {}\n'
            operations.append(chamfer.format("o", number(self.chamfer)))
            if self.inner and r.random() < 0.7:  # another edge, 3 mm within the outline's
                operations.append(chamfer.format("q", number(0.25)))
        r.shuffle(operations)
        self.face = 0.4 if not self.two_setups and r.random() < 0.5 else 0.0
        if self.face:
            operations.insert(0, f'strategy = "face"\ndepth = {number(self.face)}\ntool = 4\n')
        setups = f'[[setup]]\nname = "front"\n[[setup]]\nname = "back"\nflip = "{r.choice("xy")}"\n' if self.two_setups else ""
        if self.two_setups:
            operations.append(back + tool.format("drill", "h", 2, number(3)))
            if r.random() < 0.5:
                operations.append(back + tool.format("pocket", "p", 1, number(2)))
        (folder / "job.toml").write_text(
            f'units = "{"inch" if self.inch else "mm"}"\n[[tool]]\nshape = "flat"\ndiameter = {number(self.diameter)}\n'
            f'[[tool]]\nshape = "drill"\ndiameter = {number(2.5)}\n'
            f'[[tool]]\nshape = "vee"\ndiameter = {number(6)}\ntip_angle = 90\n'
            f'[[tool]]\nshape = "flat"\ndiameter = {number(20)}\n[cutting]\nfeed = {number(800)}\n'
            f"[stock]\ntop = {number(self.face)}\nbottom = {number(-8)}\nx = [{number(-32)}, {number(32)}]\ny = [{number(-32)}, {number(32)}]\n"
            f"{setups}" + "".join(f"[[operation]]\n{text}" for text in operations))


def run(folder, *words):
    return subprocess.run([str(CUSP), *map(str, words)], cwd=folder, capture_output=True, text=True, errors="replace",
                          timeout=600, check=False)


def verify(folder, program):
    """Messages and figures; the exit status is that of the verdict."""
    done = run(folder, "verify", "job.toml", program, "--stats", "v.json")
    figures = json.loads((folder / "v.json").read_text()) if done.returncode < 2 else {}
    return done.returncode, figures, done.stdout + done.stderr


def sound(job, folder, seed):
    post = POSTS[seed % len(POSTS)]
    planned = run(folder, "plan", "--estimate-times", "job.toml", "-o", "p.ngc", "--post", post)
    if planned.returncode == 2 and any(
            text in planned.stderr + planned.stdout for text in ("no room", "has no G2 and G3", "has no {offset}")):
        return None
    if planned.returncode:
        return f"plan by {post}: {planned.stdout[-200:]}{planned.stderr[-400:]}"
    programs = sorted(folder.glob("p*.ngc"))
    for program in programs:
        status, _, said = verify(folder, program.name)
        if status:
            return f"a sound program by {post}, {program.name}: {said[-400:]}"
    return ""


WORD = re.compile(r"([XYZIJ])(-?[\d.]+)")


class Plant:
    """One fault in the program's lines; `size` in mm is at most what verify has to say."""

    def __init__(self, job, lines):
        self.job, self.lines, self.random = job, list(lines), job.random
        self.line = None  # of the fault, where a move makes it
        at, self.feeds = {"X": 0.0, "Y": 0.0, "Z": 9.0}, []
        for k, line in enumerate(self.lines):
            words = dict((a, float(b)) for a, b in WORD.findall(line.split("(")[0]))
            at.update({a: b for a, b in words.items() if a in at})
            if line.startswith(("G1 ", "X", "Y", "Z")) and at["Z"] * job.unit < -0.5 and words:
                self.feeds.append((k, dict(at)))

    def shifted(self, text, letter, by):
        return re.sub(letter + r"(-?[\d.]+)", lambda m: f"{letter}{float(m.group(1)) + by / self.job.unit:.5f}", text)

    def rapid(self):
        size = round(self.random.uniform(0.3, 3), 2)
        place = next(k for k, line in enumerate(self.lines) if line.startswith("G0 X"))
        number = self.job.length
        self.lines[place:place] = [f"G0 X{number(29)} Y0", f"G0 Z{number(-size)}", f"G0 Z{number(5)}"]
        self.line, self.name = place + 2, "rapid_cut_max_mm"
        return size + self.job.face

    def deeper(self):
        size = round(self.random.uniform(0.1, 1), 2)
        low = min(at["Z"] for _, at in self.feeds)
        k, at = next((k, at) for k, at in self.feeds if at["Z"] == low and "Z" in self.lines[k])
        self.lines[k] = self.shifted(self.lines[k], "Z", -size)
        self.line, self.name = k + 1, "gouge_max_mm"
        return size

    def offset(self, axis="X", sign=1, name="wall_gouge_max_mm"):
        size = round(self.random.uniform(0.1, 0.6), 2)
        place = next(k for k, line in enumerate(self.lines) if line.startswith("G0"))
        self.lines.insert(place, f"G10 L2 P1 {axis}{self.job.length(sign * size)}")
        self.name = name
        return size

    def height(self):
        return self.offset("Z", -1, "gouge_max_mm")

    def moved(self):
        """A point of the outline's last pass, moved into the part."""
        size = round(self.random.uniform(0.15, 0.8), 2)
        low = min((at["Z"] for _, at in self.feeds if abs(at["Z"] * self.job.unit + self.job.depth) < 1e-3), default=None)
        points = [(k, at) for k, at in self.feeds
                  if at["Z"] == low and re.fullmatch(r"G1( X\S+)?( Y\S+)?", self.lines[k])
                  and math.hypot(at["X"], at["Y"]) * self.job.unit < 20.5]
        if len(points) < 12:
            return 0
        k, at = points[len(points) // 2]
        radius = math.hypot(at["X"], at["Y"])
        inward = self.job.side == "outside"
        scale = 1 + (-size if inward else size) / self.job.unit / radius
        back = self.lines[k + 1]
        words = dict(WORD.findall(back))
        # the next point keeps its place: words that it left out are given
        self.lines[k + 1] = back + "".join(f" {a}{at[a]:.5f}" for a in "XY" if a not in words)
        self.lines[k] = f"G1 X{at['X'] * scale:.5f} Y{at['Y'] * scale:.5f}"
        self.line = k + 1
        self.name = "wall_gouge_max_mm" if self.job.shape == "disc" else None  # elsewhere not square to the wall
        return size

    def missing(self):
        """No pass of the pocket: from one lift to the next all feed moves lie in it."""
        blocks, block = [], []
        for k, at in self.feeds:
            if block and any(line.startswith("G0") for line in self.lines[block[-1][0]:k]):
                blocks.append(block)
                block = []
            block.append((k, at))
        blocks.append(block)
        unit = self.job.unit
        for block in reversed([block for block in blocks if all(
                -24.1 < at["X"] * unit < 12.1 and -30.1 < at["Y"] * unit < -20.9 for _, at in block)]):
            first, last, at = block[0][0], block[-1][0], block[-1][1]
            self.lines[first:last + 1] = [f"G0 X{at['X']} Y{at['Y']}"]
        self.name = "level_left_mm"
        return 2.5

    def section(self, tool):
        """Numbers of the lines by a tool."""
        numbers, here = [], False
        for k, line in enumerate(self.lines):
            change = re.match(r"T(\d+)", line)
            here = int(change.group(1)) == tool if change else here
            numbers += [k] if here else []
        return numbers

    def holes(self):
        lines = self.section(2)
        return [k for k in lines if self.lines[k].startswith("G1 Z-") and self.lines[k + 1].startswith("G0 Z")]

    def missing_hole(self):
        k = self.random.choice(self.holes())
        self.lines[k] = re.sub(r" Z\S+", "", self.lines[k])
        self.name = "level_left_mm"
        return 6

    def shallow_hole(self):
        size = round(self.random.uniform(0.1, 1), 2)
        k = self.random.choice(self.holes())
        self.lines[k] = self.shifted(self.lines[k], "Z", size)
        self.name = "level_left_mm"
        return size

    def moved_hole(self):
        size = round(self.random.uniform(0.1, 0.6), 2)
        k = self.random.choice(self.holes())
        k = next(n for n in range(k, 0, -1) if re.match(r"G0 .*[XY]", self.lines[n]))
        letter = "X" if "X" in self.lines[k] else "Y"
        self.lines[k] = self.shifted(self.lines[k], letter, size)
        self.name = "wall_gouge_max_mm"
        return size

    def low_chamfer(self, size=0.0):
        size = size or -round(self.random.uniform(0.05, 0.2), 2)
        lines = [k for k in self.section(3) if self.lines[k].startswith("G1 Z-")]
        for k in lines:
            self.lines[k] = self.shifted(self.lines[k], "Z", size)
        self.name = "wall_gouge_max_mm" if size < 0 else "wall_stock_max_mm"
        return abs(size) if lines else 0

    def high_chamfer(self):
        return self.low_chamfer(round(self.random.uniform(0.05, 0.25), 2))

    def missing_chamfer(self):
        for k in self.section(3):
            self.lines[k] = "" if self.lines[k].startswith("G1") else self.lines[k]
        self.name = "wall_stock_max_mm"
        return self.job.chamfer

    def tool(self, size=0.5):
        """In the spindle is a tool whose radius is `size` more than that of the plan."""
        path = self.job.folder / "job.toml"
        wide = self.job.length(self.job.diameter)
        more = self.job.length(self.job.diameter + 2 * size)
        path.write_text(path.read_text().replace(f"diameter = {wide}", f"diameter = {more}", 1))
        self.lines = [re.sub(r"\((tool 1 flat) diameter [\d.]+", rf"(\1 diameter {more}", line) for line in self.lines]
        self.name = "wall_gouge_max_mm" if size > 0 else None
        return size

    def thin_tool(self):
        return self.tool(-0.4)


def planted(job, folder):
    job.folder = folder
    original = (folder / "job.toml").read_text()
    done = run(folder, "plan", "--estimate-times", "job.toml", "-o", "p.ngc")
    if done.returncode:
        return f"plan: {done.stderr[-300:]}"
    lines = (folder / "p.ngc").read_text().splitlines()
    for kind in (Plant.rapid, Plant.deeper, Plant.offset, Plant.height, Plant.missing, Plant.tool, Plant.thin_tool, Plant.moved,
                 Plant.missing_hole, Plant.shallow_hole, Plant.moved_hole, Plant.low_chamfer, Plant.high_chamfer,
                 Plant.missing_chamfer):
        plant = Plant(job, lines)
        size = kind(plant)
        if size == 0:
            continue
        (folder / f"{kind.__name__}.ngc").write_text("\n".join(plant.lines) + "\n")
        status, figures, said = verify(folder, f"{kind.__name__}.ngc")
        (folder / "job.toml").write_text(original)
        if status == 2 and kind in (Plant.tool, Plant.thin_tool):
            continue
        if status != 1:
            return f"{kind.__name__} of {size} mm: status {status}, {said[-200:]}"
        found = figures.get(plant.name, 0)
        if plant.name and abs(found - size) > 0.02 + 0.1 * size:
            return f"{kind.__name__} of {size} mm: {plant.name} {found}; {figures['broken']}"
        if plant.line and not any(f"line {plant.line + more}" in text for text in figures["broken"] for more in (0, 1)):
            return f"{kind.__name__} in line {plant.line}: {figures['broken']}"
        if not all(" x " in text for text in figures["broken"]):
            return f"{kind.__name__}: no place in {figures['broken']}"
    return ""


def main():
    faults = 0
    for seed in range(FIRST, FIRST + CASES):
        folder = pathlib.Path(tempfile.mkdtemp(prefix=f"verdict-{seed}-"))
        job = RandomJob(seed)
        job.write(folder)
        found = sound(job, folder, seed)
        if found == "" and not job.two_setups:
            found = planted(job, folder)
        print(f"seed {seed}: {job.shape}, {job.side}, {'inch' if job.inch else 'mm'}, "
              f"{'two set-ups' if job.two_setups else 'one set-up'}: "
              f"{'refused' if found is None else found or 'right'}", flush=True)
        if found:
            faults += 1
            print(f"  kept in {folder}")
        else:
            shutil.rmtree(folder)
    print(f"{CASES} jobs, {faults} with a wrong verdict")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
