#!/usr/bin/env python3
"""Runs programs by LinuxCNC's interpreter, rs274, and by `cusp sim`, and compares ends, lengths and refusals.

usage: rs274.py CUSP [--seeds N] [--first SEED] [--folder DIR] [--keep DIR] [--plant]

Random programs (--seeds, one each) have lines, arcs by centre and radius in all planes, full circles, cycles
with all their words, both units, G90 G91 G90.1, G93, offsets (G10, G52, G92, G54 to G59.3, G43, G43.1), G28, G30,
G53, G4, M and T words, comments of any bytes, line numbers and `%`, numbers as people write them; now and then a
line that must be refused. --folder takes the *.ngc of a folder
and of those in it. Compared are the machine's end, the length of the way, and the first refused line: cusp
stops at one, as rs274 does. What differs on purpose (docs/gcode.md, LinuxCNC) the random programs leave out.
Debian: apt-get install --no-install-recommends linuxcnc-uspace.
--plant moves the end of what rs274 reads by 0.01 mm or inch, or lengthens its way by 4: all programs that are not refused must differ then,
and the exit status is 0 where they do.
Exit status: 0 all agree, 1 some differ, 2 something can't run, 77 rs274 is not installed.
"""
import argparse
import json
import math
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

AXES, CENTRES = "XYZ", "IJK"
PLANES = {"G17": (0, 1, 2), "G18": (2, 0, 1), "G19": (1, 2, 0)}
SKIPPED = 77
REFUSED = "refused by both"
NEAR = 0.002  # mm, beside what rs274 prints, four decimals of its unit
SHARE = 3e-4  # of the length: that of cusp is the one from set point to set point


