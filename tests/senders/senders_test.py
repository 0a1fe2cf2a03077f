#!/usr/bin/env python3
"""Repeats what well-known senders do: how they connect, fill the buffer, hold, stop and jog.

usage: senders_test.py CUSP [unittest options]

Each sender's habits are those that its documents and source describe; docs/sending.md has the list and
the runs of the senders themselves. A tap counts every byte and answer.
"""
import os
import random
import re
import select
import sys
import threading
import time
import unittest

import side_by_side
from port import Port
from virtual_mill import VirtualMill

CUSP = sys.argv[1]
PROGRAM = (["%", "G21 G90 G17 G94", "", "G0 Z2", "; a comment", "M3 S1000"]
           + [f"G1 X{i % 9 * 0.11:.2f} Y{i % 4 * 0.13:.2f} F{900 + i % 3}" for i in range(150)]
           + ["g2 x0.3 y0.3 r2 (small letters)", "M5", "G0 X2 Y3 Z2", "M30"])
END = (2.0, 3.0, 2.0)


class SenderTest(unittest.TestCase):
    def setUp(self):
        self.mill = VirtualMill(CUSP)
        self.addCleanup(lambda: self.mill.__exit__(None, None, None))

    def open(self):
        port = Port(self.mill.port)
        self.addCleanup(port.close)
        return port

    def check_books(self):
        self.assertEqual(self.mill.account.verdict(), [])
        self.assertEqual(self.mill.account.errors, [])

    def check_end(self, port, place=END):
        port.wait_state("Idle", 60)
        self.assertEqual(self.mill.where(), place)


class StockScripts(SenderTest):
    def simple_stream(self, port):
        """Grbl's simple_stream.py: a line, its answer, the next line."""
        port.send("\r\n\r\n")
        time.sleep(2)
        port.flush_input()
        for line in PROGRAM:
            port.send(line.strip() + "\n")
            self.assertRegex(port.read_line(30), r"^(ok|\[MSG:Pgm End\])$")

    def counting_stream(self, port, strip_comments, check=False):
        """Grbl's stream.py: as many characters under way as the buffer of 128 holds."""
        port.send("\r\n\r\n")
        time.sleep(2)
        port.flush_input()
        if check:
            port.send("$C\n")
            self.assertEqual(port.wait_for("ok|error")[0], "ok")
        under_way = []
        answered = 0

        def take_answer():
            line = port.read_line(30)
            self.assertIsNotNone(line)
            if "ok" in line or "error" in line:
                self.assertEqual(line, "ok")
                under_way.pop(0)
                return 1
            return 0

        asked = time.monotonic()
        for line in PROGRAM:
            text = re.sub(r"\s|\(.*?\)", "", line).upper() if strip_comments else line.strip()
            under_way.append(len(text) + 1)
            while sum(under_way) >= 127 or port.in_waiting():
                answered += take_answer()
            port.send(text + "\n")
            if time.monotonic() - asked > 0.2:
                asked = time.monotonic()
                port.send("?")
        while under_way:
            answered += take_answer()
        self.assertEqual(answered, len(PROGRAM))

    def test_simple_stream(self):
        port = self.open()
        # Its reader takes any line for the answer, so the end's message would shift the count by one:
        # nothing follows it.
        self.simple_stream(port)
        self.check_end(port)
        self.check_books()

    def test_counting_stream(self):
        port = self.open()
        self.counting_stream(port, strip_comments=True)
        self.check_end(port)
        self.check_books()
        self.assertLessEqual(self.mill.account.most_outstanding, 128)

    def test_counting_stream_with_its_comments_and_blanks(self):
        port = self.open()
        self.counting_stream(port, strip_comments=False)
        self.check_end(port)
        self.check_books()

    def test_counting_stream_in_check_mode_moves_nothing(self):
        port = self.open()
        self.counting_stream(port, strip_comments=True, check=True)
        port.send("$C\n")
        port.wait_for("^Grbl 1.1")
        self.assertEqual(self.mill.where(), (0.0, 0.0, 0.0))
        self.check_books()


