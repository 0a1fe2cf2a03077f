#!/usr/bin/env python3
"""A board outside the tree, from a table and five lines of CMake: built from the installed firmware, proven, and run.

usage: porting_test.py --images BUILD --cosim COSIM --cusp CUSP

The pins are those of the page that is written from the table: what a user wires by.
"""
import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path[:0] = [str(HERE.parent / "cosim"), str(HERE.parent)]
from chip import Chip  # noqa: E402

MOST_LINES = 5
options = None


def run(*command, **more):
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, **more)


class Porting(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.place = pathlib.Path(cls.folder.name)
        cls.prefix = cls.place / "installed"
        done = run("cmake", "--install", options.images, "--prefix", cls.prefix, "--component", "development")
        assert done.returncode == 0, done.stderr
        shutil.copytree(HERE / "made_up_board", cls.place / "board")
        said = cls.build(cls.place / "board", cls.place / "build")
        assert said is None, said

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def build(cls, board, build, *targets):
        """The failure in words; None if all went well."""
        for command in (("cmake", "-S", board, "-B", build, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={cls.prefix}",
                         f"-DCMAKE_TOOLCHAIN_FILE={cls.prefix}/share/cusp-firmware/cmake/toolchain-cortex-m4f.cmake"),
                        ("cmake", "--build", build, *targets)):
            done = run(*command)
            if done.returncode:
                return done.stdout[-4000:] + done.stderr[-4000:]
        return None

    def chip(self):
        return Chip(options.cosim, self.place / "build/bin/made_up_board.bin", str(self.place / "build/bin/made_up_board.md"))

    def test_it_takes_five_lines(self):
        lines = [line for line in (HERE / "made_up_board/CMakeLists.txt").read_text().splitlines() if line.strip()]
        self.assertLessEqual(len(lines), MOST_LINES)

    def test_all_proofs_of_an_image_hold(self):
        elf = self.place / "build/bin/made_up_board.elf"
        done = run(sys.executable, ROOT / "tests/checks/image.py", elf, self.place / "build", 131072, cwd=ROOT)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_its_pins_give_the_simulators_edges(self):
        done = run(sys.executable, HERE.parent / "cosim/on_chip.py", "--cosim", options.cosim, "--cusp", options.cusp,
                   "--board", self.place / "build/bin/made_up_board.md",
                   "--image", self.place / "build/bin/made_up_board.bin",
                   HERE.parent / "programs/inches.ngc", "--settings", HERE.parent / "programs/inches.settings")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_its_page_names_the_inputs(self):
        for signal, letter in (("limit X", "X"), ("limit Y", "Y"), ("limit Z", "Z"), ("probe", "P"), ("door", "D")):
            with self.subTest(signal), self.chip() as machine:
                machine.boot()
                machine.pin(machine.pins[signal], 1)
                machine.run(20)
                machine.send("?")
                self.assertIn(f"|Pn:{letter}", machine.run(50))
        with self.chip() as machine:
            machine.boot()
            machine.pin(machine.pins["emergency stop"], 1)
            self.assertIn("ALARM:10", machine.run(50))

    def test_its_page_names_the_outputs(self):
        with self.chip() as machine:
            machine.boot()
            for line, signal in (("M8", "flood"), ("M7", "mist"), ("M4S1000", "spindle on"), ("M4", "spindle reverse")):
                self.assertIn("ok", machine.ask(line))
                machine.run(5)
                self.assertEqual(machine.levels()[machine.pins[signal]], 1, signal)
            self.assertGreater(machine.answered("spindle")["1"], 0)
            self.assertEqual([machine.levels()[pin] for pin in machine.enables], [1, 1, 1])
            machine.ask("$1=255")
            machine.run(300)
            self.assertEqual([machine.levels()[pin] for pin in machine.enables], [0, 0, 0])

    def test_a_wrong_table_says_why(self):
        wrong = self.place / "wrong"
        shutil.copytree(HERE / "made_up_board", wrong)
        table = wrong / "made_up_table.hpp"
        table.write_text(table.read_text().replace("flood = {'D', 14}", "flood = {'B', 1}"))
        self.assertIn("a pin is named twice", self.build(wrong, self.place / "wrong_build", "--target", "made_up_board_page"))


def main():
    global options
    parser = argparse.ArgumentParser()
    for name in ("images", "cosim", "cusp"):
        parser.add_argument(f"--{name}", required=True, type=lambda path: pathlib.Path(path).resolve())
    options, rest = parser.parse_known_args()
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
