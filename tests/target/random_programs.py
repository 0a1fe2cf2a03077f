#!/usr/bin/env python3
"""Runs random programs on the image under QEMU and in the host simulator, and compares the edges.

usage: random_programs.py [--seed N] [--programs N] [--keep FOLDER] [--pins PLUGIN] [--cusp CUSP]
                          [--image IMAGE]

Lines, arcs in all planes, helices, NURBS, dense lines, drilling, dwells, pauses, offsets, both units,
with random settings and scripts of holds and overrides; golden.py compares. A program that differs
is kept in FOLDER. CUSP_TARGET_PROGRAMS=N asks for another number of programs.
Exit status: 0 all are equal, 1 one is not, 2 something could not run.
"""
import argparse
import math
import os
import pathlib
import random
import sys
import tempfile

import golden
from qemu import RunFailed

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from property_cases import property_cases  # noqa: E402

PLANES = {"G17": (0, 1, 2), "G18": (2, 0, 1), "G19": (1, 2, 0)}
AXES, OFFSETS = "XYZ", "IJK"
FARTHEST = 12.0  # mm from zero
LONGEST_SCRIPT = 4000  # servo ticks


class Program:
    """Lines of a program whose position is known, so that arcs close."""

    def __init__(self, chance, rotary=False):
        self.chance = chance
        self.rotary = rotary
        self.turned = 0.0
        self.lines = []
        self.at = [0.0, 0.0, 0.0]  # in the program's units
        self.absolute = True
        self.plane = "G17"
        self.inches = False

    def add(self, *words):
        self.lines.append(" ".join(words))

    def length(self, millimetres):
        return millimetres / 25.4 if self.inches else millimetres

    def number(self, value):
        return f"{value:.{5 if self.inches else 4}f}"

    def feed(self, least=300, most=6000):
        return f"F{self.length(self.chance.uniform(least, most)):.1f}"

    def target(self, values):
        """Words that lead to {axis: place}; the place is rounded as the words are."""
        words = []
        for axis, value in values.items():
            shown = self.number(value if self.absolute else value - self.at[axis])
            words.append(AXES[axis] + shown)
            self.at[axis] = float(shown) if self.absolute else self.at[axis] + float(shown)
        return words

    def turn(self):
        """A word of A, mostly, where there is that axis: a little or a lot."""
        if not self.rotary or self.chance.random() < 0.3:
            return []
        goal = self.turned + self.chance.gauss(0, 1) * 10 ** self.chance.uniform(-2, 2)
        shown = f"{goal if self.absolute else goal - self.turned:.3f}"
        self.turned = float(shown) if self.absolute else self.turned + float(shown)
        return ["A" + shown]

    def somewhere(self, reach=FARTHEST):
        axes = self.chance.sample(range(3), self.chance.randint(1, 3))
        return {axis: self.length(self.chance.uniform(-reach, reach)) for axis in axes}

    def rapid(self):
        self.add("G0", *self.target(self.somewhere()), *self.turn())

    def line(self):
        self.add("G1", *self.target(self.somewhere()), *self.turn(), self.feed())

    def tiny_lines(self):
        self.add("G1", self.feed())
        for _ in range(self.chance.randint(3, 30)):
            near = {axis: self.at[axis] + self.length(self.chance.gauss(0, 0.01)) for axis in (0, 1)}
            self.add(*self.target(near), *self.turn())

    def dense_lines(self):
        step = self.chance.choice((0.03, 0.1, 0.3))
        waves = [(self.chance.uniform(0.1, 2.0), self.chance.uniform(0.2, 3.0)) for _ in range(2)]
        direction = self.chance.choice((-1, 1))
        start = list(self.at)
        self.add("G1", self.feed(1000, 9000))
        for k in range(self.chance.randint(20, 150)):
            along = step * (k + 1)
            across = sum(size * math.sin(rate * along) for size, rate in waves)
            place = {0: start[0] + self.length(direction * along), 1: start[1] + self.length(across)}
            if self.chance.random() < 0.2:
                place[2] = start[2] + self.length(0.3 * math.cos(along))
            self.add(*self.target(place), *(self.turn() if k % 7 == 0 else []))

    def arc(self):
        first, second, third = PLANES[self.plane]
        radius = self.length(self.chance.uniform(0.3, 6.0))
        begin = self.chance.uniform(0, 2 * math.pi)
        turn = self.chance.choice((-1, 1))
        sweep = self.chance.choice((self.chance.uniform(0.2, 6.0), 2 * math.pi))
        centre = (-radius * math.cos(begin), -radius * math.sin(begin))
        end = begin + turn * sweep
        goal = {first: self.at[first] + centre[0] + radius * math.cos(end),
                second: self.at[second] + centre[1] + radius * math.sin(end)}
        offsets = [OFFSETS[first] + self.number(centre[0]), OFFSETS[second] + self.number(centre[1])]
        turns = []
        if self.chance.random() < 0.4:
            goal[third] = self.at[third] + self.length(self.chance.uniform(-1, 1))
            turns = [f"P{self.chance.randint(1, 3)}"] if self.chance.random() < 0.5 else []
        full = sweep == 2 * math.pi
        if full:  # where it began, to the digit
            goal.update({first: self.at[first], second: self.at[second]})
        words = self.target(goal)
        by_radius = not full and 0.5 < sweep < 2.8 and self.chance.random() < 0.4
        self.add("G3" if turn > 0 else "G2", *words, *self.turn(),
                 *([f"R{self.number(radius * 1.0005)}"] if by_radius else offsets), *turns, self.feed())

    def points(self, count):
        for _ in range(count):
            yield {0: self.at[0] + self.length(self.chance.uniform(-3, 3)),
                   1: self.at[1] + self.length(self.chance.uniform(-3, 3))}

    def uniform_nurbs(self):
        order = self.chance.randint(2, 5)
        self.add(self.feed())
        for k, place in enumerate(self.points(order + self.chance.randint(0, 5))):
            weight = f"P{self.chance.uniform(0.5, 2):.2f}" if k or self.chance.random() < 0.5 else "P1"
            self.add(*(["G5.2"] if k == 0 else []), *self.target(place), weight,
                     *([f"L{order}"] if k == 0 else []))
        self.add("G5.3")

    def knotted_nurbs(self):
        order = self.chance.randint(2, 5)
        count = order + self.chance.randint(0, 4)
        knots = [0.0] * order
        for _ in range(count - order):
            knots.append(round(knots[-1] + self.chance.uniform(0.2, 2), 3))
        knots += [round(knots[-1] + 1, 3)] * order
        places = [{0: self.at[0], 1: self.at[1]}, *self.points(count - 1)]
        self.add(self.feed())
        for k, place in enumerate(places):
            self.add(*([f"G6.2 P{order}"] if k == 0 else []), *self.target(place),
                     f"R{self.chance.uniform(0.5, 2):.2f}", f"K{knots[k]}")
        for knot in knots[count:]:
            self.add(f"K{knot}")

    def drill(self):
        if self.plane != "G17" or not self.absolute:
            return
        top, bottom = self.length(2.0), self.length(-1.0)
        hole = self.target({0: self.length(self.chance.uniform(-5, 5)),
                            1: self.length(self.chance.uniform(-5, 5))})
        peck = f"Q{self.number(self.length(0.7))}"
        cycle = self.chance.choice(("G81", "G82 P0.01", "G83 " + peck, "G73 " + peck, "G85", "G89 P0.01"))
        self.add("G0", *self.target({2: self.length(4.0)}))
        self.add("G98", cycle, *hole, f"Z{self.number(bottom)}", f"R{self.number(top)}", self.feed())
        self.add("G80")

    def inverse_time(self):
        self.add("G93")
        self.add("G1", *self.target(self.somewhere(4.0)), *self.turn(), f"F{self.chance.uniform(20, 200):.1f}")
        self.add("G94", self.feed())

    def offsets(self):
        self.add(self.chance.choice(("G10 L20 P1", "G92")), "X0 Y0 Z0")
        self.at = [0.0, 0.0, 0.0]

    def mode(self):
        kind = self.chance.randrange(5)
        if kind == 0:
            self.add(self.chance.choice(("G61", "G64", f"G64 P{self.length(0.02):.4f}",
                                         f"G64 P{self.length(0.2):.4f}")))
        elif kind == 1:
            self.plane = self.chance.choice(list(PLANES))
            self.add(self.plane)
        elif kind == 2:
            self.absolute = not self.absolute
            self.add("G90" if self.absolute else "G91")
        elif kind == 3:
            self.inches = not self.inches
            scale = 1 / 25.4 if self.inches else 25.4
            self.at = [place * scale for place in self.at]
            self.add("G20" if self.inches else "G21")
        else:
            self.add(self.chance.choice(("M3 S1000", "M4 S500", "M5", "M8", "M9", "G4 P0.03", "M0",
                                         "M1", "(a comment)", "", "G1", "F500", "G4 P0")))

    def fill(self, parts):
        kinds = (self.rapid, self.line, self.line, self.tiny_lines, self.dense_lines, self.arc,
                 self.arc, self.uniform_nurbs, self.knotted_nurbs, self.drill, self.inverse_time,
                 self.offsets, self.mode, self.mode, self.mode)
        for _ in range(parts):
            self.chance.choice(kinds)()


