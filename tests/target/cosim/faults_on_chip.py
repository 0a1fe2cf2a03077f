#!/usr/bin/env python3
"""Faults in use, one by one, on the board's shipping image in the co-simulation.

usage: faults_on_chip.py --cosim COSIM --board BOARD --image IMAGE.bin [--cusp CUSP] [--baud N] [-k PATTERN]
"""
import argparse
import re
import sys
import unittest

from chip import BUS, CHIPS, DRIVES, ROOT, WIRED_AS, Chip, CosimFailed

options = None
MOST_HZ = {"black_pill_f411": 96e6}  # the others: 168 MHz
# ms from the reset until the outputs are driven; the others: 1. The RP2350 waits 2 ms for its crystal first, to copy the image
# to RAM at its full clock; till then pull-downs hold the pins.
DRIVEN_WITHIN = {"pico2_terminals": 3.0}
QUICK = "$0=2\n" + "".join(f"$10{axis}=800.000\n$11{axis}=9000.000\n$12{axis}=5000.000\n$80{axis}=1000000.000\n"
                           for axis in range(3))
# Pins of the spindle's pulses: their channel, and the function that gives it to them.
PULSES = {"PA6": ("1", 2), "PA7": ("2", 2), "PB0": ("3", 2), "PB1": ("4", 2), "GP10": ("1", 4)}


def chip(**more):
    machine = Chip(options.cosim, options.image, options.board, **more)
    machine.command(f"baud {options.baud}")
    return machine


def most_steps_per_second():
    table, = (ROOT / "boards" / WIRED_AS.get(options.board, options.board)).glob("*_table.hpp")
    return int(re.search(r"kMostStepsPerSecond = (\d+);", table.read_text()).group(1))


def is_rp2350():
    return CHIPS[options.board][0] == "rp2350"


def settings_of(machine):
    """number -> value, of `$$`."""
    return dict(re.findall(r"\$(\d+)=([\d.]+)", machine.ask("$$")))


