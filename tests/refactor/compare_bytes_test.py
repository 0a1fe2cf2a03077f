#!/usr/bin/env python3
"""Shows that compare_bytes.py passes equal programs and fails on one altered character of each output.

usage: compare_bytes_test.py CUSP
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

COMPARE = pathlib.Path(__file__).resolve().parent / "compare_bytes.py"
CUSP = pathlib.Path(sys.argv.pop()).resolve()
# Plans as CUSP does, then alters one file or message of one command.
ALTERED = """#!/usr/bin/env python3
import pathlib, subprocess, sys
status = subprocess.call([{cusp!r}, *sys.argv[1:]])
if sys.argv[1] == {command!r} and {option!r} in sys.argv:
    file = pathlib.Path(sys.argv[sys.argv.index({option!r}) + 1])
    if file.exists():
        text = file.read_text()
        assert {old!r} in text, text
        file.write_text(text.replace({old!r}, {new!r}, 1))
elif sys.argv[1] == {command!r} and not {option!r}:
    print("one more message")
sys.exit(status)
"""
SEED = "15"  # hull_rough: planned in 0.02 s, 42 s of motion
SHORT = "18"  # contour_pocket: 14 s of motion, so it is traced too


class CompareBytes(unittest.TestCase):
    def compare(self, new, seed, *options):
        run = subprocess.run([sys.executable, COMPARE, CUSP, new, "--no-examples", "--first", seed, "--count", "1", *options],
                             capture_output=True, text=True)
        return run.returncode, run.stdout + run.stderr

    def assert_found(self, command, option, old, new, named, seed=SEED):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder, "cusp")
            program.write_text(ALTERED.format(cusp=str(CUSP), command=command, option=option, old=old, new=new))
            program.chmod(0o755)
            status, text = self.compare(program, seed)
        self.assertEqual(status, 1, text)
        self.assertIn(named, text)
        self.assertIn("1 differ", text)

    def test_a_program_equals_itself_trace_included(self):
        status, text = self.compare(CUSP, SHORT)
        self.assertEqual(status, 0, text)
        self.assertIn("1 random jobs", text)
        self.assertIn("1 traced", text)
        self.assertIn("byte-equal", text)

    def test_g_code_that_differs_in_a_digit_is_found(self):
        self.assert_found("plan", "-o", "G1 X", "G1 X1", "G-code, line")

    def test_statistics_that_differ_are_found(self):
        self.assert_found("plan", "--stats", '"passes": ', '"passes": 1', "statistics of plan, line")

    def test_a_key_that_is_added_is_found(self):
        self.assert_found("verify", "--stats", "{", '{"new": 1, ', "figures of verify: keys added: ['new'], gone: []")

    def test_a_message_more_is_found(self):
        self.assert_found("plan", "", "", "", "messages of plan, line")

    def test_every_output_that_differs_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder, "cusp")
            program.write_text(ALTERED.format(cusp=str(CUSP), command="plan", option="-o", old="G1 X", new="G1 X1"))
            program.chmod(0o755)
            status, text = self.compare(program, SHORT)
        self.assertEqual(status, 1, text)
        self.assertIn("G-code, line", text)
        self.assertRegex(text, "; also: .*pulse trace")

    def test_a_message_more_is_passed_over_on_request(self):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder, "cusp")
            program.write_text(ALTERED.format(cusp=str(CUSP), command="plan", option="", old="", new=""))
            program.chmod(0o755)
            status, text = self.compare(program, SEED, "--no-messages")
        self.assertEqual(status, 0, text)

    def test_figures_of_verify_that_differ_are_found(self):
        self.assert_found("verify", "--stats", '"cells": ', '"cells": 1', "figures of verify, line")

    def test_a_pulse_trace_that_differs_is_found(self):
        self.assert_found("sim", "--vcd", "#1", "#2", "pulse trace, line", SHORT)

    def test_times_and_the_version_are_not_compared(self):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder, "cusp")
            program.write_text(ALTERED.format(cusp=str(CUSP), command="plan", option="--stats", old='"planning_s": ',
                                              new='"planning_s": 9'))
            program.chmod(0o755)
            status, text = self.compare(program, SEED)
        self.assertEqual(status, 0, text)


if __name__ == "__main__":
    unittest.main()