class RandomProgram:
    """Lines of a program whose place is known well enough that arcs close and the machine stays within reach."""

    def __init__(self, seed):
        self.chance = random.Random(seed)
        self.at = [0.0, 0.0, 0.0]  # program coordinates, in the program's unit
        self.plane = "G17"
        self.inches = self.absolute_centres = self.incremental = False
        self.tool_offset = False
        self.number = 0
        self.lines = ["G21 G90 G17 G94 G91.1 G98 F600", "G0 X1 Y2 Z12", "M3 S1000"]
        self.at = [1.0, 2.0, 12.0]
        steps = (self.rapid, self.line, self.line, self.arc, self.arc, self.circle, self.cycle, self.cycle,
                 self.unit, self.distance, self.centres, self.select_plane, self.offset, self.home, self.machine_line,
                 self.comment, self.feed, self.inverse_time, self.auxiliary)
        for _ in range(self.chance.randint(4, 22)):
            self.chance.choice(steps)()
        if self.chance.random() < 0.15:
            self.add(self.chance.choice(self.REFUSED))
        self.lines.append(self.chance.choice(("M2", "M30")))
        if self.chance.random() < 0.15:
            self.lines = ["%", *self.lines, "%", "G0 X77"]  # which neither reads

    REFUSED = ("G1 X1 X2", "G80 X5", "G17 G2 X5 R0.1", "G0 G1 X1", "G81 X1 Z-1 R1 L0", "G83 X1 Z-1 R1", "G17 G2 X3",
               "G17 G18", "G1 X1 Q3", "G80 G82 X1 Z-1 R1", "G93 G1 X2", "G89 X1 Z-1 R1", "G73 X1 Z-1 R2", "G17 G2 R5",
               "M3 M4", "G90 G91", "G17 G2 X9 I-80 J0", "F-1", "G10 L20 P1 X0 R1", "G52", "G53 G2 X1 I1", "E1")

    def add(self, *words):
        words = [word for word in words if word]
        if self.chance.random() < 0.2:
            self.number += self.chance.randint(1, 10)
            words.insert(0, f"N{self.number}" + self.chance.choice(("", "", ".5")))
        if self.chance.random() < 0.1:
            words.insert(self.chance.randint(1, len(words)), self.chance.choice((
                "(of X9 or G0)", "(\xd8 6 \xb1 0.1 %, \x7f;G1 X9)", "()", "(90\xb0 ! ~ ? M30)")))
        if self.chance.random() < 0.05:
            words.append("; M30 \xb5 (X9")
        text = self.chance.choice((" ", " ", "")).join(words)
        self.lines.append(text.lower() if self.chance.random() < 0.1 else text)

    def length(self, mm):
        return mm / 25.4 if self.inches else mm

    def text(self, value):
        text = f"{value:.{5 if self.inches else 4}f}"
        way = self.chance.random()
        if way < 0.1:
            text = text.rstrip("0")
        elif way < 0.15 and value > 0:
            text = "+" + text
        elif way < 0.2:
            text = text.replace("0.", ".", 1) if abs(value) < 1 else "-00" + text[1:] if value < 0 else "0" + text
        elif way < 0.23:
            text = " " + text[:2] + " " + text[2:]
        return text

    def words(self, place):
        """Words that lead to {axis: program coordinate}."""
        words = []
        for axis, value in place.items():
            shown = self.text(value - self.at[axis] if self.incremental else value)
            words.append(AXES[axis] + shown)
            shown = float(shown.replace(" ", ""))
            self.at[axis] = self.at[axis] + shown if self.incremental else shown
        return words

    def somewhere(self):
        axes = self.chance.sample(range(3), self.chance.randint(1, 3))
        return {axis: self.length(self.chance.uniform(-20, 20)) for axis in axes}

    def rapid(self):
        self.add(self.chance.choice(("G0", "G00", "G0 G80", "G80 G0")), *self.words(self.somewhere()))

    def line(self):
        self.add(self.chance.choice(("G1", "G01", "G80 G1")), *self.words(self.somewhere()))

    def feed(self):
        self.add(f"F{self.length(self.chance.uniform(300, 3000)):.1f}")

    def inverse_time(self):
        """G93, F in each line that feeds."""
        lines = [f"G1 {' '.join(self.words(self.somewhere()))} F{self.chance.uniform(5, 60):.2f}"
                 for _ in range(self.chance.randint(1, 3))]
        self.add("G93", lines[0])
        for line in lines[1:]:
            self.add(line)
        self.add("G94", f"F{self.length(900):.1f}")

    def auxiliary(self):
        self.add(self.chance.choice(("M7", "M8", "M9", "M7 M8", "M4 S500", "S2000 M3", "M5", "G4 P0.1", "T1", "G40", "G97",
                                     "G80", "G64", "G61 M9", "M1", "M3 S100 G4 P0", "T1 S300 F500")))
        if "M5" in self.lines[-1].upper():
            self.add("M3 S900")  # G86 needs it

    def comment(self):
        self.add("(a comment with G1 X99)")

    def centre_words(self, centre, start):
        """The centre is given from the start."""
        first, second, _ = PLANES[self.plane]
        values = {first: centre[0], second: centre[1]}
        words = []
        for axis, value in values.items():
            if self.absolute_centres or abs(value) > 1e-9 or len(words) == 1:
                words.append(CENTRES[axis] + self.text(value + (start[axis] if self.absolute_centres else 0)))
        return words or [CENTRES[first] + self.text(0)]

    def arc(self):
        first, second, third = PLANES[self.plane]
        start = list(self.at)
        radius = self.length(self.chance.uniform(0.5, 15))
        begin, sweep = self.chance.uniform(0, 2 * math.pi), self.chance.uniform(0.2, 6.0)
        turn = self.chance.choice((-1, 1))
        centre = (-radius * math.cos(begin), -radius * math.sin(begin))
        end = begin + turn * sweep
        place = {first: start[first] + centre[0] + radius * math.cos(end),
                 second: start[second] + centre[1] + radius * math.sin(end)}
        if self.chance.random() < 0.4:
            place[third] = start[third] + self.length(self.chance.uniform(-3, 3))
        # Short of a half turn the centre of a radius is well known.
        by_radius = (0.5 < sweep < 2.8 or 3.5 < sweep < 5.8) and self.chance.random() < 0.4
        turns = f"P{self.chance.randint(1, 3)}" if self.chance.random() < 0.2 and not by_radius else ""
        words = self.words(place)
        how = [f"R{self.text(radius if sweep < math.pi else -radius)}"] if by_radius else \
            self.centre_words(centre, start)
        self.add("G3" if turn > 0 else "G2", *words, *how, turns)

    def circle(self):
        third = PLANES[self.plane][2]
        begin, radius = self.chance.uniform(0, 2 * math.pi), self.length(self.chance.uniform(0.5, 9))
        centre = (radius * math.cos(begin), radius * math.sin(begin))
        how = self.centre_words(centre, list(self.at))
        words = self.words({third: self.at[third] + self.length(self.chance.uniform(-2, 2))}) \
            if self.chance.random() < 0.5 else []
        self.add(self.chance.choice(("G2", "G3")), *words, *how)

    def cycle(self):
        first, second, third = PLANES[self.plane]
        name = self.chance.choice(("G73", "G81", "G82", "G83", "G85", "G86", "G89"))
        words = [self.chance.choice(("", "", "G98", "G99")), name]
        height = self.length(self.chance.uniform(4, 12))
        self.add("G0", *self.words({third: height}))
        # R never rises in a series: cusp goes up to it before it travels, rs274 on the way.
        least, r = (-4, 1) if self.incremental else (0.5, 9)
        for index in range(self.chance.randint(1, 3)):
            axes = self.chance.sample((first, second), self.chance.randint(1, 2))
            place = {axis: self.length(self.chance.uniform(-15, 15)) for axis in axes}
            repeats = self.chance.choice((0, 0, 2, 3))
            heights = []
            if index == 0 or self.chance.random() < 0.3:
                r = self.chance.uniform(least, r)
                z = self.length(self.chance.uniform(-5, -0.5))
                heights = [AXES[third] + self.text(z), "R" + self.text(self.length(r))]
                if name in ("G73", "G83"):
                    heights.append("Q" + self.text(self.length(self.chance.uniform(0.5, 4))))
                if name in ("G82", "G86", "G89"):
                    heights.append(self.chance.choice(("P0", "P0.1")))
            steps = {axis: round(value - self.at[axis], 5 if self.inches else 4) for axis, value in place.items()}
            out = [f"L{repeats}"] if repeats else []
            spoken = self.words(place)
            if repeats and self.incremental:
                for axis, step in steps.items():
                    self.at[axis] += (repeats - 1) * step
            level = self.chance.choice(("", "", "G98", "G99")) if index else ""
            self.add(level, *words, *spoken, *heights, *out)
            words = [name] if heights and self.chance.random() < 0.5 else []
            if self.chance.random() < 0.3:
                name = self.chance.choice(("G81", "G85"))
                # another cycle of the series needs its words
                z, r = self.length(-1.5), self.chance.uniform(least, r)
                place = {first: self.length(self.chance.uniform(-15, 15))}
                self.add(name, *self.words(place), AXES[third] + self.text(z),
                         "R" + self.text(self.length(r)))
                words = []
        self.add("G80", "G90")
        self.incremental = False
        self.add("G0", *self.words({third: self.length(self.chance.uniform(3, 12))}))

    def unit(self):
        if self.tool_offset:  # rs274 takes 3.5 mm for 3.5 inches then
            self.add("G49")
            self.tool_offset = False
            self.settle()
        self.inches = not self.inches
        factor = 1 / 25.4 if self.inches else 25.4
        self.add("G20" if self.inches else "G21")
        self.at = [value * factor for value in self.at]
        self.feed()

    def distance(self):
        self.incremental = not self.incremental
        self.add("G91" if self.incremental else "G90")

    def centres(self):
        self.absolute_centres = not self.absolute_centres
        self.add("G90.1" if self.absolute_centres else "G91.1")

    def select_plane(self):
        self.plane = self.chance.choice(list(PLANES))
        self.add(self.plane)

    def settle(self):
        """After a change of offsets the place is known again."""
        if self.incremental:
            self.add("G90")
            self.incremental = False
        self.add("G0", *self.words({axis: self.length(self.chance.uniform(-9, 9)) for axis in range(3)}))

    def offset(self):
        values = " ".join(AXES[axis] + self.text(self.length(self.chance.uniform(-9, 9)))
                          for axis in sorted(self.chance.sample(range(3), self.chance.randint(1, 3))))
        self.add(self.chance.choice((
            f"G52 {values}", f"G92 {values}", "G92.1", "G92.2", f"G10 L2 P{self.chance.randint(0, 9)} {values}",
            f"G10 L2 P{self.chance.randint(1, 9)} {values} R0", f"G10 L20 P{self.chance.randint(0, 9)} {values}",
            self.chance.choice(("G54", "G55", "G58", "G59.1", "G59.3")), f"G43.1 Z{self.text(self.length(3.5))}",
            "G49", "G43 H0", "G43")))
        self.tool_offset = self.tool_offset or "G43.1" in self.lines[-1].upper()
        self.settle()

    def home(self):
        self.add(self.chance.choice(("G28.1", "G30.1", "G28", "G30", "G28 Z" + self.text(self.length(5)),
                                     "G30 X" + self.text(self.length(2)))))
        self.settle()

    def machine_line(self):
        if self.incremental:  # LinuxCNC refuses it
            self.distance()
        self.add("G53", self.chance.choice(("G0", "G1")), "Z" + self.text(self.length(self.chance.uniform(0, 9))))
        self.settle()


