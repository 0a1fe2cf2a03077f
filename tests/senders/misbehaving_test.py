#!/usr/bin/env python3
"""Bytes of any kind: `cusp stream` against a controller that misbehaves, and programs with any bytes.

usage: misbehaving_test.py CUSP [--seeds N]
A controller behind a pseudo-terminal answers as a seed says: with garbage, NUL, lines without end, carriage returns
alone, numbers out of range, or not at all. Whatever it does, the transfer ends by itself with status 0 or 1, without a
crash, and the record is JSON.
"""
import concurrent.futures
import json
import os
import pathlib
import pty
import random
import select
import subprocess
import sys
import tempfile
import time
import tty
import unittest

CUSP = str(pathlib.Path(sys.argv[1]).resolve())
SEEDS = int(sys.argv[sys.argv.index("--seeds") + 1]) if "--seeds" in sys.argv else 48
PROGRAM = b"G21 G90\n" + b"".join(b"G1 X%d F600 (90\xb0)\n" % (k % 7) for k in range(60)) + b"M30\n"
STATUS = b"<Idle|MPos:%s|FS:0,0|Ln:%d>\r\n"
LIMIT_S = 150


def garbage(chance, count):
    return bytes(chance.randrange(256) for _ in range(chance.randrange(count)))


class Controller:
    """Answers what comes until the sender is gone."""

    HABITS = ("sound", "noise", "nul", "carriage", "long", "numbers", "silent", "mute", "refusing", "alarm", "restart",
              "flood")

    def __init__(self, seed):
        self.chance = random.Random(seed)
        self.habit = self.HABITS[seed % len(self.HABITS)]
        self.master, slave = pty.openpty()
        tty.setraw(slave)
        self.slave, self.port = slave, os.ttyname(slave)
        self.answered, self.line = 0, b""

    def close(self):
        os.close(self.master)
        os.close(self.slave)

    def status(self):
        if self.habit == "numbers":
            return self.chance.choice((b"<Idle|MPos:1e300,nan,inf|FS:-1,99999999999|Ln:-7>\r\n",
                                       b"<Idle|MPos:1,2|Bf:-9,x|Ov:999999999999|Ln:4294967296>\r\n", b"<>\r\n", b"<Idle\r\n",
                                       b"<Idle|WCO:9e99,0,0|WPos:-9e99,0,0>\r\n", STATUS % (b"0,0,0", 1)))
        if self.habit == "mute" and self.answered > 20:
            return b""
        return STATUS % (b"1.000,2.000,3.000", self.answered)

    def answer(self):
        self.answered += 1
        late = self.answered > 12
        chance, habit = self.chance, self.habit
        if habit == "noise":
            return garbage(chance, 40).replace(b"\n", b"") + b"\n" * chance.randrange(2) + b"ok\n"
        if habit == "nul":
            return b"\0" * chance.randrange(5) + b"o\0k\x80\r\n"
        if habit == "carriage":
            return b"ok\r"
        if habit == "long":
            return b"[MSG:" + b"x" * chance.randrange(100000) + b"]\r\nok\r\n"
        if habit == "numbers" and chance.random() < 0.2:
            return chance.choice((b"error:99999999999999\n", b"ALARM:-\n", b"[OPT:V,15,99999999999999999999]\n",
                                  b"$110=1e30\n$100=nan\n", b"[G54:1e300,nan,x]\n")) + b"ok\n"
        if late and habit in ("silent", "mute", "flood"):
            return b""
        if late and habit == "refusing":
            return b"err\xffor:2\x000\r\n"
        if late and habit == "alarm":
            return b"ALARM:1\xff\r\n"
        if late and habit == "restart":
            return b"\xff\xfe\0Grbl 1.1h ['$' for help]\r\n"
        return b"ok\r\n"

    def take(self, data):
        out = b""
        for byte in data:
            if byte == ord("?"):
                out += self.status()
            elif byte == 0x18:
                out += b"\r\nGrbl 1.1h ['$' for help]\r\n"
            elif byte == 0x0A:
                out += self.answer()
                self.line = b""
        return out