def random_program(chance, rotary=False):
    program = Program(chance, rotary)
    program.add(program.feed())
    program.fill(chance.randint(2, 14))
    ending = chance.choice(("M2", "M30", "", "", "G1 X1 Y", "G999", "G38.3 Z-2 F200", "G38.2 Z-1 F300"))
    end = chance.choice(("\n", "\n", "\r\n"))
    return end.join([*program.lines, ending]) + chance.choice(("", end))


def random_settings(chance):
    values = {"$0": chance.randint(1, 3), "$29": chance.randint(1, 9), "$11": 0.01}
    for axis in range(3):
        values[f"$10{axis}"] = f"{chance.choice((80, 157.48, 320, chance.uniform(50, 500))):.3f}"
        values[f"$11{axis}"] = f"{chance.uniform(1000, 20000):.3f}"
        acceleration = chance.uniform(100, 5000)
        values[f"$12{axis}"] = f"{acceleration:.3f}"
        values[f"$80{axis}"] = f"{acceleration * chance.uniform(6, 100):.3f}"
    return "".join(f"{name}={value}\n" for name, value in values.items())


def rotary_settings(chance):
    """A on the fourth motor."""
    acceleration = chance.uniform(100, 3000)
    return (f"$793=4\n$103={chance.uniform(5, 200):.3f}\n$113={chance.uniform(600, 20000):.3f}\n"
            f"$123={acceleration:.3f}\n$803={acceleration * chance.uniform(6, 100):.3f}\n")


