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


class Help(unittest.TestCase):
    def test_lists_tables_and_strategies(self):
        text = plan("--help-job").stdout
        for words in ("[stock]", "least_floor", "[tool]", "[[operation]]", "v_carve"):
            self.assertIn(words, text)

    def test_lists_the_keys_of_a_strategy_alone(self):
        text = plan("--help-job", "drill").stdout
        self.assertIn("peck", text)
        self.assertNotIn("scallop", text)

    def test_refuses_a_strategy_that_is_none(self):
        run = plan("--help-job", "drilling")
        self.assertEqual(run.returncode, 2)
        self.assertIn("--help-job drilling: no such strategy", run.stderr)


if __name__ == "__main__":
    CUSP, TOP = (pathlib.Path(name).resolve() for name in sys.argv[1:3])
    unittest.main(argv=sys.argv[:1])