class Pins(unittest.TestCase):
    def test_inverted_steps_and_directions_rest_high(self):
        with chip() as machine:
            machine.boot()
            for line in ("$2=5", "$3=2"):
                self.assertIn("ok", machine.ask(line))
            machine.run(20)
            levels = machine.levels()
            self.assertEqual([levels[pin] for pin in machine.lines], [1, 0, 1, 0, 1, 0])
            machine.changes()
            self.assertIn("ok", machine.ask("$J=G91 X1 F3000"))
            machine.wait_for("Idle")
            edges = machine.edges_of("X step", machine.changes())
            low = [after - before for (before, level), (after, _) in zip(edges, edges[1:])
                   if level == 0]
            self.assertEqual(len(low), 800)
            self.assertEqual(set(low), {2000})  # $0, in ns

    def test_inverted_enable_coolant_and_spindle(self):
        with chip() as machine:
            machine.boot()
            enables, flood = machine.enables, machine.pins["flood"]
            self.assertEqual([machine.levels()[pin] for pin in enables], [1] * len(enables))
            self.assertEqual(machine.levels()[flood], 0)
            for line in ("$4=1", "$15=1", "$16=1"):
                self.assertIn("ok", machine.ask(line))
            self.assertEqual([machine.levels()[pin] for pin in enables], [0] * len(enables))
            self.assertEqual((machine.levels()[flood], machine.levels()[machine.pins["spindle on"]]),
                             (1, 1))
            machine.ask("M8 M3 S1000")
            machine.run(5)
            self.assertEqual((machine.levels()[flood],
                              machine.levels()[machine.pins["spindle on"]]), (0, 0))

    def test_inversion_outlives_a_reset_and_no_output_is_wrong_before_it(self):
        with chip() as machine:
            machine.boot()
            for line in ("$2=7", "$4=1", "$15=3"):
                self.assertIn("ok", machine.ask(line))
            machine.changes()
            machine.command("power cycle")
            machine.boot()
            changes = machine.changes()
            wanted = {pin: 0 for pin in machine.enables}
            wanted.update({pin: 1 for pin in (*machine.lines[:3], machine.pins["flood"])})
            for pin, level in wanted.items():
                edges = machine.edges_of(pin, changes[1:])
                self.assertEqual({at for _, at in edges} - {level}, set(), pin)
                self.assertEqual(machine.levels()[pin], level, pin)

    def test_all_outputs_are_driven_within_a_millisecond_of_the_reset(self):
        """By the instructions till then, at the 16 MHz of the reset; the model counts them at the full clock."""
        slower = 1 if is_rp2350() else MOST_HZ.get(options.board, 168e6) / 16e6
        most = DRIVEN_WITHIN.get(options.board, 1.0)
        with chip() as machine:
            for settings, high in (("", 0), ("$2=7\n$3=7\n$4=1\n$15=3\n$16=7", 1)):
                machine.boot()
                for line in settings.split():
                    self.assertIn("ok", machine.ask(line))
                machine.changes()
                began = machine.state()["now"] * 1000
                machine.command("power cycle")
                machine.boot()
                changes = machine.changes()
                names = ("spindle on", "spindle reverse", "spindle pulses", "flood", "mist")
                wanted = {machine.pins[name]: high for name in names if name in machine.pins}
                wanted.update({pin: high for pin in machine.lines})
                wanted.update({pin: 1 - high for pin in machine.enables})
                wires = [machine.pins[name] for name in (*DRIVES, *BUS[:2]) if name in machine.pins]
                wanted.update({pin: 1 for pin in wires})
                for pin, level in wanted.items():
                    driven = [time for time, port, driven, _ in changes[1:]
                              if port == pin[1] and driven >> int(pin[2:]) & 1]
                    self.assertTrue(driven, pin)
                    self.assertLessEqual((driven[0] - began) / 1e6 * slower, most, pin)
                    # Those of the pulses and of the drives go on.
                    if pin not in (machine.pins.get("spindle pulses"), *wires):
                        edges = machine.edges_of(pin, changes[1:])
                        self.assertEqual({at for _, at in edges} - {level}, set(), pin)

    def test_the_drives_are_off_at_power_up_until_something_moves(self):
        with chip() as machine:
            machine.boot()
            machine.run(100)
            changes = machine.changes()
            for pin in machine.enables:
                self.assertEqual([level for _, level in machine.edges_of(pin, changes)], [1])
            machine.ask("$J=G91 X0.1 F600")
            for pin in machine.enables:
                self.assertEqual(machine.levels()[pin], 0)

    def test_each_output_is_at_the_pin_of_the_wiring_table(self):
        with chip() as machine:
            machine.boot()
            signals = ("spindle on", "spindle reverse", "flood", "mist")

            def on():
                return [signal for signal in signals if machine.levels()[machine.pins[signal]]]

            self.assertEqual(on(), [])
            for line, wanted in (("M3 S12000", ["spindle on"]), ("M5", []), ("M8", ["flood"]), ("M9", []),
                                 ("M7", ["mist"]), ("M9", []), ("M4 S12000", ["spindle on", "spindle reverse"])):
                machine.ask(line)
                machine.run(5)
                self.assertEqual(on(), wanted, line)
            pulses = machine.pins["spindle pulses"]
            channel, function = PULSES[pulses]
            self.assertEqual(machine.answered("function")[pulses], function)
            self.assertAlmostEqual(machine.answered("spindle")[channel], 500000, delta=10)
            self.assertEqual(machine.answered("rate")["TIM3"], 1000)
            # Off at 5 %, full speed at 80 %, ten times as many of them.
            for setting in ("$34=5", "$36=80", "$33=10000"):
                machine.ask("M5")
                machine.ask(setting)
            self.assertAlmostEqual(machine.answered("spindle")[channel], 50000, delta=300)
            self.assertAlmostEqual(machine.answered("rate")["TIM3"], 10000, delta=3)
            machine.ask("M3 S24000")
            machine.run(5)
            self.assertAlmostEqual(machine.answered("spindle")[channel], 800000, delta=300)
            if "drives power" in machine.pins:
                self.assertEqual(machine.levels()[machine.pins["drives power"]], 1)

    def test_each_switch_is_at_the_pin_of_the_wiring_table(self):
        with chip() as machine:
            machine.boot()
            for signal, letter in (("limit X", "X"), ("limit Y", "Y"), ("limit Z", "Z"), ("probe", "P")):
                machine.pin(machine.pins[signal], 1)
                machine.run(20)
                machine.send("?")
                self.assertIn(f"|Pn:{letter}|", machine.run(50).replace(">", "|"), signal)
                machine.pin(machine.pins[signal], 0)
            machine.run(20)
            machine.send("?")
            self.assertNotIn("Pn:", machine.run(50))

    def test_the_start_button_ends_a_hold(self):
        with chip() as machine:
            machine.boot()
            machine.send("G91 G1 X5 F600\n")
            machine.run(100)
            machine.send("!")
            machine.wait_for("Hold")
            machine.run(200)  # it comes to rest
            pressed = machine.level_of("start")
            machine.pin(machine.pins["start"], pressed)
            machine.run(50)
            machine.pin(machine.pins["start"], 1 - pressed)
            self.assertEqual(machine.wait_for("Idle")[1][0], 5.0)


