#!/usr/bin/env python3
"""Plans for other controllers and judges their programs: by the words that they know, by the dialect of stock Grbl, and
by LinuxCNC's own reader where it is installed (rs274 of the Debian package linuxcnc-uspace, 190 MB: not in CI).

usage: posts_test.py CUSP [--examples [NAME ...]]
--examples writes every example by every post and follows all golden programs: minutes. With names, only those jobs and
golden programs whose path contains one of them. It takes Debian's interpreter, which has numpy.
"""
import bisect
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

import numpy

from cusp_case import CUSP, share_of
from pocket_case import PocketCase

EXAMPLES = "--examples" in sys.argv
CHOSEN = sys.argv[sys.argv.index("--examples") + 1:] if EXAMPLES else []  # names; none: all
TOP = pathlib.Path(__file__).resolve().parents[2]
POSTS = ("centroid", "cusp", "fanuc", "grbl", "grblhal", "haas", "linuxcnc", "mach3", "mach4", "marlin", "pathpilot", "smoothieware")
LINES_ALONE = ("marlin",)
NOT_RUN = ("smoothieware",)  # M600 pauses there and is no word here; coolant is no word of it
# Words in the manufacturers' manuals that planned programs may need.
COMMON = {"G0", "G1", "G2", "G3", "G17", "G18", "G19", "G20", "G21", "G40", "G49", "G54", "G80", "G90", "G94",
          "M0", "M3", "M5", "M8", "M9", "M30"}
WORDS = {
    "grbl": COMMON,
    "grblhal": COMMON | {"G61", "M6", "M7", "T"},
    "linuxcnc": COMMON | {"G43", "G61", "G64", "G91.1", "M6", "M7", "T", "H", "P"},
    "mach3": COMMON | {"G43", "G61", "G64", "G91.1", "M6", "M7", "T", "H"},
    "fanuc": COMMON | {"G43", "G61", "G64", "M6", "T", "H", "O"},
    "haas": COMMON - {"M3", "M5", "M8", "M9"} | {"G43", "G61", "G64", "M03", "M05", "M06", "M08", "M09", "T", "H", "O"},
    "mach4": COMMON | {"G43", "G61", "G64", "G91.1", "M6", "M7", "T", "H"},
    "pathpilot": COMMON | {"G43", "G61", "G64", "G91.1", "M6", "M7", "T", "H", "P"},
    "centroid": COMMON - {"G94"} | {"G43", "M6", "M7", "T", "H"},
    "smoothieware": {"G0", "G1", "G2", "G3", "G17", "G18", "G19", "G20", "G21", "G54", "G90", "M3", "M5", "M600"},
    "marlin": {"G0", "G1", "G20", "G21", "G90", "M0", "M3", "M5", "M8", "M9"},
}
VALUES = {"X", "Y", "Z", "I", "J", "K", "R", "F", "S", "N"}
SQUARE = ("0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n8\no\n90\n4\n70\n1\n" +
          "".join(f"10\n{x}\n20\n{y}\n" for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))) + "0\nENDSEC\n0\nEOF\n")
LEVEL = """units = "inch"
[tool]
{tool}
[cutting]
feed = 30
[stock]
top = 0
bottom = -0.5
[[operation]]
strategy = "pocket"
boundary = "square.dxf#o"
depth = {depth}
"""
NEAR = 0.0029  # mm: between set points of two readers' paths
SAME = 0.0009  # mm: between their ends; to both is added what rs274 rounds, 0.0001 mm, in inches 0.0022



def bare(line):
    return re.sub(r"\(.*?\)|;.*", "", line).replace(" ", "").strip()


def words_of(program):
    for line in program.splitlines():
        yield from re.findall(r"([A-Z])([-+.\d]+)", bare(line))


