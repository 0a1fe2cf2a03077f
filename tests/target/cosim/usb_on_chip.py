#!/usr/bin/env python3
"""USB on the board's shipping image in the co-simulation, with a host that enumerates it.

usage: usb_on_chip.py --cosim COSIM --board BOARD --image IMAGE.bin --cusp CUSP [--megabyte] [-k PATTERN]
"""
import argparse
import random
import re
import sys
import unittest

from chip import CHIPS, Chip
from usb import Stalled, Usb

options = None
SETTINGS = "$0=2\n$100=800.000\n$110=9000.000\n$120=5000.000\n$800=1000000.000\n"
USB_EXCEPTIONS = {"rp2350": 16 + 14}  # elsewhere OTG FS of the STM32F4
SPEED, RATE = 150.0, 800  # mm/s, steps/mm
WITHIN = 10.0  # ms from a stop to the last edge, to the outputs' end


class Plugged(Chip):
    """A board whose plug is in and whose port is open."""

    def __init__(self, opened=True, **more):
        super().__init__(options.cosim, options.image, options.board, **more)
        self.boot()
        self.usb = Usb(self)
        self.usb.plug_in()
        if opened:
            self.usb.open()

    def check(self):
        """Besides: whatever USB does waits for the servo tick, however long it takes."""
        super().check()
        usb = f"amid_tick_{USB_EXCEPTIONS.get(CHIPS[options.board][0], 16 + 67)}"
        state = self.state()
        assert usb in state, f"no USB interrupt ended: {state}"
        assert state[usb] == 0, f"USB interrupted the servo tick {state[usb]} times"


def move(machine, settings=SETTINGS):
    for line in settings.split():
        machine.ask(line)
    machine.ask("M3 S12000")
    machine.ask("M8")
    machine.ask(f"G91 G1 X100 F{60 * SPEED}")
    machine.run(100)
    machine.changes()
    machine.run(20)


def rising(machine, changes):
    return [time for time, level in machine.edges_of("X step", changes) if level == 1]


