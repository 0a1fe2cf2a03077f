#!/usr/bin/env python3
"""Machine files: limits that bound a job, settings dumps of controllers, the default post, travel and times.

usage: machine_test.py CUSP
"""
import json
import random
import re
import sys
import unittest

from cusp_case import CuspCase

MACHINE = """name = "router"
travel = [300, 200, 80]
max_rate = [5000, 4000, 1000]
acceleration = [500, 500, 200]
spindle = [8000, 20000]
post = "grblhal"
"""
JOB = """units = "mm"
machine = "mill.toml"
[[tool]]
shape = "flat"
diameter = 6
{tool}
[cutting]
feed = {feed}
{cutting}
[stock]
top = 0
bottom = -6
x = [0, {length}]
y = [0, 100]
[[operation]]
strategy = "face"
depth = 1
overhang = 0
{operation}
"""
# As Grbl 1.1, Grbl 0.9 with its comments, and grblHAL with settings that are no numbers.
GRBL = "$0=10\n$30=20000\n$31=0\n$100=250.000\n$110=5000.000\n$111=4000.000\n$112=1000.000\n$120=500.000\n$121=500.000\n$122=200.000\n" \
       "$130=300.000\n$131=200.000\n$132=80.000\nok\n"
DUMPS = {
    "grbl": GRBL,
    "comments": "Grbl 0.9j ['$' for help]\r\n" + re.sub(r"(=\S+)\n", r"\1 (some, words)\r\n", GRBL),
    "grblHAL": "[MSG:text]\n$70=15\n$74=\n$75=a name\n$300=grbl.local\n$341=0\n" + GRBL.replace("$31=0", "$31=0.000"),
}