class Misbehaving(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def transfer(self, seed, name=b"p.ngc", program=PROGRAM, options=()):
        """Seed, exit status, what it said, the record (None: there is none) and what went to the controller."""
        folder = self.folder / str(seed)
        folder.mkdir()
        file = os.path.join(os.fsencode(folder), name)
        with open(file, "wb") as out:
            out.write(program)
        controller = Controller(seed)
        process = subprocess.Popen([CUSP, "stream", controller.port, file, "--no-estimate", *options],
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
        deadline = time.monotonic() + LIMIT_S
        with concurrent.futures.ThreadPoolExecutor(1) as reader:
            said = reader.submit(process.stdout.read)
            while process.poll() is None and time.monotonic() < deadline:
                ready, _, _ = select.select([controller.master], [], [], 0.02)
                out = controller.take(os.read(controller.master, 4096)) if ready else b""
                if controller.habit == "flood" and controller.answered > 12:
                    out += garbage(controller.chance, 4000)
                if out:
                    os.write(controller.master, out)
            status = process.poll()
            process.kill()
            text = said.result()
            process.stdout.close()
        process.wait()
        controller.close()
        record = None
        if os.path.exists(file + b".resume"):
            with open(file + b".resume", "rb") as kept:
                record = json.loads(kept.read().decode("utf-8"))
        return status, text, record, controller

    def test_no_controller_makes_the_sender_crash_or_hang(self):
        with concurrent.futures.ThreadPoolExecutor(24) as pool:
            runs = {seed: pool.submit(self.transfer, seed) for seed in range(SEEDS)}
        for seed, run in runs.items():
            status, text, record, controller = run.result()
            about = f"seed {seed}, {controller.habit}: status {status}: {text[-300:]}"
            self.assertIn(status, (0, 1), about)
            if controller.habit in ("sound", "nul", "carriage", "long"):
                self.assertEqual(0, status, about)
                self.assertIsNone(record, about)
            if controller.habit in ("silent", "mute", "refusing", "alarm", "restart", "flood"):
                self.assertEqual(1, status, about)
                self.assertIsNotNone(record, about)
                self.assertTrue(record["ending"], about)

    def test_a_refused_line_of_any_bytes_is_told_and_recorded(self):
        # seed 8 refuses the tenth line
        for number, comment in enumerate((b"90\xb0", b"\xff\xfe\x80", bytes(range(128, 256)), b"\0\x01\x7f")):
            program = b"G21 G90\n" + 30 * (b"G1 Q5 (" + comment + b")\n") + b"M30\n"
            status, text, record, _ = self.transfer(8 + 12 * number, name=b"p\xe4\xff.ngc", program=program)
            self.assertEqual(1, status, text)
            self.assertIn(b"error:20", text)
            self.assertIn("error:20", record["ending"])

    def test_what_the_controller_would_take_for_a_command_is_not_sent(self):
        for number, byte in enumerate((b"!", b"~", b"?", b"\x84", b"\xb0", "\u201c".encode())):
            program = b"G21 G90\nG1 X1 F600\nG1 X2 " + byte + b"\nG1 X3\n"
            status, text, record, controller = self.transfer(12 * number, program=program)
            self.assertEqual(1, status, text)
            self.assertIn(b"p.ngc:3: error:1: ", text)
            self.assertIn("p.ngc:3: error:1: ", record["ending"])
            ran = subprocess.run([CUSP, "sim", self.folder / str(12 * number) / "p.ngc", "--stats", self.folder / "s.json"],
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
            self.assertEqual(1, ran.returncode, ran.stdout)
            self.assertEqual([(3, 1)], [(fault["line"], fault["code"]) for fault in
                                        json.loads((self.folder / "s.json").read_text("utf-8"))["errors"]])

    def test_control_characters_are_left_out(self):
        program = b"\0\0\0G21\x7f G90\r\n\x0cG1 X1\0 F600\r\nM30\r\n\x1a"
        status, text, _, _ = self.transfer(0, program=program)
        self.assertEqual(0, status, text)
        ran = subprocess.run([CUSP, "sim", self.folder / "0" / "p.ngc"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                             check=False)
        self.assertEqual(0, ran.returncode, ran.stdout)

    def test_sim_and_stream_end_where_the_program_ends(self):
        programs = [(b"G21 G90\nG1 X3 F600\nM30\nG1 X9\n", 3), (b"G21 G90\nG1 X3 F600\nm02\nthis is no G-code\n", 3),
                    (b"%\nG21 G90\nG1 X3 F600\n%\nG1 X9\nnotes\n", 2), (b"G21 G90\nG1 X3 F600 M2 (end)\nG1 X9\n", 2),
                    (b"G21 G90\nG1 X3 F600\n%\nG1 X9\n", 3), (b"G21\nG90 G1 X3 F600 (M30)\nG1 X9 ; M2\nM030\nX\n", 4)]
        for number, (program, lines) in enumerate(programs):
            status, text, _, _ = self.transfer(12 * number, program=program)
            self.assertEqual(0, status, (program, text))
            self.assertIn(b"%d lines sent, %d answered" % (lines, lines), text, program)
            file = self.folder / str(12 * number) / "p.ngc"
            stats = self.folder / "s.json"
            ran = subprocess.run([CUSP, "sim", file, "--stats", stats], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                 check=False)
            self.assertEqual(0, ran.returncode, ran.stdout)
            end = json.loads(stats.read_text("utf-8"))["end_mpos_mm"][0]
            self.assertAlmostEqual(9 if b"X9" in program and lines in (4,) or number == 4 else 3, end, places=3)
            fitted = self.folder / "f.ngc"
            ran = subprocess.run([CUSP, "fit", file, "-o", fitted, "--tolerance", "0.01"], stdout=subprocess.PIPE,
                                 stderr=subprocess.STDOUT, check=False)
            self.assertEqual(0, ran.returncode, (program, ran.stdout))

    def test_json_is_utf8_whatever_names_and_texts_hold(self):
        file = os.path.join(os.fsencode(self.folder), b"n\xe4\xff.ngc")
        with open(file, "wb") as out:
            out.write(b"G21 G90\nG1 X1 F600\nG1 Q5 (90\xb0)\nM30\n")
        stats = self.folder / "s.json"
        for command in (["sim", file], ["fit", file, "-o", self.folder / "f.ngc", "--tolerance", "0.01"]):
            subprocess.run([CUSP, *command, "--stats", stats], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
            if stats.exists():
                json.loads(stats.read_bytes().decode("utf-8"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
