#!/usr/bin/env python3
"""The virtual mill itself: every command of its control port, and its line over TCP.

usage: virtual_mill_test.py CUSP [unittest options]
"""
import subprocess
import sys
import time
import unittest

from port import Port
from virtual_mill import VirtualMill, free_port

CUSP = sys.argv[1]


class ControlPort(unittest.TestCase):
    """Every command of docs/sending.md."""

    def setUp(self):
        self.mill = VirtualMill(CUSP, tap=False)
        self.addCleanup(lambda: self.mill.__exit__(None, None, None))

    def do(self, text):
        self.assertEqual(self.mill.command(text), "ok", text)

    def test_where_tells_of_the_iron(self):
        self.assertEqual(self.mill.command("where"),
                         "iron -120.0000,-80.0000,-32.0000 steps 0,0,0 inputs 0 spindle 0 flood 0 "
                         "mist 0 power on")

    def test_inputs_read_as_they_are_told_to(self):
        with Port(self.mill.port) as port:
            port.wait_for("^Grbl")
            for name, letter in zip("x y z probe hold".split(), "XYZPH"):
                self.do("high " + name)
                time.sleep(0.02)
                self.assertRegex(port.state(), rf"\|Pn:{letter}[|>]")
                self.do("low " + name)
                time.sleep(0.02)
                self.assertNotIn("|Pn", port.state())
                self.do("free " + name)
            self.do("high door")
            port.wait_for("Check Door")
            self.assertIn("Door:1", port.state())
            self.do("free door")
            self.do("high reset")
            port.wait_for("^Grbl")
            self.do("free reset")

    def test_the_plate_is_touched(self):
        self.do("plate -1.5")
        with Port(self.mill.port) as port:
            port.wait_for("^Grbl")
            lines, answer = port.ask("G38.2 Z-5 F600")
            self.assertEqual(answer, "ok")
            self.assertRegex(lines[0], r"^\[PRB:0.000,0.000,-1\.5\d\d:1\]$")

    def test_a_lost_frame_is_an_alarm(self):
        with Port(self.mill.port) as port:
            port.wait_for("^Grbl")
            port.ask("G1 X20 F1000")
            port.wait_state("Run")
            time.sleep(0.2)  # steps in every frame
            self.do("lose-frame")
            port.wait_for("^ALARM:3$")

    def test_an_overrun_is_told(self):
        with Port(self.mill.port) as port:
            port.wait_for("^Grbl")
            self.do("overrun")
            port.send("G21\n")
            port.wait_for("Serial overrun")
            port.wait_for("^error:11$")

    def test_power_goes_and_comes(self):
        with Port(self.mill.port) as port:
            port.wait_for("^Grbl")
            self.do("power off")
            self.assertIn("power off", self.mill.command("where"))
            self.do("power on")
            port.wait_for("^Grbl")
            self.do("cut 2")
            port.send("$110=1234\n")
            time.sleep(0.3)
            self.assertIn("power off", self.mill.command("where"))
            self.do("power on")
            port.wait_for("^Grbl")
            self.assertIn("[MSG:Settings: an interrupted write was dropped]",
                          [port.read_line(1) for _ in range(2)])

    def test_the_plug_is_pulled(self):
        with Port(self.mill.port) as port:
            port.wait_for("^Grbl")
            self.do("unplug")
            with self.assertRaises((OSError, TimeoutError)):
                port.send("?")
                port.wait_for("^<", 1)
        self.do("plug")
        with Port(self.mill.port) as port:
            port.wait_for("^Grbl")

    def test_the_line_goes_bad_and_good(self):
        with Port(self.mill.port) as port:
            port.wait_for("^Grbl")
            self.do("line loss=1")
            port.send("?")
            self.assertIsNone(port.read_line(0.3))
            self.do("line")
            self.assertTrue(port.state().startswith("<Idle"))

    def test_what_is_no_command_is_said_so(self):
        for text in ("dance", "high", "high nose", "plate", "line noise=2", "power", "cut -1"):
            self.assertEqual(self.mill.command(text), "unknown: " + text)


class OverTcp(unittest.TestCase):
    def test_a_socket_serves_as_a_terminal_does(self):
        number = free_port()
        server = subprocess.Popen([CUSP, "sim", "--serve", "--tcp", f"127.0.0.1:{number}"],
                                  stdout=subprocess.PIPE, text=True)
        try:
            self.assertIn("serving on", server.stdout.readline())
            for _ in range(20):  # at once again after each hang-up
                with Port(f"tcp:127.0.0.1:{number}") as port:
                    port.wait_for("^Grbl 1.1h", 5)
                    self.assertEqual(port.ask("G1 X1 F6000")[1], "ok")
            with Port(f"tcp:127.0.0.1:{number}") as port:
                port.wait_for("^Grbl")
                with Port(f"tcp:127.0.0.1:{number}") as second:
                    self.assertIsNone(second.read_line(2))
                self.assertEqual(port.ask("$G")[1], "ok")
                self.assertIn("MPos:1.000,0.000,0.000", port.wait_state("Idle"))
        finally:
            server.terminate()
            server.wait(10)
            server.stdout.close()


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]] + sys.argv[2:])