CALL = re.compile(r"^\s*\d+\s+N\.*\d*\s+([A-Z_0-9]+)\((.*)\)\s*$", re.MULTILINE)


class Canon:
    """The machine's way, in mm, from what rs274 prints."""

    def __init__(self, text):
        self.scale, self.plane = 25.4, "XY"
        self.system, self.shift, self.tool = [0.0] * 3, [0.0] * 3, [0.0] * 3
        self.at, self.length, self.loose = [0.0] * 3, 0.0, 0.0
        self.printed = 1.0  # mm, the unit of the last motion's numbers
        for call, arguments in CALL.findall(text):
            getattr(self, call.lower(), lambda _: None)(arguments)

    @staticmethod
    def numbers(text):
        return [float(word) for word in re.findall(r"-?\d+(?:\.\d+)?", text)]

    def use_length_units(self, text):
        self.scale = {"CANON_UNITS_INCHES": 25.4, "CANON_UNITS_CM": 10.0}.get(text.strip(), 1.0)

    def select_plane(self, text):
        self.plane = text.strip()[-2:]

    def set_g5x_offset(self, text):
        self.system = [self.scale * value for value in self.numbers(text)[1:4]]

    def set_g92_offset(self, text):
        self.shift = [self.scale * value for value in self.numbers(text)[:3]]

    def use_tool_length_offset(self, text):
        self.tool = [self.scale * value for value in self.numbers(text)[:3]]

    def machine(self, place):
        return [self.scale * value + self.system[i] + self.shift[i] + self.tool[i]
                for i, value in enumerate(place[:3])]

    def straight_feed(self, text):
        to = self.machine(self.numbers(text))
        self.length += math.dist(self.at, to)
        self.at, self.printed = to, self.scale
        self.loose += 1e-4 * self.scale

    straight_traverse = straight_feed

    def arc_feed(self, text):
        end1, end2, centre1, centre2, turns, height = self.numbers(text)[:6]
        first, second, third = {"XY": (0, 1, 2), "XZ": (2, 0, 1), "YZ": (1, 2, 0)}[self.plane]
        end, centre = [0.0] * 3, [0.0] * 3
        end[first], end[second], end[third] = end1, end2, height
        centre[first], centre[second] = centre1, centre2
        end, centre = self.machine(end), self.machine(centre)
        begin = math.atan2(self.at[second] - centre[second], self.at[first] - centre[first])
        stop = math.atan2(end[second] - centre[second], end[first] - centre[first])
        sweep = (stop - begin) * (1 if turns > 0 else -1) % (2 * math.pi)
        # A full circle: it ends where it began, within what is printed.
        radius = math.hypot(self.at[first] - centre[first], self.at[second] - centre[second])
        if min(sweep, 2 * math.pi - sweep) * radius < 3e-4 * 25.4:
            sweep = 2 * math.pi
        sweep += 2 * math.pi * (abs(turns) - 1)
        last = math.hypot(end[first] - centre[first], end[second] - centre[second])
        self.length += math.hypot(0.5 * (radius + last) * sweep, end[third] - self.at[third])
        self.at, self.printed = end, self.scale
        self.loose += 1e-4 * self.scale * (1 + sweep)