class StandStill(unittest.TestCase):
    def steps_after(self, how):
        """Steps after the core halted amid a fast jog of all axes, and those of a millisecond before."""
        with chip() as machine:
            machine.boot()
            for line in QUICK.split():
                self.assertIn("ok", machine.ask(line))
            machine.ask("$J=G91 X60 Y60 Z60 F10000")
            machine.run(300.4)
            self.assertEqual(machine.status()[0], "Jog")
            machine.changes()
            machine.run(10)
            changes = machine.changes()
            each_millisecond = [machine.steps(changes, axis) / 10 for axis in "XYZ"]
            machine.command(f"core {how}")
            machine.run(1000)
            changes = machine.changes()
            return [(machine.steps(changes, axis), before)
                    for axis, before in zip("XYZ", each_millisecond)]

    def test_a_core_that_locks_up_leaves_at_most_the_frame_that_plays(self):
        for steps, each_millisecond in self.steps_after("stop"):
            self.assertGreater(each_millisecond, 50)
            self.assertLess(steps, 1.1 * each_millisecond)

    def test_a_debugger_that_holds_the_core_holds_the_stream(self):
        if is_rp2350():
            self.skipTest("no debugger stops its PIO: as a core that locks up")
        for steps, each_millisecond in self.steps_after("halt"):
            self.assertGreater(each_millisecond, 50)
            self.assertLessEqual(steps, 1)

    def test_after_an_underrun_nothing_of_the_motion_follows(self):
        # By the moment at which the core stands still, and for how long.
        for after, still in ((200, 50), (200.4, 3), (213.7, 2.3), (190.9, 5.5)):
            with self.subTest(after=after, still=still), chip() as machine:
                machine.boot()
                machine.ask("$J=G91 X30 Y30 Z30 F3000")
                machine.run(after)
                machine.command("core stop")
                machine.run(still)
                machine.changes()
                machine.command("core go")
                heard = machine.run(200)
                self.assertIn("ALARM:3", heard)
                changes = machine.changes()
                self.assertEqual([machine.steps(changes, axis) for axis in "XYZ"], [0, 0, 0])

    def test_after_an_underrun_all_lines_step_again(self):
        with chip() as machine:
            machine.boot()
            heard, steps = machine.steps_after_an_underrun()
            self.assertIn("ALARM:3", heard)
            self.assertEqual(steps, [800, 800, 800])

    def test_a_reset_by_the_watchdog_amid_motion_is_told_and_ends_in_alarm_3(self):
        with chip() as machine:
            machine.boot()
            machine.ask("$J=G91 X60 F3000")
            machine.run(200)
            machine.command("core stop")
            heard = machine.run(7000)
            machine.command("core go")
            heard += machine.run(1000)
            self.assertEqual(machine.state()["resets"], 1)
            self.assertIn("[MSG:Reset by the watchdog]", heard)
            self.assertIn("[MSG:Reset amid motion: the position is lost]", heard)
            self.assertIn("ALARM:3", heard)
            self.assertEqual(machine.status()[0], "Alarm")

    def test_a_reset_at_rest_raises_no_alarm(self):
        with chip() as machine:
            machine.boot()
            machine.ask("$J=G91 X1 F3000")
            machine.wait_for("Idle")
            machine.run(100)
            machine.command("core stop")
            machine.run(7000)
            machine.command("core go")
            heard = machine.run(1000)
            self.assertIn("[MSG:Reset by the watchdog]", heard)
            self.assertNotIn("ALARM", heard)