class Connections(SenderTest):
    def test_universal_gcode_sender(self):
        port = self.open()
        time.sleep(2)
        port.flush_input()
        port.send("?\n")
        self.assertRegex(port.read_line(2), r"^<Idle\|")
        self.assertEqual(port.read_line(2), "ok")
        for command in ("$I", "$$", "$G"):
            _, answer = port.ask(command, 2)
            self.assertEqual(answer, "ok")
        # It fills 128 bytes, comments stripped, and polls each 200 ms.
        self.fill(port, 128)
        # Stop: hold, wait for Hold and two equal positions, reset.
        port.send("G1 X40 F1000\n")
        port.wait_for("^ok$")
        port.wait_state("Run")
        port.send("!")
        port.wait_state("Hold:0")
        places = [re.search(r"MPos:([^|]*)", port.state()).group(1) for _ in range(2)]
        self.assertEqual(places[0], places[1])
        port.send("\x18")
        port.wait_for("^Grbl 1.1h")
        self.assertTrue(port.state().startswith("<Idle"))
        self.check_books()

    def fill(self, port, room):
        under_way = []
        asked = 0.0
        for line in PROGRAM[2:]:
            text = re.sub(r"\(.*?\)|;.*", "", line).strip()
            if not text:
                continue
            while sum(under_way) + len(text) + 1 > room:
                self.take(port, under_way)
            port.send(text + "\n")
            under_way.append(len(text) + 1)
            if time.monotonic() - asked > 0.2:
                asked = time.monotonic()
                port.send("?")
        while under_way:
            self.take(port, under_way)
        self.check_end(port)

    def take(self, port, under_way):
        line = port.read_line(30)
        self.assertIsNotNone(line)
        if line == "ok":
            under_way.pop(0)
        else:
            self.assertRegex(line, r"^(<.*>|\[.*\])$")

    def test_candle(self):
        port = self.open()
        port.send("\x18")
        port.wait_for("^Grbl 1")
        for command in ("$$", "$#", "$G"):
            self.assertEqual(port.ask(command)[1], "ok")
        self.fill(port, 127)
        # Its jog: several steps of a wheel, then cancel.
        for _ in range(5):
            port.send("$J=G21G91X4F600\n")
        port.wait_state("Jog")
        port.send("\x85")
        port.wait_state("Idle", 5)
        time.sleep(0.3)
        place = self.mill.where()
        time.sleep(0.3)
        self.assertEqual(self.mill.where(), place)
        self.assertLess(place[0], 10)
        self.check_books()

    def test_gsender(self):
        port = self.open()
        for _ in range(3):
            port.send("$I\n")
            lines, answer = [], ""
            answer, lines = port.wait_for("^ok$", 0.8)
            self.assertTrue(any("grbl" in line.lower() for line in lines))
        self.assertEqual(port.ask("$$")[1], "ok")
        # It fills 100 bytes at first and grows from Bf, and asks ? and $G all the while.
        text = [line for line in PROGRAM[2:] if line and not line.startswith(";")]
        under_way, asked = [], 0.0
        for line in text:
            if time.monotonic() - asked > 0.5:
                asked = time.monotonic()
                port.send("?")
                port.send("$G\n")
                under_way.append(3)
            while sum(under_way) + len(line) + 1 > 100:
                self.take(port, under_way)
            port.send(line + "\n")
            under_way.append(len(line) + 1)
        while under_way:
            self.take(port, under_way)
        self.check_end(port)
        port.send("G1 X30 F900\n")
        port.wait_for("^ok$")
        port.wait_state("Run")
        port.send("!")
        time.sleep(0.7)
        port.send("\x18")
        port.wait_for("^Grbl")
        self.assertTrue(port.state().startswith("<Idle"))
        self.check_books()

    def test_lightburn(self):
        port = self.open()
        port.wait_for("^Grbl 1.1")
        for command in ("$I", "$$", "$#"):
            self.assertEqual(port.ask(command)[1], "ok")
        job = (["G00 G17 G40 G21 G54", "G90", "M4", "M8", "G0 X1.5Y1.5", "G1 X2.5S300F900"]
               + [f"X{1.5 + i % 10 * 0.1:.1f}Y{1.5 + i * 0.01:.2f}S{i % 5 * 100}" for i in range(100)]
               + ["M9", "G1 S0", "M5", "G90", "G0 X0Y0", "M2"])
        under_way = []
        for line in job:
            while sum(under_way) + len(line) + 1 > 127:
                self.take(port, under_way)
            port.send(line + "\n")
            under_way.append(len(line) + 1)
        while under_way:
            self.take(port, under_way)
        self.check_end(port, (0.0, 0.0, 0.0))
        # Framing by jogs, then stop.
        port.send("$J=G91X10F1000\n$J=G91Y10F1000\n")
        port.wait_state("Jog")
        port.send("\x85")
        port.wait_state("Idle")
        self.check_books()

    def test_a_sender_that_comes_again_finds_the_controller_as_it_was(self):
        with Port(self.mill.port) as port:
            port.wait_for("^Grbl")
            port.ask("G1 X5 F6000")
        for _ in range(5):
            with Port(self.mill.port) as port:
                self.assertEqual(port.ask("")[1], "ok")
                port.wait_state("Idle")
        self.assertEqual(self.mill.where()[0], 5.0)


    def test_no_line_of_a_sender_that_comes_at_once_is_lost(self):
        """The controller once looked for a sender, then read: 4 of 3000 lines had no answer."""
        with VirtualMill(CUSP, tap=False) as mill:
            threading.Thread(target=mill.process.stdout.read, daemon=True).start()
            seed = 1
            random_number = random.Random(seed)
            lost = 0
            for _ in range(1000):
                port = os.open(mill.port, os.O_RDWR | os.O_NOCTTY)
                os.write(port, b"\n")
                heard = b""
                while b"ok" not in heard and select.select([port], [], [], 2)[0]:
                    heard += os.read(port, 4096)
                lost += b"ok" not in heard
                os.close(port)
                end = time.perf_counter() + 0.002 * random_number.random()
                while time.perf_counter() < end:
                    pass
            self.assertEqual(lost, 0, f"seed {seed}")