def by_rs274(text, folder):
    (folder / "program.ngc").write_bytes(text.encode("latin-1", "replace"))
    (folder / "tools.tbl").write_text("T1 P1 Z0 D1\n")
    for name in ("rs274ngc.var", "rs274ngc.var.bak"):
        (folder / name).unlink(missing_ok=True)
    run = subprocess.run(["rs274", "-g", "-t", "tools.tbl", "program.ngc"], cwd=folder, text=True,
                         errors="replace", stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=300)
    canon = Canon(run.stdout)
    refused = None
    if run.returncode != 0:
        said = [line for line in run.stderr.splitlines() if line.strip() and line != "executing"]
        refused = " / ".join(said[-2:])[-200:]
    return canon, refused


def by_cusp(text, folder, cusp):
    (folder / "program.ngc").write_bytes(text.encode("latin-1", "replace"))
    run = subprocess.run([cusp, "sim", "program.ngc", "--stats", "stats.json"], cwd=folder, text=True,
                         errors="replace", stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=600)
    if run.returncode not in (0, 1):
        raise RuntimeError(f"cusp sim: {run.returncode}: {run.stderr[-300:]}")
    return json.loads((folder / "stats.json").read_text()), run.stderr.strip()[-200:]


def planted(text):
    """A random program that ends 0.01 mm, or inch, beside the right place, or goes 4 too far to it."""
    lines = text.splitlines()
    more = ["G91 G0 X0.01"] if len(lines) % 2 else ["G91 G0 X2", "X-2"]
    return "\n".join(lines[:-1] + more + lines[-1:]) + "\n"