class Clocks(unittest.TestCase):
    def setUp(self):
        if is_rp2350() and "planned" not in self.id():
            self.skipTest("the crystal of a Pico 2 is on the module")

    def say(self, crystal):
        with chip(crystal=crystal) as machine:
            return machine.boot(), machine.state()["core_hz"]

    def test_the_planned_crystal_runs_the_chip_and_nothing_is_said(self):
        heard, rate = self.say(None)
        self.assertNotIn("MSG", heard)
        self.assertEqual(rate, {"stm32f411": 96000000, "rp2350": 150000000}.get(CHIPS[options.board][0], 168000000))

    def test_other_crystals_neither_overclock_nor_stop_the_chip(self):
        rate = self.say(None)[1]
        for crystal in (8000000, 12000000, 16000000, 25000000):
            if crystal != CHIPS[options.board][1]:
                heard, other = self.say(crystal)
                self.assertIn("[MSG:Clock: another crystal", heard)
                self.assertEqual(other, rate)

    def test_no_crystal_is_told(self):
        self.assertIn("[MSG:Clock: no crystal", self.say(0)[0])

    def test_a_crystal_that_dies_amid_motion_stops_the_steps_and_is_told(self):
        with chip() as machine:
            machine.boot()
            machine.ask("$J=G91 X60 F3000")
            machine.run(200)
            machine.changes()
            machine.command("crystal")
            heard = machine.run(1000)
            self.assertLess(machine.steps(machine.changes()), 3)
            self.assertIn("[MSG:Fault: exception 2,", heard)
            self.assertIn("[MSG:Clock: no crystal", heard)
            self.assertIn("ALARM:3", heard)


