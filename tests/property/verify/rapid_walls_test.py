#!/usr/bin/env python3
"""Rapid moves against thin walls in stock of any size, from that of a matchbox to a sheet of 2.4 m.

usage: rapid_walls_test.py CUSP [CASES [FIRST_SEED]]; CUSP_PROPERTY_CASES and CUSP_PROPERTY_FIRST count too

Two pockets leave a wall of 0.03 to 0.5 mm. A drill whose hole begins at their floor comes over the wall or beside it:
cusp plan warns of the wall exactly where the tool's circle reaches it. In a program of two slots a rapid move crosses
the wall between them: cusp verify says how deep, and in which line. The oracle is the wall's distance.
"""
import math
import pathlib
import random
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from verdicts_test import entity, polyline, property_cases, property_seed, run, verify  # noqa: E402

CASES = property_cases(int(sys.argv[2]) if len(sys.argv) > 2 else 8)
FIRST = property_seed(sys.argv[3] if len(sys.argv) > 3 else 1)
SIZES = (50, 300, 1200, 2400)  # mm
CLEAR = 0.05  # mm: nearer to the edge of the tool's circle nothing is asked


class Wall:
    """Along a line through `at`: place(along, across) in the drawing."""

    def __init__(self, seed):
        r = self.random = random.Random(seed)
        self.size = SIZES[seed % len(SIZES)]
        self.thick = round(10 ** r.uniform(-1.5, -0.3), 4)
        self.turn = math.radians(r.choice((0, 90, 45, r.uniform(0, 180))))
        reach = self.size / 2 - 25
        self.at = r.uniform(-reach, reach), r.uniform(-reach, reach)

    def place(self, along, across):
        c, s = math.cos(self.turn), math.sin(self.turn)
        return self.at[0] + along * c - across * s, self.at[1] + along * s + across * c

    def job(self, folder, tools, operations, drawing):
        half = self.size / 2
        (folder / "part.dxf").write_text(
            "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" + drawing + "0\nENDSEC\n0\nEOF\n")
        (folder / "job.toml").write_text(
            'post = "linuxcnc"\n' + "".join(f"[[tool]]\n{tool}\n" for tool in tools) + "[cutting]\nfeed = 600\n[stock]\n"
            f"top = 0\nbottom = -12\nx = [{-half}, {half}]\ny = [{-half}, {half}]\n" +
            "".join(f'[[operation]]\nboundary = "part.dxf#{text}\n' for text in operations))


def box(layer, wall, low, high):
    return polyline(layer, [(*wall.place(*p), 0) for p in ((-9, low), (9, low), (9, high), (-9, high))])


def planned(wall, folder):
    drill = wall.random.choice((1, 2, 3, 5))
    across = wall.random.uniform(0, drill / 2 + wall.thick / 2 + 0.2)
    hole = wall.place(wall.random.uniform(-4, 4), across)
    wall.job(folder, ('shape = "flat"\ndiameter = 4', f'shape = "drill"\ndiameter = {drill}'),
             ('a"\nstrategy = "pocket"\ndepth = 4', 'b"\nstrategy = "pocket"\ndepth = 4',
              'h"\nstrategy = "drill"\ntop = -4\ndepth = 3\ntool = 2'),
             box("a", wall, wall.thick / 2, wall.thick / 2 + 11) + box("b", wall, -wall.thick / 2 - 11, -wall.thick / 2) +
             entity("CIRCLE", "h", (10, hole[0]), (20, hole[1]), (40, drill / 2)))
    done = run(folder, "plan", "--estimate-times", "job.toml", "-o", "p.ngc")
    refused = "of stock that stands by then" in done.stderr and drill < 3  # it would begin 3 mm below the wall's top
    if done.returncode and not refused:
        return done.stderr[-300:]
    into = drill / 2 - max(0.0, across - wall.thick / 2)
    warned = refused or "begins below stock" in done.stdout + done.stderr
    if abs(into) > CLEAR and warned != (into > 0):
        return f"plan: a drill of {drill} mm, {into:.3f} mm into the wall: {'' if warned else 'not '}warned"
    return ""


def grazed(wall, folder):
    """A drill of the size of the mills reaches a little into a wall of 0.02 to 0.3 mm."""
    r = wall.random
    wall.thick = round(10 ** r.uniform(-1.7, -0.52), 4)
    drill, into = r.choice((3, 4, 5)), r.uniform(0.06, 0.5)
    hole = wall.place(r.uniform(-3, 3), drill / 2 + wall.thick / 2 - into)
    wall.job(folder, ('shape = "flat"\ndiameter = 6', f'shape = "drill"\ndiameter = {drill}'),
             ('a"\nstrategy = "pocket"\ndepth = 4', 'b"\nstrategy = "pocket"\ndepth = 4',
              'h"\nstrategy = "drill"\ntop = -4\ndepth = 3\ntool = 2'),
             box("a", wall, wall.thick / 2, wall.thick / 2 + 15) + box("b", wall, -wall.thick / 2 - 15, -wall.thick / 2) +
             entity("CIRCLE", "h", (10, hole[0]), (20, hole[1]), (40, drill / 2)))
    done = run(folder, "plan", "--estimate-times", "job.toml", "-o", "p.ngc")
    if "of stock that stands by then" in done.stderr or "begins below stock" in done.stdout + done.stderr:
        return ""
    return f"plan: a drill of {drill} mm, {into:.3f} mm into a wall of {wall.thick} mm: not warned {done.stderr[-200:]}"


def crossed(wall, folder):
    wide, depth = wall.random.choice((1, 3, 6)), round(wall.random.uniform(0.5, 3), 2)
    long, half = wall.random.uniform(0, 12), (wide + wall.thick) / 2
    wall.job(folder, (f'shape = "flat"\ndiameter = {wide}',), (f'a"\nstrategy = "pocket"\ndepth = {depth}',),
             box("a", wall, -9, 9))

    def word(along, across):
        return "X{:.5f} Y{:.5f}".format(*wall.place(along, across))
    high = -round(wall.random.uniform(0.2, depth), 2)
    lines = [f"(tool 1 flat diameter {wide})", "G21 G90 G17 G94", "T1 M6", "M3 S9000", "G0 Z5"]
    for across in (-half, half):
        lines += [f"G0 {word(0, across)}", f"G1 Z{-depth} F200", f"G1 {word(long, across)} F600", "G0 Z5"]
    lines += [f"G0 Z{high}", f"G0 {word(long, -half)}", "G0 Z5", "M5", "M2"]
    (folder / "p.ngc").write_text("\n".join(lines) + "\n")
    _, figures, said = verify(folder, "p.ngc")
    found, line = figures.get("rapid_cut_max_mm", 0), len(lines) - 3
    if abs(found + high) > 0.01 or figures.get("rapid_cut_line") != line:
        return f"verify: a tool of {wide} mm, {-high} mm deep in line {line}, found {found}: {said[-200:]}"
    return ""


def main():
    faults = 0
    for seed in range(FIRST, FIRST + CASES):
        wall = Wall(seed)
        with tempfile.TemporaryDirectory() as folder:
            found = planned(wall, pathlib.Path(folder)) or crossed(wall, pathlib.Path(folder)) or grazed(
                wall, pathlib.Path(folder))
        print(f"seed {seed}: a wall of {wall.thick} mm in stock of {wall.size} mm: {found or 'right'}", flush=True)
        faults += bool(found)
    print(f"{CASES} walls, {faults} with a fault")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