class Machines(CuspCase):
    def job(self, tool="", feed=1000, cutting="", length=200, operation="", machine=MACHINE):
        self.write("mill.toml", machine)
        self.write("job.toml", JOB.format(tool=tool, feed=feed, cutting=cutting, length=length, operation=operation))

    def plan(self, status=0, *options):
        return self.cusp(status, "plan", "job.toml", "-o", "p.ngc", *options)

    def seconds(self):
        self.plan(0, "--stats", "p.json")
        return json.loads((self.folder / "p.json").read_text())["estimated_s"]

    def test_the_post_is_the_default(self):
        self.job()
        self.plan()
        self.assertIn("M6", (self.folder / "p.ngc").read_text())
        self.plan(0, "--post", "grbl")
        self.assertNotIn("M6", (self.folder / "p.ngc").read_text())
        self.write("job.toml", 'post = "grbl"\n' + (self.folder / "job.toml").read_text())
        self.plan()
        self.assertNotIn("M6", (self.folder / "p.ngc").read_text())

    def test_what_no_controller_reaches_is_refused(self):
        outline = "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n8\no\n10\n{x}\n20\n{y}\n40\n{r}\n0\nENDSEC\n0\nEOF\n"
        for units, unit in (("mm", 1), ("inch", 25.4)):
            for x, y, goes in ((99900, 0, ""), (100000, 0, "x 100023"), (5, -412300, "y -412323"), (-2e5, 1, "x -200023")):
                self.write("far.dxf", outline.format(x=x / unit, y=y / unit, r=20 / unit))
                call = ("plan", "far.dxf", "--units", units, "--tool", f"flat:{6 / unit}", "--depth", f"{1 / unit}", "-o", "p.ngc")
                with self.subTest(units=units, x=x, y=y):
                    said = self.cusp(2 if goes else 0, *call)
                    self.assertEqual(bool(goes), "controllers take 100000 mm from the origin at most" in said, said)
                    self.assertIn(f"goes to {goes}" if goes else "wrote p.ngc", said)
                    self.cusp(0, *call, "--origin", "corner")

    def test_rates_beyond_it_are_refused_where_they_are_given(self):
        for given, words in (
                (dict(feed=4001), "job.toml:8: cutting: feed: is 4001 mm/min, above the 4000 mm/min of mill.toml:3: max_rate"),
                (dict(cutting="plunge_feed = 1001"), "job.toml:9: cutting: plunge_feed: is 1001 mm/min, above the 1000 mm/min of "
                                                     "mill.toml:3: max_rate"),
                (dict(cutting="spindle = 20001"), "job.toml:9: cutting: spindle: is 20001 rpm, above the 20000 rpm of mill.toml:5: spindle"),
                (dict(cutting="spindle = 7999"), "spindle: is 7999 rpm, below the 8000 rpm of mill.toml:5: spindle"),
                (dict(tool="feed = 4001"), "job.toml:6: tool 1: feed: is 4001 mm/min"),
                (dict(operation="feed = 4001"), "operation 1: feed: is 4001 mm/min"),
                (dict(operation="chip_load = true\nfeed_max = 4001"), "operation 1: feed_max: is 4001 mm/min")):
            with self.subTest(given=given):
                self.job(**given)
                self.assertIn(words, self.plan(2))

    def test_rates_within_it_and_those_that_do_not_count_are_taken(self):
        for given in (dict(feed=4000, cutting="plunge_feed = 1000\nspindle = 20000"), dict(cutting="spindle = 0"),
                      dict(cutting="spindle = 8000"), dict(tool="feed = 9000", operation="feed = 3000"),
                      dict(feed=9000, tool="feed = 3000"), dict(operation="chip_load = true", feed=3000)):
            with self.subTest(given=given):
                self.job(**given)
                self.plan()
        self.assertLessEqual(max(float(f) for f in re.findall(r"F([0-9.]+)", (self.folder / "p.ngc").read_text())), 4000)

    def test_a_plunge_feed_that_nobody_gave_is_lowered(self):
        self.job(feed=4000, machine=MACHINE.replace("1000]", "600]"))
        self.plan()
        self.assertEqual({"4000", "600"}, set(re.findall(r"F([0-9.]+)", (self.folder / "p.ngc").read_text())))

    def test_travel_bounds_the_extent_of_the_program(self):
        self.job(length=294)  # the tool's middle goes a radius beyond both ends
        self.plan()
        self.job(length=295)
        said = self.plan(2)
        self.assertRegex(said, r"job.toml: the program needs 301 mm of x, from \S+ \(operation 1, face\) to \S+ \(operation 1, "
                               r"face\); mill.toml:2: travel allows 300 mm")
        self.job(length=200, operation="max_depth = 0.5", machine=MACHINE.replace("80]", "5.9]"))
        self.assertIn("mm of z", self.plan(2))  # 5 mm of clearance and a depth of 1
        self.job(machine=MACHINE.replace("80]", "6]"))
        self.plan()

    def test_the_extent_is_that_of_the_program_over_random_jobs(self):
        draw = random.Random(546)
        for case in range(6):
            length = draw.randint(120, 400)
            self.job(length=length, machine='name = "any"\n', operation=f'traversal = "{draw.choice(("zigzag", "one_way"))}"')
            self.plan()
            xs = [float(x) for x in re.findall(r"X(-?[0-9.]+)", (self.folder / "p.ngc").read_text())]
            extent = max(xs) - min(xs)
            for travel, status in ((extent + 0.01, 0), (extent - 0.01, 2)):
                with self.subTest(seed=546, case=case, travel=travel):
                    self.job(length=length, machine=f"travel = [{travel}, 500, 500]\n")
                    self.plan(status)

    def test_settings_dumps_give_what_the_file_leaves_out(self):
        for name, dump in DUMPS.items():
            with self.subTest(name=name):
                self.job(feed=4001, machine='settings = "mill.settings"\n')
                (self.folder / "mill.settings").write_text(dump, newline="")
                self.assertRegex(self.plan(2), r"above the 4000 mm/min of mill.settings:\d+: \$111")
                self.job(length=320, machine='settings = "mill.settings"\n')
                self.assertRegex(self.plan(2), r"mill.settings:\d+: \$130 allows 300 mm")
                self.job(feed=4001, machine='settings = "mill.settings"\nmax_rate = [4500, 4500, 1000]\n')
                self.plan()
        self.write("mill.settings", self.cusp(0, "settings"))
        self.job(feed=6001, machine='settings = "mill.settings"\n')
        self.assertIn("above the 6000 mm/min", self.plan(2))

    def test_times_are_those_of_the_machine(self):
        self.job(feed=3000, machine='name = "any"\n')
        usual = self.seconds()
        self.job(feed=3000, machine="acceleration = [20, 20, 20]\n")
        slow = self.seconds()
        self.assertGreater(slow, 1.3 * usual)
        self.write("slow.settings", "".join(f"$12{k}=20\n" for k in range(3)))
        self.assertAlmostEqual(self.sim_seconds("slow.settings"), slow, delta=0.02 * slow)

    def test_estimated_times_are_near_those_of_the_controller_and_change_no_move(self):
        self.job(feed=3000, machine='name = "any"\n')
        run = self.seconds()
        program = (self.folder / "p.ngc").read_text()
        self.plan(0, "--stats", "p.json", "--estimate-times")
        estimate = json.loads((self.folder / "p.json").read_text())
        self.assertEqual(program, (self.folder / "p.ngc").read_text())
        self.assertNotEqual(run, estimate["estimated_s"])
        self.assertAlmostEqual(run, estimate["estimated_s"], delta=0.15 * run)
        self.assertNotIn("air_s", estimate)

    def sim_seconds(self, settings):
        self.cusp(0, "sim", "p.ngc", "--settings", settings, "--stats", "sim.json")
        return json.loads((self.folder / "sim.json").read_text())["duration_s"]

    def test_an_option_names_the_machine_of_any_call(self):
        self.job(feed=3000)
        self.write("small.toml", "travel = [100, 100, 100]\n")
        self.assertIn("small.toml:1: travel", self.plan(2, "--machine", "small.toml"))
        self.write("part.dxf", "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n8\n0\n10\n50\n20\n50\n40\n20\n0\nENDSEC\n0\nEOF\n")
        call = ("part.dxf", "--tool", "flat:6", "--depth", "3", "--machine", "mill.toml")
        self.cusp(0, "plan", *call, "-o", "p.ngc")
        self.assertIn("M6", (self.folder / "p.ngc").read_text())
        self.assertIn("--feed: is 9000 mm/min, above the 4000 mm/min of mill.toml:3: max_rate",
                      self.cusp(2, "plan", *call, "-o", "p.ngc", "--feed", "9000"))
        self.write("mill.toml", MACHINE.replace("20000", "10000").replace("5000, 4000, 1000", "800, 900, 100"))
        job = self.cusp(0, "plan", *call, "--print-job")
        for line in ('machine = "mill.toml"', "feed = 800", "plunge_feed = 100", "spindle = 10000"):
            self.assertIn(line + "\n", job)

    def test_faults_of_the_file(self):
        for machine, words in (
                (MACHINE + "speed = 3\n", "mill.toml:7: speed: unknown key"),
                (MACHINE.replace("[300, 200, 80]", "[300, 200]"), "mill.toml:2: travel: has 2 numbers, needed: three lengths"),
                (MACHINE.replace("300", "-1"), "mill.toml:2: travel: is -1, it must be above 0"),
                (MACHINE.replace("grblhal", "grblhall"), 'machine: post "grblhall": there is none of that name'),
                ('settings = "none.settings"\n', "settings: none.settings"),
                ('settings = "mill.toml"\n', "has none of the settings $30, $110 and $130"),
                ('settings = "bad.settings"\n', 'bad.settings:1: $110: is "fast", a number from 0')):
            with self.subTest(words=words):
                self.write("bad.settings", "$110=fast\n")
                self.job(machine=machine)
                self.assertIn(words, self.plan(2))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