class Posts(PocketCase):
    SIZE = (22, 14)  # it is planned many times

    def test_a_post_of_the_job_and_of_the_call_are_the_same(self):
        self.job()
        default = self.planned()
        self.assertEqual(default, self.planned("--post", "cusp"))
        by_call = self.planned("--post", "grbl")
        self.assertNotEqual(default, by_call)
        self.job(more='post = "grbl"')
        self.assertEqual(by_call, self.planned())
        self.assertEqual(default, self.planned("--post", "cusp"))

    def test_the_files_that_come_with_the_program_can_be_copied(self):
        for post in POSTS:
            for output in ("lines", "arcs")[:1 if post in LINES_ALONE else 2]:
                self.job(output, coolant=post not in NOT_RUN)
                by_name = self.planned("--post", post)
                self.write(f"{post}.toml", (TOP / "posts" / f"{post}.toml").read_text())
                self.assertEqual(by_name, self.planned("--post", f"{post}.toml"), post)

    def test_only_words_of_the_target_are_written(self):
        for post, known in WORDS.items():
            for units in ("mm", "inch"):
                self.job("lines" if post in LINES_ALONE else "arcs", units=units, coolant=post not in NOT_RUN)
                for letter, number in words_of(self.planned("--post", post)):
                    word = letter + number if letter in "GM" else letter
                    self.assertTrue(word in known or letter in VALUES, f"{post} writes {word}")

    def test_every_program_runs_and_holds_the_bounds_of_its_job(self):
        for post in POSTS:
            if post in NOT_RUN:
                continue
            self.job("lines" if post in LINES_ALONE else "arcs")
            self.planned("--post", post)
            self.cusp(0, "sim", "p.ngc")
            self.assertIn("all bounds hold", self.cusp(0, "verify", "job.toml", "p.ngc"), post)

    def test_marlin_gets_one_command_a_line_and_a_feed_for_rapids(self):
        for units, rapid in (("mm", "6000"), ("inch", "236.22")):
            self.job("lines", 'post = "marlin"', units)
            feed = None
            for line in map(bare, self.planned().splitlines()):
                self.assertLessEqual(len(re.findall("[GM]", line)), 1, line)
                word = re.search(r"F([\d.]+)", line)
                feed = word.group(1) if word else feed
                if re.match(r"G0[XYZ]", line) and feed is not None:
                    self.assertEqual(rapid, feed, line)
                elif line.startswith("G1"):
                    self.assertNotEqual(rapid, feed, line)
        self.job("arcs", 'post = "marlin"')
        self.assertIn('the post "marlin" has no G2 and G3', self.cusp(2, "plan", "job.toml", "-o", "p.ngc"))

    def test_each_post_says_what_it_writes(self):
        said = self.cusp(0, "plan", "--list-posts")
        self.assertEqual(list(POSTS), re.findall(r"^(\w+): ", said, re.M))
        self.assertRegex(said, r"haas: Haas mills\n.*3 and 4 decimals.*G81 G83.*tool change T M06 G43.*coolant M08")
        self.assertRegex(said, r"marlin: Marlin 2\n.*no arcs")

    def test_a_program_that_was_copied_without_its_posts_says_so(self):
        alone = shutil.copy(CUSP, self.folder)
        done = subprocess.run([alone, "plan", "--list-posts"], capture_output=True, text=True)
        self.assertEqual(2, done.returncode)
        self.assertIn("the posts that come with cusp are not found: share/cusp/posts", done.stderr)

    def test_feeds_speeds_and_coolant_are_those_of_the_tool(self):
        self.job()
        text = self.planned()
        flat, ball = text.index("\nT1\n"), text.index("\nT2\n")
        self.assertLess(flat, ball)
        self.assertTrue(text[flat:].startswith("\nT1\nM3 S9000\nM8\n"), text[flat:flat + 40])
        self.assertTrue(text[ball:].startswith("\nT2\nM0\nM3 S12000\nG0"), text[ball:ball + 40])
        self.assertIn(" F1500\n", text[flat:ball])
        self.assertNotIn(" F1500\n", text[ball:])
        self.assertIn(" F1000\n", text[ball:])
        self.assertEqual(1, text.count("M9\n"))
        self.assertIn("(tool 1 flat diameter 8 mm: 8mm flat)", text)

    def test_grbl_programs_are_taken_by_stock_grbl(self):
        for output in ("lines", "arcs"):
            self.job(output)
            self.planned("--post", "grbl")
            self.cusp(0, "sim", "p.ngc", "--dialect", "grbl")
        self.planned("--blend", "0.02")
        self.assertIn('error:20: a G or M word is not supported: G64 in "G64 P0.02": stock Grbl 1.1 does not take it',
                      self.cusp(1, "sim", "p.ngc", "--dialect", "grbl"))

    def test_fanuc_rounds_and_says_so(self):
        self.job(more='post = "fanuc"')
        text = self.planned()
        self.assertTrue(text.startswith("%\nO1000\n"))
        self.assertTrue(text.endswith("M30\n%\n"))
        for letter, number in words_of(text):
            if letter in "XYZIJKF":
                self.assertRegex(number, r"^-?\d+\.\d{0,3}$")
        self.assertIn("rounded to 3 decimals", text)
        self.assertIn("T1 M6 (8mm flat)", text)
        rounded = json.loads((self.folder / "p.json").read_text())
        self.planned("--post", "cusp")
        fine = json.loads((self.folder / "p.json").read_text())
        for a, b in zip(rounded["operations"], fine["operations"]):
            self.assertGreaterEqual(a["gouge_bound_mm"], 0.0016)
            self.assertGreaterEqual(a["gouge_bound_mm"], b["gouge_bound_mm"])

    def test_a_tolerance_below_the_rounding_is_refused(self):
        self.job(more='post = "fanuc"')
        job = (self.folder / "job.toml").read_text()
        self.write("job.toml", job + "floor_tolerance = 0.003\n")
        self.assertIn('floor_tolerance is 0.003 mm, but the post "fanuc" rounds to 3 decimals',
                      self.cusp(2, "plan", "job.toml", "-o", "p.ngc"))

    def test_level_pockets_of_few_decimals_hold(self):
        for post in ("fanuc", "haas"):
            for depth in share_of([f"0.{k}" for k in range(11906, 12006, 9)]):
                for tool in ('shape = "flat"\ndiameter = 0.16', 'shape = "bull"\ndiameter = 0.2\ncorner_radius = 0.03'):
                    with self.subTest(post=post, depth=depth, tool=tool):
                        self.write("square.dxf", SQUARE)
                        self.write("job.toml", LEVEL.format(depth=depth, tool=tool))
                        self.cusp(0, "plan", "job.toml", "-o", "p.ngc", "--post", post)
                        self.cusp(0, "verify", "job.toml", "p.ngc")

    def test_what_the_target_lacks_is_refused_by_name(self):
        self.job("nurbs")
        for post in WORDS:
            said = self.cusp(2, "plan", "job.toml", "-o", "p.ngc", "--post", post)
            self.assertIn(f'output = "nurbs", but the post "{post}" has no G6.2', said)
        self.job(more='post = "grbl"')
        self.assertIn('the post "grbl" has no word for the tolerance of corners',
                      self.cusp(2, "plan", "job.toml", "-o", "p.ngc", "--blend", "0.02"))
        self.write("job.toml", (self.folder / "job.toml").read_text().replace("flood", "mist"))
        self.assertIn('coolant = "mist" of tool 1, but the post "grbl" has no word for it',
                      self.cusp(2, "plan", "job.toml", "-o", "p.ngc"))

    def test_wrong_posts_are_refused_with_the_nearest(self):
        self.job(more='post = "grlb"')
        said = self.cusp(2, "plan", "job.toml", "-o", "p.ngc")
        self.assertIn('post "grlb": there is none of that name, the nearest is "grbl"', said)
        self.assertIn(", ".join(POSTS), said)
        self.job()
        grbl = (TOP / "posts/grbl.toml").read_text()
        for wrong, words in ((grbl.replace("nurbs = false\n", ""), "nurbs: is missing"),
                             (grbl.replace("footer", "foter"), "foter: unknown key; the nearest known one is footer"),
                             (grbl.replace("{rpm}", "{speed}"), "{speed} in \"M3 S{speed}\" is no field of it; known are: rpm"),
                             (grbl.replace("mm_decimals = 4", "mm_decimals = 2"), "mm_decimals: is 2"),
                             (grbl.replace('"IJ"', '"XY"'), 'arcs: is "XY", known are'),
                             (grbl.replace("M30", "M30\\n"), "printable ASCII"),
                             (grbl + "]", "not TOML")):
            self.write("own.toml", wrong)
            self.assertIn(words, self.cusp(2, "plan", "job.toml", "-o", "p.ngc", "--post", "own.toml"))
        self.cusp(2, "plan", "job.toml", "-o", "p.ngc", "--post", "none.toml")