class Answers(SenderTest):
    """One answer for each line end, whatever the line."""

    def settle(self, port, answers):
        end = time.monotonic() + 20
        while self.mill.account.answers < answers and time.monotonic() < end:
            port.read_line(0.05)
        time.sleep(0.2)
        while port.in_waiting():
            port.read_line(0.05)
        self.assertEqual(self.mill.account.answers, answers)
        self.assertEqual(self.mill.account.verdict(), [])

    def test_blank_lines_and_both_line_ends(self):
        port = self.open()
        port.send("\r\n\r\n\n\n\r\r   \n\t\n(comment)\n;\n%\n/\nG21\r\nG90\rG0X1\n")
        self.settle(port, 18)

    def test_lines_that_are_too_long(self):
        port = self.open()
        self.mill.account.room = 2000
        port.send("G1X" + "1" * 400 + "F100\n" + "(" + "x" * 400 + ")\n"
                  + "$" + "A" * 300 + "\n" + "G0" + " " * 500 + "X1\n")
        self.settle(port, 4)
        self.assertEqual(self.mill.account.errors, ["error:11", "error:11"])

    def test_commands_in_motion(self):
        port = self.open()
        port.send("G1X8F600\n$$\n$#\n$I\n$N\n$G\n$X\n\n$H\n$C\n$110=1000\n$J=G91X1F100\n$SLP\n$RST=*\n"
                  "$N0=G21\n$Q\n$\n$99=\nG4P0.1\n")
        self.settle(port, 19)
        self.assertEqual(self.mill.account.errors.count("error:8"), 13)

    def test_a_line_that_a_reset_cuts_off(self):
        port = self.open()
        port.send("G1X30F600\n")
        port.wait_for("^ok$")
        port.wait_state("Run")
        port.send("G4P1\nG1X3\nG1X5Y\x18")
        port.wait_for("^Grbl")
        port.send("$X\n")
        port.wait_for("^ok$")
        port.send("G0X1\n")
        port.wait_for("^ok$")
        port.wait_state("Idle")
        self.assertEqual(self.mill.account.verdict(), [])
        self.assertEqual(self.mill.account.resets, 1)

    def test_what_follows_a_reset_at_once_is_answered(self):
        port = self.open()
        port.ask("")
        port.send("G21\n\x18$X\n\n$G\n")
        self.settle(port, 4)
        self.assertEqual(self.mill.account.cut_off, 1)

    def test_questions_amid_lines(self):
        port = self.open()
        for _ in range(50):
            port.send("G0?X1?Y?2\n?$?G\n?")
        self.settle(port, 100)
        self.assertGreater(self.mill.account.reports, 10)

    def test_each_realtime_byte_answers_nothing(self):
        port = self.open()
        port.ask("")
        said = self.mill.account.answers
        for byte in range(0x80, 0x100):
            port.send(bytes([byte]))
        time.sleep(0.3)
        port.send("~\n")
        self.settle(port, said + 1)

    def test_more_than_the_buffer_holds_is_flagged_and_answered(self):
        port = self.open()
        port.send("G1X5F300\n")
        port.wait_for("^ok$")
        port.send("!")
        port.wait_state("Hold")
        self.mill.account.room = 10 ** 6
        for _ in range(400):
            port.send("G4P0.001\n")
        time.sleep(0.3)
        port.send("~")
        self.settle(port, 401)
        self.assertIn("[MSG:Receive buffer overflow: bytes lost]", self.mill.account.heard)
        self.assertGreater(self.mill.account.errors.count("error:11"), 200)

    def test_the_whole_buffer_is_usable(self):
        port = self.open()
        port.send("G1X5F300\n")
        port.wait_for("^ok$")
        port.send("!")
        port.wait_state("Hold:0")
        port.send("G4P0.0\n" * 146 + "\n\n")
        self.assertIn(",0|", port.state())
        port.send("~")
        self.settle(port, 149)
        self.assertEqual(self.mill.account.errors, [])
        self.assertEqual(self.mill.account.most_outstanding, 1024)

    def test_alarms_and_what_follows_them(self):
        port = self.open()
        port.ask("$21=1")
        port.send("G1X10F300\nG1X20\nG4P0\n")
        port.wait_state("Run")
        self.mill.command("high x")
        port.wait_for("^ALARM:1$")
        port.send("G0X1\n$X\n")
        time.sleep(0.3)
        self.mill.command("free x")
        port.send("\x18")
        port.wait_for("^Grbl")
        self.assertEqual(port.ask("G0X1")[1], "error:9")
        self.assertEqual(port.ask("$X")[1], "ok")
        self.assertEqual(port.ask("G0X0")[1], "ok")
        port.wait_state("Idle")
        self.assertEqual(self.mill.account.verdict(), [])

    def test_a_tool_is_changed_and_touched_off_amid_a_program(self):
        """A sender that fills the buffer, asks all the while and knows no more of it than a hold."""
        port = self.open()
        for setting in ("$22=1", "$24=300", "$25=3000", "$26=1", "$341=3", "$342=40", "$343=60", "$344=600"):
            self.assertEqual(port.ask(setting)[1], "ok")
        self.assertEqual(port.ask("T1M6")[1], "error:46")
        self.assertEqual(port.ask("$H", 30)[1], "ok")
        self.mill.command("plate 2")  # 30 mm below the top: the mill was at -32
        program = ["G10 L2 P9 X-20 Y-20 Z-15", "M3 S1000", "G0 X-10 Y-10 Z-5", "T1 M6", "G1 X-12 F3000", "M5",
                   "T2 M6", "G43 H2", "G1 Z-5", "X-10", "M30"]
        port.send("".join(line + "\n" for line in program))
        for plate in ("plate 2", "plate -1.5"):
            port.wait_state("Hold:0", 30)
            self.assertIn("spindle 0", self.mill.command("where"))
            self.assertEqual(self.mill.command(plate), "ok")
            port.send("~")
            while port.state().startswith("<Hold"):
                time.sleep(0.02)
        port.wait_for(r"^\[MSG:Pgm End\]$", 60)
        self.settle(port, 10 + len(program))
        self.assertEqual(self.mill.account.errors, ["error:46"])
        said = self.mill.account.heard
        self.assertTrue(any(re.match(r"\[MSG:Tool T2: length -3\.(49|50)\d\]", line) for line in said), said)
        x, y, z = re.search(r"iron (\S+),(\S+),(\S+) ", self.mill.command("where")).groups()
        self.assertAlmostEqual(float(x), -10, delta=0.01)
        self.assertAlmostEqual(float(z), -8.5, delta=0.01)


if __name__ == "__main__":
    side_by_side.main(4)