def difference(text, folder, cusp, change):
    """The difference of two readings of a program, REFUSED, or None if there is none."""
    canon, refused = by_rs274(change(text), folder)
    stats, said = by_cusp(text, folder, cusp)
    errors = stats.get("errors", [])
    if bool(refused) != bool(errors):
        return f"refused by {'rs274' if refused else 'cusp'} alone: {refused or said}"
    if refused:
        # rs274 shows the line after its reason; both stop there.
        shown, line = (re.sub(r"[^!-~]", "", said).lower()
                       for said in (refused.rsplit(" / ", 1)[-1], errors[0].get("block", "")))
        return REFUSED if line in shown or shown in line else f"refuse at other lines: rs274 {refused}, cusp {said}"
    end = stats["end_mpos_mm"]
    if math.dist(end, canon.at) > NEAR + 1e-4 * canon.printed:
        return f"ends: rs274 {[round(value, 4) for value in canon.at]}, cusp {end}"
    # Corners are exact (G61): the length is that of the path.
    length = stats["length_mm"]
    if abs(length - canon.length) > NEAR + SHARE * canon.length + canon.loose:
        return f"lengths: rs274 {canon.length:.4f} mm, cusp {length:.4f}"
    return None


def comparable(text):
    """The program with exact corners, since rs274 has no motion, in millimetres at first, and with an end."""
    text = re.sub(r"(?i)G0?64(?!\d)(\s*[PQ]\s*[\d.]+)*", "G61", text)
    mark = re.match(r"(?:\xef\xbb\xbf)?\s*%[^\n]*\n", text)
    begin = mark.end() if mark else 0
    ended = re.search(r"(?im)^[^(;\n]*M0?(2|30)(?![\d.])|^\s*%", text[begin:])
    return text[:begin] + "G21 G61\n" + text[begin:] + ("" if ended else "\nM2\n")


def programs(options):
    for seed in range(options.first, options.first + options.seeds):
        yield f"seed {seed}", comparable("\n".join(RandomProgram(seed).lines) + "\n")
    if options.folder:
        for file in sorted(options.folder.rglob("*.ngc")):
            yield str(file), comparable(file.read_text(encoding="latin-1"))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cusp", type=lambda name: pathlib.Path(name).resolve())
    parser.add_argument("--seeds", type=int, default=0, help="number of random programs")
    parser.add_argument("--first", type=int, default=1, help="the first seed")
    parser.add_argument("--folder", type=pathlib.Path)
    parser.add_argument("--keep", type=pathlib.Path, help="where programs that differ are kept")
    parser.add_argument("--plant", action="store_true")
    options = parser.parse_args()
    if shutil.which("rs274") is None:
        print("rs274: not installed (Debian: linuxcnc-uspace): nothing was compared")
        return SKIPPED
    print(f"seeds {options.first} to {options.first + options.seeds - 1}" if options.seeds else "no seeds")
    change = planted if options.plant else lambda text: text
    differing = refused = count = 0
    with tempfile.TemporaryDirectory() as name:
        for title, text in programs(options):
            count += 1
            try:
                found = difference(text, pathlib.Path(name), options.cusp, change)
            except (RuntimeError, OSError, ValueError, subprocess.SubprocessError) as error:
                print(f"{title}: {error}", file=sys.stderr)
                return 2
            refused += found == REFUSED
            found = None if found == REFUSED else found
            differing += found is not None
            if found and not options.plant:
                print(f"{title}: {found}", flush=True)
                if options.keep:
                    options.keep.mkdir(parents=True, exist_ok=True)
                    (options.keep / (re.sub(r"\W+", "_", title) + ".ngc")).write_text(text, errors="replace")
    print(f"{count} programs, {differing} differ, {refused} are refused by both at the same line")
    wanted = count - refused if options.plant else 0
    return 0 if differing == wanted else 1


if __name__ == "__main__":
    sys.exit(main())