class Enumeration(unittest.TestCase):
    def test_a_host_finds_a_serial_port_and_the_boards_name(self):
        with Plugged(opened=False) as machine:
            usb = machine.usb
            self.assertEqual(usb.device[8:12], b"\x09\x12\x01\x00")
            self.assertEqual(usb.texts["maker"], "cusp")
            self.assertEqual(usb.texts["name"], f"cusp {options.board}")
            self.assertRegex(usb.texts["serial"], r"^[0-9A-F]{24}$")
            pieces = list(usb.pieces())
            interfaces = [piece for piece in pieces if piece[1] == 4]
            self.assertEqual([bytes(piece[5:7]) for piece in interfaces], [b"\x02\x02", b"\x0a\x00"])
            union, = (piece for piece in pieces if piece[1] == 0x24 and piece[2] == 6)
            self.assertEqual(union[3:5], b"\x00\x01")
            ends = {piece[2]: piece[3] & 3 for piece in pieces if piece[1] == 5}
            self.assertEqual(ends, {0x01: 2, 0x81: 2, 0x82: 3})

    def test_odd_requests_stall_and_the_next_one_is_answered(self):
        with Plugged(opened=False) as machine:
            for request in ((0x80, 6, 0x600, 0, 10), (0x80, 6, 0x304, 0, 255), (0x40, 1), (0xC0, 32, 0, 4, 40),
                            (0x21, 0x23, 0xFFFF), (0x81, 0, 0, 2, 2), (0x00, 3, 1), (0x00, 7, 0x100, 0, 0)):
                with self.subTest(request), self.assertRaises(Stalled):
                    machine.usb.ask(*request)
                self.assertEqual(len(machine.usb.descriptor(1)), 18)

    def test_random_requests_leave_it_whole(self):
        chance = random.Random(20261128)
        print("seed 20261128", end=" ")
        with Plugged(opened=False) as machine:
            for _ in range(400):
                kind = chance.choice((0x80, 0x81, 0x82, 0xA1, 0x00, 0x01, 0x02, 0x21, chance.randrange(256)))
                request = chance.choice((0, 1, 3, 5, 6, 8, 9, 10, 11, 0x20, 0x21, 0x22, chance.randrange(256)))
                value = chance.choice((0, 1, 0x100, 0x200, 0x301, chance.randrange(65536)))
                index = chance.choice((0, 0, 1, 0x81, 1, chance.randrange(65536)))
                length = chance.choice((0, 1, 7, 18, 64, 255, chance.randrange(65536)))
                if (kind, request) == (0, 5):
                    continue  # a host that gives an address uses it
                if chance.random() < 0.1:  # given up after its first packet
                    setup = bytes((kind, request)) + b"".join(
                        number.to_bytes(2, "little") for number in (value, index, length))
                    machine.usb.command(f"begin {setup.hex()}")
                    continue
                data = bytes(chance.randrange(256) for _ in range(length)) if kind < 0x80 and length <= 64 else b""
                if kind < 0x80 and length > 64:
                    length = 0
                stage, answer = machine.usb.raw(kind, request, value, index, length, data)
                self.assertIn(stage, ("ack", "stall"), f"{kind:#x} {request:#x} {value:#x} {index:#x} {length}")
                self.assertLessEqual(len(answer), length)
            machine.usb.plug_in()
            machine.usb.open()
            self.assertIn("ok", machine.ask("G4 P0"))

    def test_a_halted_endpoint_goes_on(self):
        with Plugged() as machine:
            self.assertIn("ok", machine.ask("G4 P0"))
            for endpoint in (0x01, 0x81):
                machine.usb.ask(0x02, 3, 0, endpoint)
                self.assertEqual(machine.usb.ask(0x82, 0, 0, endpoint, 2), b"\x01\x00")
                machine.usb.ask(0x02, 1, 0, endpoint)
                self.assertEqual(machine.usb.ask(0x82, 0, 0, endpoint, 2), b"\x00\x00")
                self.assertIn("ok", machine.ask("G4 P0"))

    def test_without_its_crystal_there_is_no_usb_and_the_serial_port_answers(self):
        if CHIPS[options.board][0] == "rp2350":
            self.skipTest("the crystal of a Pico 2 is on the module")
        with Chip(options.cosim, options.image, options.board, crystal=0) as machine:
            self.assertIn("no crystal", machine.boot())
            machine.command("usb plug")
            machine.run(2)
            self.assertEqual(Usb(machine).raw(0x80, 6, 0x100, 0, 18)[0], "none")
            self.assertIn("ok", machine.ask("G4 P0"))