# One motion that LinuxCNC's reader makes of a line: its points, mm.
def canon_points(call, numbers, plane, at, scale):
    if call != "ARC_FEED":
        return [tuple(scale * v for v in numbers[:3])]
    first, second, axis = {"XY": (0, 1, 2), "XZ": (2, 0, 1), "YZ": (1, 2, 0)}[plane]
    end_1, end_2, centre_1, centre_2, turns, end_3 = numbers[:6]
    end_1, end_2, centre_1, centre_2, end_3 = (scale * v for v in (end_1, end_2, centre_1, centre_2, end_3))
    begin = math.atan2(at[second] - centre_2, at[first] - centre_1)
    sweep = math.atan2(end_2 - centre_2, end_1 - centre_1) - begin
    sweep = sweep % (2 * math.pi) if turns > 0 else -(-sweep % (2 * math.pi))
    if abs(sweep) < 1e-9:
        sweep = math.copysign(2 * math.pi, turns)
    radius = math.hypot(at[first] - centre_1, at[second] - centre_2)
    points = []
    for k in range(1, 16):
        point = [0.0, 0.0, 0.0]
        point[first] = centre_1 + radius * math.cos(begin + sweep * k / 16)
        point[second] = centre_2 + radius * math.sin(begin + sweep * k / 16)
        point[axis] = at[axis] + (end_3 - at[axis]) * k / 16
        points.append(tuple(point))
    end = [0.0, 0.0, 0.0]
    end[first], end[second], end[axis] = end_1, end_2, end_3
    return points + [tuple(end)]


