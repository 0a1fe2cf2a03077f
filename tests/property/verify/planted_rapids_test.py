#!/usr/bin/env python3
"""Rapid moves of each tool through stock with known cuts: level ones, plunges and slopes, into blocks and thin walls.

usage: planted_rapids_test.py CUSP [CASES [FIRST_SEED]]; CUSP_PROPERTY_CASES and CUSP_PROPERTY_FIRST count too

Two slots, and a ramp across them, leave a wall of 0.03 to 1 mm. cusp verify says how deep a rapid move is in what is
left, in which line, and nothing where it is in no stock. The oracle samples the tool along the move and along the cuts.
"""
import math
import pathlib
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from rapid_walls_test import Wall, box  # noqa: E402
from verdicts_test import property_cases, property_seed, verify  # noqa: E402

CASES = property_cases(int(sys.argv[2]) if len(sys.argv) > 2 else 20)
FIRST = property_seed(sys.argv[3] if len(sys.argv) > 3 else 1)
NARROWER = 0.02  # mm: what a tool of this less radius meets has to be found
WITHIN = 0.02  # mm, of the depth
AT_EDGE, SLIVER = 0.008, 0.012  # mm, of walls: what is less than these from both cuts need not be found
STEPS = 400  # samples of a way


class Tool:
    def __init__(self, r, number, shape):
        self.number, self.shape, self.radius = number, shape, r.choice((0.5, 1.0, 1.5, 3.0))
        self.corner = {"ball": self.radius, "bull": self.radius / 4}.get(shape, 0.0)
        angle = {"vee": r.choice((30, 60, 90)), "drill": 118}.get(shape)
        self.rise = 1 / math.tan(math.radians(angle / 2)) if angle else 0.0
        self.key = (f'shape = "{shape}"\ndiameter = {2 * self.radius}' + (f"\ntip_angle = {angle}" if angle else "") +
                    (f"\ncorner_radius = {self.corner}" if shape == "bull" else ""))

    def profile(self, away):
        beyond = np.maximum(0, away - (self.radius - self.corner))
        round_ = self.corner - np.sqrt(np.maximum(0, self.corner**2 - beyond**2))
        return self.rise * away if self.rise else round_


def lowest(tool, ways, places, narrower=0.0):
    """z over each place of the lowest that the tool passes on straight ways; infinite where it does not pass."""
    out = np.full(len(places), np.inf)
    for begin, end in ways:
        a, b = np.array(begin), np.array(end)
        tips = a + np.linspace(0, 1, STEPS)[:, None] * (b - a)
        away = np.hypot(places[:, None, 0] - tips[None, :, 0], places[:, None, 1] - tips[None, :, 1])
        z = np.where(away <= tool.radius - narrower, tips[None, :, 2] + tool.profile(away), np.inf)
        out = np.minimum(out, z.min(axis=1))
    return out


def places_under(wall, tool, way, random):
    """On all of the way, on the wall, and at its edges, where a ramp leaves the points of wedges."""
    a, b = np.array(way[0]), np.array(way[1])
    on = a[:2] + random.random((1500, 1)) * (b[:2] - a[:2])
    turn, out = random.random(1500) * 2 * math.pi, tool.radius * np.sqrt(random.random(1500))
    around = on + np.stack([out * np.cos(turn), out * np.sin(turn)], axis=1)
    along, edge = np.linspace(-16, 16, 1500), 1 - 2 * AT_EDGE / wall.thick
    walls = [np.array([wall.place(s, q * wall.thick / 2) for s in along]) for q in (-0.5, 0, 0.5, -edge, edge)]
    return np.concatenate([around, on[:100], *walls, a[None, :2], b[None, :2]])


def depth(wall, tool, cuts, way, random, narrower=0.0, wider=0.0):
    """mm, by a tool of a radius that is less, between cuts that are wider at each side."""
    places = places_under(wall, tool, way, random)
    deepest = 0.0
    for spread in (0.3, 0.05, 0.01, 0.002, 0):  # closer around the deepest
        stock = np.zeros(len(places))
        for cutter, cut in cuts:
            stock = np.minimum(stock, lowest(cutter, [cut], places, -wider))
        found = stock - lowest(tool, [way], places, narrower)
        k = int(np.argmax(found))
        deepest = max(deepest, float(found[k]))
        places = places[k] + spread * random.normal(size=(800, 2))
    return deepest