class Serial(unittest.TestCase):
    def restore(self, machine, lines, window=128):
        """Sends lines as a sender does, `?` at 10 Hz between them; what was answered."""
        heard, waiting, at, asked, answered = "", [], 0, 0, 0
        for _ in range(8000):
            while at < len(lines) and sum(waiting) + len(lines[at]) + 1 <= window:
                machine.send(lines[at] + "\n")
                waiting.append(len(lines[at]) + 1)
                at += 1
            if asked % 50 == 0:
                machine.send("?")
            asked += 1
            heard += machine.run(2)
            count = len(re.findall(r"(?:ok|error:\d+)\r\n", heard))
            del waiting[:count - answered]
            answered = count
            if at == len(lines) and not waiting:
                return heard
        raise CosimFailed(f"not answered: {heard[-300:]!r}")

    def test_settings_are_restored_under_polling_while_sectors_are_erased(self):
        with chip() as machine:
            machine.boot()
            values = settings_of(machine)
            lines = [f"${number}={value}" for number, value in values.items()]
            lines = (lines * 4)[:100]
            heard = self.restore(machine, lines)
            self.assertEqual(re.findall(r"error:\d+", heard), [])
            self.assertEqual(len(re.findall(r"(?m)^ok\r$", heard)), 100)
            state = machine.state()
            self.assertEqual(state["lost"], 0)
            self.assertGreater(state["erases"], 0)
            self.assertEqual(settings_of(machine), values)

    def test_lines_are_taken_whole_in_the_heaviest_motion(self):
        with chip() as machine:
            machine.boot()
            steps = min(2000, most_steps_per_second() // 100)  # at 100 mm/s
            for line in (f"$100={steps}.000", f"$101={steps}.000", f"$102={steps}.000", "$110=6000.000",
                         "$111=6000.000", "$112=6000.000", "$120=5000.000", "$121=5000.000",
                         "$122=5000.000", "$800=1000000.000", "$801=1000000.000",
                         "$802=1000000.000"):
                self.assertIn("ok", machine.ask(line))
            program = ["G91 G1 F10000"]
            program += [f"X{0.4 * way} Y{0.4 * way} Z{0.4 * way}" for way in (1, -1) for _ in range(150)]
            heard = self.restore(machine, program, window=1000)
            self.assertEqual(re.findall(r"error:\d+|ALARM:\d+", heard), [])
            machine.wait_for("Idle")
            self.assertEqual(machine.state()["lost"], 0)
            self.assertEqual(machine.status()[1], (0.0, 0.0, 0.0))


class Limits(unittest.TestCase):
    def test_more_steps_than_the_board_plays_are_refused_with_both_numbers(self):
        most = most_steps_per_second()
        with chip() as machine:
            machine.boot()
            for line in ("$0=1", "$100=600.000", f"$110={most // 10}.000"):
                self.assertIn("ok", machine.ask(line))
            heard = machine.ask(f"$110={most // 10 + 1}.000")
            self.assertIn(f"[MSG:$110 x $100 asks for {most + 10} steps/s, this board plays {most}]", heard)
            self.assertIn("error:12", heard)
            self.assertEqual(settings_of(machine)["110"], f"{most // 10}.000")


class Inputs(unittest.TestCase):
    def test_nothing_wired_stops_the_machine(self):
        with chip(quiet_inputs=False) as machine:
            heard = machine.boot()
            self.assertIn("ALARM:10", heard)
            self.assertRegex(heard, r"\[MSG:Emergency stop: .* wire: .* ground .* \$14; 331 ")
            self.assertEqual(machine.status()[0], "Alarm")
            self.assertIn("error:9", machine.ask("G1 X1 F100"))

    def test_a_board_without_controls_runs_with_14_set(self):
        with chip(quiet_inputs=False) as machine:
            machine.boot()
            self.assertIn("ok", machine.ask("$14=331"))
            machine.run(20)
            machine.send("\x18")
            machine.run(50)
            machine.ask("$X")
            self.assertEqual(machine.status()[0], "Idle")

    def test_each_control_acts_when_its_wire_breaks(self):
        for signal, state in (("door", "Door"), ("emergency stop", "Alarm"),
                              ("motor fault", "Alarm"), ("hold", "Idle"), ("reset", "Alarm")):
            with self.subTest(signal), chip() as machine:
                machine.boot()
                machine.ask("$J=G91 X60 F3000")
                machine.run(100)
                machine.pin(machine.pins[signal], "open")
                machine.run(1000)
                machine.changes()
                machine.run(100)
                self.assertEqual(machine.steps(machine.changes()), 0)
                self.assertEqual(machine.status()[0], state)

    def test_an_emergency_stop_cuts_the_drives_and_needs_a_reset(self):
        with chip() as machine:
            machine.boot()
            machine.ask("$1=255")
            machine.ask("M3 S1000")
            machine.run(10)
            for pin in machine.enables:
                self.assertEqual(machine.levels()[pin], 0)
            machine.pin(machine.pins["emergency stop"], "open")
            heard = machine.run(20)
            self.assertIn("ALARM:10", heard)
            for pin in machine.enables:
                self.assertEqual(machine.levels()[pin], 1)
            self.assertEqual(machine.levels()[machine.pins["spindle on"]], 0)
            machine.send("\x18")
            self.assertIn("ALARM:10", machine.run(50))  # it is still pressed
            machine.pin(machine.pins["emergency stop"], 0)
            machine.run(20)
            machine.send("$X\n")
            machine.run(50)
            self.assertEqual(machine.status()[0], "Alarm")  # no reset yet
            machine.send("\x18")
            machine.run(50)
            machine.ask("$X")
            self.assertEqual(machine.status()[0], "Idle")


class Power(unittest.TestCase):
    def cut(self, machine, after, line):
        """Sends a line that stores, cuts the power after so many words and switches it on again; what is said."""
        machine.command(f"power fails_after {after}")
        machine.send(line + "\n")
        for _ in range(2000):  # a sector may be erased first
            machine.run(1)
            if not machine.state()["powered"]:
                break
        else:
            self.fail(f"the power did not fail after {after} words")
        machine.command("power cycle")
        return machine.boot()

    def test_a_cut_at_every_word_of_a_write_leaves_the_settings_before_it(self):
        with chip() as machine:
            machine.boot()
            self.assertIn("ok", machine.ask("$100=111.000"))
            words = machine.state()["words"]
            self.assertIn("ok", machine.ask("$100=222.000"))
            each = machine.state()["words"] - words
            self.assertGreater(each, 100)
            # The driver is one and the same on all boards: every word on one of them.
            stride = 1 if options.board == "black_pill_f411" else 13
            value = 222
            erases = machine.state()["erases"]
            for after in sorted({*range(0, each, stride), each - 1}):
                heard = self.cut(machine, after, f"$100={value + 1}.000")
                self.assertNotIn("error:7", heard, after)
                self.assertEqual(float(settings_of(machine)["100"]), value, after)
                # The interrupted write does no harm: the next one is kept, and is there after a cut.
                if after % 10 == 0:
                    value += 1
                    self.assertIn("ok", machine.ask(f"$100={value}.000"))
                    machine.command("power cycle")
                    machine.boot()
                    self.assertEqual(float(settings_of(machine)["100"]), value, after)
            if stride == 1:
                self.assertGreater(machine.state()["erases"], erases)  # both sectors were used up


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cosim", required=True)
    parser.add_argument("--board", required=True)
    parser.add_argument("--image", required=True)
    parser.add_argument("--cusp")
    parser.add_argument("--baud", type=int, default=115200)
    options, rest = parser.parse_known_args()
    unittest.main(argv=[sys.argv[0], *rest])
