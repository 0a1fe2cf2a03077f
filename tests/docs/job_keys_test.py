#!/usr/bin/env python3
"""Keys of jobs: docs/job_file.md has their tables, the JSON Schema takes every example and refuses faults, help lists them.

usage: job_keys_test.py CUSP TOP
"""
import copy
import json
import pathlib
import subprocess
import sys
import tempfile
import tomllib
import unittest

import jsonschema

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "refactor"))
from random_job import RandomJob
sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from property_cases import share_of


def plan(*arguments):
    return subprocess.run([CUSP, "plan", *arguments], capture_output=True, text=True)


class Tables(unittest.TestCase):
    def compare(self, page):
        return subprocess.run([sys.executable, TOP / "docs/job_tables.py", CUSP, page], capture_output=True, text=True)

    def test_the_page_has_the_keys_that_cusp_knows(self):
        run = self.compare(TOP / "docs/job_file.md")
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)

    def test_a_page_that_differs_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder) / "page.md"
            text = (TOP / "docs/job_file.md").read_text()
            page.write_text(text.replace("| `peck` |", "| `pecks` |"))
            run = self.compare(page)
            self.assertEqual(run.returncode, 1)
            self.assertIn("-| `pecks`", run.stdout)
            page.write_text("no tables")
            self.assertEqual(self.compare(page).returncode, 2)


class Schema(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.schema = json.loads(plan("--schema").stdout)
        jsonschema.Draft7Validator.check_schema(cls.schema)
        cls.validator = jsonschema.Draft7Validator(cls.schema)

    def faults(self, job):
        return [error.message for error in self.validator.iter_errors(job)]

    def jobs(self):
        found = {path: tomllib.loads(path.read_text()) for path in sorted((TOP / "examples").rglob("*.toml"))}
        return {path: job for path, job in found.items() if "operation" in job}

    def test_takes_every_job_of_the_examples(self):
        self.assertGreater(len(self.jobs()), 20)
        for path, job in self.jobs().items():
            with self.subTest(path=path):
                self.assertEqual(self.faults(job), [])

    def test_takes_random_jobs(self):
        with tempfile.TemporaryDirectory() as folder:
            for seed in share_of(range(60)):
                RandomJob(seed).write(pathlib.Path(folder))
                for path in pathlib.Path(folder).glob("*.toml"):
                    faults = self.faults(tomllib.loads(path.read_text()))
                    if faults:  # a few ask for what no strategy takes
                        run = plan(path, "-o", path.with_suffix(".ngc"))
                        self.assertEqual((run.returncode, "is a key of" in run.stderr), (2, True), f"seed {seed}: {faults}")

    def test_refuses_an_unknown_key_a_wrong_type_and_a_value_out_of_range(self):
        job = tomllib.loads((TOP / "examples/plate/plate.toml").read_text())
        self.assertEqual(self.faults(job), [])

        def spoiled(change):
            other = copy.deepcopy(job)
            change(other)
            return self.faults(other)

        self.assertTrue(spoiled(lambda other: other.update(colour="red")))
        self.assertTrue(spoiled(lambda other: other["operation"][0].update(colour="red")))
        self.assertTrue(spoiled(lambda other: other["operation"][0].update(plan_tolerance="fine")))
        self.assertTrue(spoiled(lambda other: other["operation"][0].update(plan_tolerance=0)))
        self.assertTrue(spoiled(lambda other: other["operation"][0].update(strategy="pocketing")))
        self.assertTrue(spoiled(lambda other: other["stock"].update(clearance=-1)))
        self.assertTrue(spoiled(lambda other: other.pop("operation")))


class Keys(unittest.TestCase):
    """Each key of each strategy, spoiled: the schema and the reader refuse both, and the reader names the key."""
    HEAD = """[tool]
shape = "flat"
diameter = 6.0
[cutting]
feed = 1000.0
[[operation]]
strategy = "{}"
"""

    @classmethod
    def setUpClass(cls):
        schema = json.loads(plan("--schema").stdout)
        cls.validator = jsonschema.Draft7Validator(schema)
        cls.strategies = {each["if"]["properties"]["strategy"]["const"]: each["then"]["properties"]
                          for each in schema["definitions"]["operation"]["allOf"]}

    def refuse(self, cases):
        """Cases of strategy, key and value; with a share of them both are asked about that."""
        for strategy, key, value in share_of(cases):
            text = self.HEAD.format(strategy) + f"{key} = {value}\n"
            faults = list(self.validator.iter_errors(tomllib.loads(text)))
            self.assertTrue([fault for fault in faults if key in fault.absolute_path or f"'{key}'" in fault.message],
                            f"the schema takes {key} = {value} of {strategy}")
            with tempfile.TemporaryDirectory() as folder:
                job = pathlib.Path(folder) / "job.toml"
                job.write_text(text)
                run = plan(job, "-o", job.with_suffix(".ngc"))
            self.assertEqual(run.returncode, 2)
            self.assertRegex(run.stderr, rf"job.toml:\d+: operation 1: {key}: ")

    def test_refuse_a_value_of_another_kind(self):
        self.refuse([(strategy, key, "1" if form["x-kind"] == "table" else "{ a = 1 }")
                     for strategy, keys in self.strategies.items()
                     for key, form in keys.items() if key not in ("strategy", "setup")])

    def test_refuse_a_number_outside_their_range(self):
        cases = []
        for strategy, keys in self.strategies.items():
            for key, form in keys.items():
                if form.get("type") in ("number", "integer"):
                    cases.append((strategy, key, form["maximum"] + 1))
                    cases.append((strategy, key, form.get("exclusiveMinimum", form.get("minimum", 0) - 1)))
        self.assertGreater(len(cases), 200)
        self.refuse(cases)

    def test_belong_to_their_strategies(self):
        cases = []
        for strategy, keys in self.strategies.items():
            others = {key for other in self.strategies.values() for key in other} - set(keys)
            self.assertTrue(others)
            cases += [(strategy, key, 1) for key in sorted(others)]
        self.refuse(cases)


class Help(unittest.TestCase):
    def test_lists_strategies_and_tables_a_line_each(self):
        lines = plan("--help-job").stdout.splitlines()
        self.assertLessEqual(max(map(len, lines)), 110)
        for name in ("v_carve", "hull_rough", "stock", "tool", "operation", "group_by_tool"):
            self.assertEqual(len([line for line in lines if line.startswith(f"  {name} ")]), 1, name)

    def test_lists_the_keys_of_a_strategy_or_a_table_alone(self):
        text = plan("--help-job", "drill").stdout
        self.assertIn("peck", text)
        self.assertNotIn("scallop", text)
        self.assertIn("least_floor", plan("--help-job", "stock").stdout)
        self.assertIn("count", plan("--help-job", "profile").stdout)  # of its tabs

    def test_names_the_nearest_of_a_wrong_name(self):
        run = plan("--help-job", "drilling")
        self.assertEqual(run.returncode, 2)
        self.assertRegex(run.stderr, "--help-job drilling: no strategy or table of that name; the nearest are drill, ")


if __name__ == "__main__":
    CUSP, TOP = (pathlib.Path(name).resolve() for name in sys.argv[1:3])
    unittest.main(argv=sys.argv[:1])