class Lines(unittest.TestCase):
    def test_answers_go_where_the_line_came_from(self):
        with Plugged() as machine:
            for link in ("usb", "uart", "usb", "uart"):
                machine.command(f"line {link}")
                self.assertIn("ok", machine.ask("G4 P0"))
                self.assertEqual(machine.status()[0], "Idle")

    def test_answers_of_any_length_arrive_at_once(self):
        with Plugged() as machine:
            for length in range(1, 65):
                text = "A" * length
                self.assertIn("ok", machine.ask(f"$I={text}"))
                self.assertIn(f":{text}]", machine.ask("$I", 10))

    def test_a_link_waits_for_the_others_lines_but_its_realtime_bytes_act(self):
        with Plugged() as machine:
            machine.send("G4 P0.2\nG4 P0.1\n")
            machine.run(20)
            machine.command("line uart")
            machine.send("G91 G0 X1\n!")
            self.assertEqual(machine.run(50), "")
            machine.command("line usb")
            machine.send("?")
            self.assertIn("Hold:0", machine.run(20))
            machine.send("~")
            self.assertEqual(machine.run(400).count("ok"), 2)
            machine.command("line uart")
            self.assertIn("ok", machine.run(100))
            self.assertEqual(machine.wait_for("Idle")[1][0], 1.0)

    def test_a_line_that_was_begun_gives_way_and_is_refused(self):
        with Plugged() as machine:
            machine.command("line uart")
            machine.send("G91 G0 X7")
            machine.run(20)
            machine.command("line usb")
            machine.send("G91 G0 X1\n")
            self.assertEqual(machine.run(500), "")
            self.assertIn("ok", machine.run(2500))
            self.assertEqual(machine.wait_for("Idle")[1][0], 1.0)

    def test_text_beyond_what_is_kept_is_refused_and_never_cut(self):
        with Plugged() as machine:
            machine.ask("G91")
            machine.send("G4 P0.3\n")
            machine.run(20)
            machine.command("line uart")
            machine.send("G0 X0.10\n" * 40)  # 9 bytes each; 256 are kept
            self.assertEqual(machine.run(100), "")
            heard = machine.run(1000)
            self.assertEqual(heard.count("ok"), 256 // 9)
            self.assertIn("Serial overrun", heard)
            self.assertIn("error:11", machine.ask("G4 P0"))
            self.assertIn("ok", machine.ask("G4 P0"))
            self.assertAlmostEqual(machine.wait_for("Idle")[1][0], 256 // 9 / 10)

    def test_a_stop_over_either_link_acts(self):
        for link in ("uart", "usb"):
            with self.subTest(link), Plugged() as machine:
                move(machine)
                machine.command(f"line {link}")
                machine.send("\x18")
                at = machine.state()["now"] * 1000
                machine.run(100)
                self.assertLess((rising(machine, machine.changes())[-1] - at) / 1e6, WITHIN)

    def test_a_sender_that_does_not_count_is_held_back(self):
        lines = [f"G1 X{i % 2 * 0.01:.2f} F6000" for i in range(400)]
        with Plugged() as machine:
            machine.ask("G90 G61")
            machine.send("".join(f"{line}\n" for line in lines))
            heard = machine.run(50)
            self.assertGreater(machine.state()["unsent"], 0)
            for _ in range(300):
                heard += machine.run(100)
                if heard.count("\n") >= len(lines):
                    break
            self.assertEqual(heard, "ok\r\n" * len(lines))
            self.assertEqual(machine.wait_for("Idle")[1][0], 0.01)


class Motion(unittest.TestCase):
    def leaves(self, how, setting):
        with Plugged() as machine:
            move(machine, SETTINGS + f"$796={setting}\n")
            if how == "close":
                machine.usb.close()
            else:
                machine.usb.command(how)
            machine.run(1000)
            changes = machine.changes()
            steps = machine.steps(changes)
            machine.command("line uart")
            state = machine.status()
            if setting == 0:
                self.assertEqual(state[1][0], 100.0)
                self.assertEqual(state[0], "Idle")
                return
            self.assertEqual(state[0], "Hold")
            self.assertGreater(steps, 100)
            self.assertLess(state[1][0], 60.0)
            # Back again: what was held goes on to its end.
            if how == "suspend":
                machine.usb.command("resume")
                machine.command("line usb")
            else:
                machine.usb.plug_in()
                machine.usb.open()
            self.assertEqual(machine.status()[0], "Hold")
            machine.send("~")
            self.assertEqual(machine.wait_for("Idle")[1][0], 100.0)

    def test_unplugged_in_motion_it_holds_or_runs_on(self):
        for how in ("unplug", "suspend", "close"):
            for setting in (1, 0):
                with self.subTest(how=how, setting=setting):
                    self.leaves(how, setting)

    def test_a_line_that_was_cut_by_the_plug_is_not_executed(self):
        with Plugged() as machine:
            machine.send("G91 G0 X1")
            machine.run(5)
            machine.usb.command("unplug")
            machine.run(20)
            machine.command("line uart")
            self.assertEqual(machine.run(5), "error:11\r\n")
            self.assertIn("ok", machine.ask("G4 P0"))
            machine.send("0\n")
            machine.run(50)
            self.assertEqual(machine.status()[1][0], 0.0)

    def test_an_emergency_stop_acts_though_the_link_is_flooded_or_mute(self):
        for obstacle in ("flood", "mute"):
            for what in ("emergency stop", "reset byte"):
                with self.subTest(obstacle=obstacle, what=what), Plugged() as machine:
                    move(machine)
                    if obstacle == "mute":
                        machine.command("serial mute")
                        machine.send("?" * 300)
                        machine.run(20)
                    else:
                        machine.send("?" * 4000)
                        machine.run(5)
                    at = machine.state()["now"] * 1000
                    if what == "emergency stop":
                        machine.pin(machine.pins[what], "open")
                    else:
                        machine.command("line uart")
                        machine.send("\x18")
                    machine.run(200)
                    changes = machine.changes()
                    self.assertLess((rising(machine, changes)[-1] - at) / 1e6, WITHIN)
                    for name in ("spindle on", "flood"):
                        off = [time for time, level in machine.edges_of(name, changes) if level == 0 and time >= at]
                        self.assertTrue(off, name)
                        self.assertLess((off[-1] - at) / 1e6, WITHIN, name)

    def test_a_host_that_does_not_read_hears_all_once_it_reads(self):
        with Plugged() as machine:
            move(machine)
            machine.command("serial mute")
            machine.send("G4 P0\n" * 30 + "?" * 3)
            self.assertEqual(machine.run(1500), "")
            machine.command("serial reads")
            heard = machine.run(300)
            self.assertEqual(heard.count("ok"), 30)
            self.assertEqual(machine.wait_for("Idle")[1][0], 100.0)


class Program(unittest.TestCase):
    def play(self, lines, wanted):
        """The program by counted bytes, with queries between; its edges, and all that was said, at least so much."""
        with Plugged() as machine:
            for line in SETTINGS.split():
                machine.ask(line)
            machine.run(50)
            machine.changes()
            heard, sent, open_bytes, edges = [], 0, [], []
            size = answered = asked = 0
            rest = ""
            while answered < len(lines) or size < wanted:
                while sent < len(lines) and sum(open_bytes[answered:]) + len(lines[sent]) + 1 <= 1000:
                    machine.send(lines[sent] + "\n")
                    open_bytes.append(len(lines[sent]) + 1)
                    sent += 1
                machine.send("?")
                asked += 1
                heard.append(machine.run(1))
                size += len(heard[-1])
                complete, _, rest = (rest + heard[-1]).rpartition("\n")
                answered += complete.count("ok\r")
                edges += machine.changes()
            machine.wait_for("Idle", 60000)
            edges += machine.changes()
            return "".join(heard), asked, edges

    def test_bytes_both_ways_while_a_heavy_program_plays(self):
        chance = random.Random(7)
        megabyte = 1 << 20
        wanted = megabyte if options.megabyte else megabyte // 16
        lines, ways = ["G61"], ([0], [0])
        while sum(len(line) + 1 for line in lines) < wanted:
            place = [5 * chance.randint(-40, 40) for _ in ways]  # um: whole steps
            for way, at in zip(ways, place):
                way.append(at)
            x, y = (at / 1000 for at in place)
            note = "".join(chance.choice("abcdefghijkmnopqrstuvwxyz 0123456789") for _ in range(700))
            lines.append(f"G1X{x:.3f}Y{y:.3f}F9000({note})")
        lines.append("G1X0Y0")
        heard, asked, changes = self.play(lines, wanted)
        rest = re.sub(r"<[^<>]*>\r\n", "", heard)
        reports = len(re.findall(r"<[^<>\r\n]*\|MPos:[^<>\r\n]*>\r\n", heard))
        self.assertEqual(rest, "ok\r\n" * len(lines))
        self.assertGreater(reports, asked / 4)  # two that wait are answered by one
        print(f"{sum(len(line) + 1 for line in lines)} bytes in, {len(heard)} out, {reports} reports", end=" ")
        # Every byte arrived: each move has all its steps.
        with Chip(options.cosim, options.image, options.board) as machine:
            counted = [len(machine.edges_of(f"{axis} step", changes)) // 2 for axis in "XY"]
        self.assertEqual(counted, [sum(abs(after - before) * RATE // 1000 for before, after in zip(way, way[1:]))
                                   for way in (ways[0] + [0], ways[1] + [0])])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("cosim", "board", "image", "cusp"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--megabyte", action="store_true", help="move all of it")
    options, rest = parser.parse_known_args()
    unittest.main(argv=[sys.argv[0], *rest])