def ways(wall, kind, tool, deep, half):
    """Where the tool is fed to, and the end of its rapid move."""
    r = wall.random
    long, low = r.uniform(1, 10), -round(r.uniform(0.1, deep), 3)
    up = round(r.uniform(low, 2), 3)
    at = lambda along, across, z: (*(round(v, 4) for v in wall.place(along, across)), z)  # noqa: E731
    return {
        "level": (at(-long, -half, low), at(long, r.uniform(0, 1) * half, low)),
        "slope": (at(-long, -half, up), at(long, r.uniform(0, 1) * half, low)),
        "rise": (at(-long, -half, low), at(long, half, up)),
        "plunge": (at(long, r.uniform(-half, half), 5), at(long, 0, low)),
        "in the slot": (at(-long, -half, up), at(long, -half, low)),
        "beside": (at(-long, -half - tool.radius, 5), at(long, -half - 8, low)),
        "straight down": (at(0, q := r.uniform(-half, half), 3), at(0, q, low)),
    }[kind]


KINDS = ("level", "slope", "rise", "plunge", "in the slot", "beside", "straight down")


def case(seed, folder):
    wall = Wall(seed)
    r, random = wall.random, np.random.default_rng(seed)
    wall.thick = round(10 ** r.uniform(-1.5, 0), 4)
    kind, shape = KINDS[seed % len(KINDS)], ("flat", "ball", "vee", "drill", "bull")[seed // len(KINDS) % 5]
    mill, tool = Tool(r, 1, "flat"), Tool(r, 2, shape)
    deep, half = round(r.uniform(0.5, 3), 2), mill.radius + wall.thick / 2
    wall.job(folder, (mill.key, tool.key), ('a"\nstrategy = "pocket"\ndepth = 4',), box("a", wall, -9, 9))

    def corner(along, across, z):
        return (*(round(v, 4) for v in wall.place(along, across)), z)
    cuts = [(mill, (corner(-14, side * half, -deep), corner(14, side * half, -deep))) for side in (-1, 1)]
    if r.random() < 0.5:
        cuts.append((mill, (corner(-6, -half, 0.0), corner(6, half, -deep))))
    begin, end = ways(wall, kind, tool, deep, half)
    word = "X{} Y{} Z{}".format
    lines = ["G21 G90 G17 G94"]
    for number, moves in ((1, [cut for _, cut in cuts]), (2, [(begin, begin)])):
        lines += [f"T{number} M6", "M3 S9000", "G0 Z9"]
        for a, b in moves:
            lines += [f"G0 X{a[0]} Y{a[1]}", f"G1 Z{a[2]} F200", f"G1 {word(*b)} F600"] + ["G0 Z9"] * (number == 1)
    lines += [f"G0 {word(*end)}", "G0 Z9", "M5", "M2"]
    (folder / "p.ngc").write_text("\n".join(lines) + "\n")
    cuts.append((tool, ((*begin[:2], 9.0), begin)))
    least = depth(wall, tool, cuts, (begin, end), random, NARROWER, SLIVER)
    most = depth(wall, tool, cuts, (begin, end), random)
    _, figures, said = verify(folder, "p.ngc")
    found, line = figures.get("rapid_cut_max_mm", -1), len(lines) - 3
    text = f"{kind}, {shape}, {found} mm (sampled {least:.4f} to {most:.4f})"
    right = least - WITHIN <= found <= most + WITHIN and (found == 0 or figures["rapid_cut_line"] == line)
    return right, text + ("" if right else f": WRONG, {said[-200:]}")


def main():
    faults = 0
    for seed in range(FIRST, FIRST + CASES):
        with tempfile.TemporaryDirectory() as folder:
            right, text = case(seed, pathlib.Path(folder))
        print(f"seed {seed}: {text}", flush=True)
        faults += not right
    print(f"{CASES} rapid moves, {faults} wrong")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