def random_script(chance):
    """A hold is followed by a cycle start, a door by two: the second after it has come to rest."""
    overrides = [*range(0x90, 0x98), *range(0x99, 0x9F), 0xA0, 0xA1, ord("?"), 0x85]
    script = []
    for _ in range(chance.randint(1, 25)):
        tick = chance.randint(0, LONGEST_SCRIPT)
        kind = chance.random()
        if kind < 0.25:
            script += [(tick, ord("!")), (tick + chance.randint(0, 600), ord("~"))]
        elif kind < 0.3:
            script += [(tick, 0x84), (tick + chance.randint(1, 300), ord("~")), (tick + 3000, ord("~"))]
        else:
            script.append((tick, chance.choice(overrides)))
    if chance.random() < 0.05:
        script.append((chance.randint(0, LONGEST_SCRIPT), 0x18))
    return "".join(f"{tick} {byte}\n" for tick, byte in sorted(script))


def run_one(options, seed):
    """True if the program of this seed gives the same edges."""
    chance = random.Random(seed)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        options.program = folder / f"random_{seed}.ngc"
        options.program.write_bytes(random_program(chance).encode())
        options.settings = folder / f"random_{seed}.settings"
        options.settings.write_text(random_settings(chance))
        options.as_it_is = seed % 2 == 0
        options.twice = seed % 6 == 0
        options.script = folder / f"random_{seed}.script" if chance.random() < 0.7 else None
        if options.script:
            options.script.write_text(random_script(chance))
        try:
            status = golden.compare(options, folder)
        except RunFailed as error:
            print(f"random_{seed}.ngc: {error}")
            status = 1
        if status and options.keep:
            pathlib.Path(options.keep).mkdir(parents=True, exist_ok=True)
            for file in folder.glob(f"random_{seed}.*"):
                (pathlib.Path(options.keep) / file.name).write_bytes(file.read_bytes())
    return status == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cusp", default=golden.BUILD / "release/bin/cusp")
    parser.add_argument("--image", default=golden.BUILD / "cortex-m4f/bin/mill3_f405_qemu.elf")
    parser.add_argument("--pins", metavar="PLUGIN")
    parser.add_argument("--seed", type=int, default=1, help="of the first program")
    parser.add_argument("--programs", type=int,
                        default=int(os.environ.get("CUSP_TARGET_PROGRAMS", property_cases(12))))
    parser.add_argument("--keep", help="folder for programs that differ")
    parser.add_argument("--seconds", type=int, default=60)
    options = parser.parse_args()
    options.may_stand_still = True
    try:
        wrong = [seed for seed in range(options.seed, options.seed + options.programs)
                 if not run_one(options, seed)]
    except OSError as error:
        print(f"random_programs: {error}", file=sys.stderr)
        return 2
    print(f"{options.programs} programs from seed {options.seed} on; different: {wrong or 'none'}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