# Distance of the farthest of some points from the polyline `path` (rows x, y, z), and that point.
def farthest_off(points, path):
    begins, steps = path[:-1], numpy.diff(path, axis=0)
    squared = (steps * steps).sum(axis=1)
    squared[squared == 0] = 1.0
    worst = (0.0, ())
    for p in points:
        along = numpy.clip(((p - begins) * steps).sum(axis=1) / squared, 0.0, 1.0)
        off = ((begins + along[:, None] * steps - p) ** 2).sum(axis=1).min() ** 0.5
        worst = max(worst, (float(off), p))
    return worst


def chosen(path):
    return not CHOSEN or any(name in str(path) for name in CHOSEN)


@unittest.skipUnless(shutil.which("rs274"), "no rs274 here: apt-get install linuxcnc-uspace")
class LinuxCnc(PocketCase):
    CALL = re.compile(r"N(\S+)\s+(STRAIGHT_TRAVERSE|STRAIGHT_FEED|ARC_FEED|SELECT_PLANE|USE_LENGTH_UNITS)\((.*)\)")

    # The motions of the program by its lines, as rs274 reads it.
    def canon(self, program):
        numbered = "\n".join(line if re.match(r"\s*(\(|;|%|/|$)", line) else
                             f"N{number} " + re.sub(r"^\s*[Nn]\d+\s*", "", line)
                             for number, line in enumerate(program.splitlines(), 1)) + "\n"
        ended = re.search(r"^[^(;]*M0?(2|30)\b", program, re.MULTILINE)
        self.write("numbered.ngc", numbered + ("" if ended else "M2\n"))
        tools = sorted({int(float(n)) for letter, n in words_of(program) if letter == "T"})
        self.write("tool.tbl", "".join(f"T{t} P{t} Z0 D1\n" for t in tools))
        said = subprocess.run(["rs274", "-g", "-t", "tool.tbl", "numbered.ngc"], cwd=self.folder, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=1200)
        self.assertEqual(0, said.returncode, said.stdout[-600:])
        self.assertTrue("PROGRAM_END" in said.stdout, said.stdout[-600:])
        at, plane, scale, motions = (0.0, 0.0, 0.0), "XY", 1.0, []
        for line, call, arguments in self.CALL.findall(said.stdout):
            if call == "SELECT_PLANE":
                plane = arguments[-2:]
            elif call == "USE_LENGTH_UNITS":
                scale = 25.4 if "INCH" in arguments else 1.0
                self.printed = math.sqrt(3) * 0.5e-4 * scale  # mm: it prints four decimals of its unit
            else:
                points = canon_points(call, [float(v) for v in arguments.split(",")], plane, at, scale)
                motions.append((int(line), points))
                at = points[-1]
        return motions

    # The motions of our controller: all set points, and the rows of each line, with some before and after: filters lag.
    def samples(self, name):
        self.cusp(0, "sim", name, "--samples", "s.csv", "--stats", "s.json")
        rows = numpy.loadtxt(self.folder / "s.csv", dtype=numpy.int64, delimiter=",", skiprows=1)
        (self.folder / "s.csv").unlink()
        lines, of_row = numpy.unique(rows[:, 4], return_inverse=True)
        first, last = numpy.full(len(lines), len(rows)), numpy.zeros(len(lines), dtype=int)
        numpy.minimum.at(first, of_row, numpy.arange(len(rows)))
        numpy.maximum.at(last, of_row, numpy.arange(len(rows)))
        lag = 100
        paths = {int(line): (max(0, a - lag), b + lag + 1) for line, a, b in zip(lines, first, last)}
        return rows[:, 1:4] / 1e6, paths

    # Both readers end at the same place; those of `cusp sim` are in the file of --stats.
    def same_end(self, motions):
        end = json.loads((self.folder / "s.json").read_text())["end_mpos_mm"]
        self.assertLess(math.dist(motions[-1][1][-1], end), SAME + self.printed)

    def follow(self, program, near=NEAR):
        self.write("p.ngc", program)
        motions = self.canon(program)
        points, paths = self.samples("p.ngc")
        self.same_end(motions)
        order = sorted(paths)
        at, worst, compared = (0.0, 0.0, 0.0), (0.0, 0, ()), 0
        for line, ends in motions:
            if math.dist(at, ends[-1]) < 1e-4 and len(ends) == 1:
                continue  # no motion
            # many short lines pass in one set point: that of the last line before
            seen = order[max(0, bisect.bisect_right(order, line) - 1)]
            off, p = farthest_off(ends, points[slice(*paths[seen])])
            worst = max(worst, (off, line, p))
            compared += len(ends)
            at = ends[-1]
        self.assertGreater(compared, 0)
        self.assertLess(worst[0], near + self.printed, f"line {worst[1]}: {program.splitlines()[worst[1] - 1]}: {worst[2]}")
        return compared

    def test_planned_programs_take_the_same_way(self):
        for output in ("lines", "arcs"):
            self.job(output)
            self.follow(self.planned("--post", "linuxcnc"))
            # no G61: our controller rounds corners by $11
            self.follow(self.planned("--post", "grbl"), NEAR + 0.01)
        by_radius = (TOP / "posts/linuxcnc.toml").read_text().replace('arcs = "IJ"', 'arcs = "R"')
        self.write("radius.toml", by_radius)
        text = self.planned("--post", "radius.toml")
        self.assertRegex(text, r"G[23] [^(]* R\d")
        self.follow(text)

    # Jobs of the examples in a folder of their own, without NURBS, which these posts lack.
    def example_jobs(self):
        shutil.copytree(TOP / "examples", self.folder / "examples", dirs_exist_ok=True)
        jobs = [job for job in sorted((self.folder / "examples").glob("*/*.toml"))
                if "[[operation]]" in job.read_text() and chosen(job.relative_to(self.folder))]
        for job in jobs:
            job.write_text(job.read_text().replace('output = "nurbs"', 'output = "arcs"'))
        return jobs

    # A program for each set-up.
    def planned_example(self, job, post):
        for old in self.folder.glob("e*.nc"):
            old.unlink()
        self.cusp(0, "plan", str(job), "-o", "e.nc", "--post", post)
        return sorted(self.folder.glob("e*.nc"))

    # rs274 ends with an error at a word that it does not know: a program read to its end has no unread word.
    @unittest.skipUnless(EXAMPLES, "the examples take minutes: --examples")
    def test_every_post_writes_every_example(self):
        for job in self.example_jobs():
            for post in POSTS:
                with self.subTest(job=job.name, post=post):
                    for program in self.planned_example(job, post):
                        self.judge_example(f"{job.parent.name}/{job.name} {post}", program, post)

    def judge_example(self, what, program, post):
        text = program.read_text()
        words = sum(1 for _ in words_of(text))
        if post == "linuxcnc":
            print(what, program.name, words, "words,", self.follow(text), "points on the way", flush=True)
            return
        self.cusp(0, "sim", program.name, "--stats", "s.json", *(("--dialect", "grbl") if post == "grbl" else ()))
        motions = self.canon(text)
        self.same_end(motions)
        print(what, program.name, words, "words,", len(motions), "motions, the same end", flush=True)

    @unittest.skipUnless(EXAMPLES, "the golden programs take minutes: --examples")
    def test_golden_programs_take_the_same_way(self):
        for program in filter(chosen, sorted((TOP / "tests/programs").glob("*.ngc"))):
            with self.subTest(program=program.name):
                # our controller rounds corners by $11 where a program does not say G61
                print(program.name, self.follow(program.read_text(), NEAR + 0.01), "points")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + (["LinuxCnc"] if EXAMPLES else sys.argv[2:]), verbosity=2)
