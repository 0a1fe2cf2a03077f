#!/usr/bin/env python3
"""An axis with two motors on a board's shipping image: both step alike, homing squares them.

usage: second_motor_on_chip.py --cosim COSIM --board BOARD --image IMAGE.bin [--cusp CUSP] [-k PATTERN]

The axis is Y. Its slides and switches are modelled here, from the pins: a step is a rising edge, the direction
is that of the direction line then, and a switch opens beyond its place.
"""
import argparse
import sys
import unittest

from chip import Chip, CosimFailed

options = None
STEPS_PER_MM = 800
SLOW = 120  # mm/min
# A contact is seen within the millisecond of a servo tick and that of the model, and two steps.
ACCURACY = 2 * SLOW / 60 / 1000 + 2 / STEPS_PER_MM
SETTINGS = (f"$22=1 $24={SLOW}.000 $25=1500.000 $26=5 $27=1.000 $121=4000.000 $801=200000.000 "
            "$793=2 $794=1").split()
LIMITS = {"first": "limit Y", "second": "limit second"}
LINES = {"first": ("Y step", "Y direction"), "second": ("second motor step", "second motor direction")}


class Gantry:
    """A chip and the slides of its two motors. Places are millimetres from where the first one started."""

    def __init__(self, machine, ahead, switches):
        self.machine = machine
        self.places = {"first": 0.0, "second": ahead}
        self.switches = switches
        self.steps = {"first": 0, "second": 0}
        self.levels = {}

    def run(self, milliseconds):
        """Millisecond by millisecond, with the switches where the slides are."""
        heard = ""
        for _ in range(milliseconds):
            heard += self.machine.run(1)
            self.follow(self.machine.changes())
            for name, pin in LIMITS.items():
                tripped = self.switches[name] is not None and self.places[name] >= self.switches[name]
                self.machine.pin(self.machine.pins[pin], int(tripped))
        return heard

    def follow(self, changes):
        for _, port, driven, high in changes:
            for name, signals in LINES.items():
                step, direction = (self.level(signal, port, driven, high) for signal in signals)
                if step:
                    self.steps[name] += 1
                    self.places[name] += (1 if direction else -1) / STEPS_PER_MM

    def level(self, signal, port, driven, high):
        """A step line: whether it rose. A direction line: its level."""
        pin = self.machine.pins[signal]
        before = self.levels.get(signal, 0)
        if port == pin[1] and driven >> int(pin[2:]) & 1:
            self.levels[signal] = high >> int(pin[2:]) & 1
        now = self.levels.get(signal, 0)
        return now if "direction" in signal else int(now and not before)

    def say(self, line, milliseconds=20000):
        self.machine.send(line + "\n")
        heard = ""
        for _ in range(milliseconds // 20):
            heard += self.run(20)
            if "ok\r\n" in heard or "error:" in heard or "ALARM:" in heard:
                return heard
        raise CosimFailed(f"{line}: not answered: {heard!r}")


def chip():
    machine = Chip(options.cosim, options.image, options.board)
    machine.command("flash 20 0.001")
    machine.boot()
    return machine


class SecondMotor(unittest.TestCase):
    def set(self, machine, *lines):
        for line in lines:
            self.assertIn("ok", machine.ask(line), line)

    def test_both_motors_step_at_the_same_time(self):
        with chip() as machine:
            self.set(machine, "$793=2", "$26=5")
            machine.changes()
            for line in ("G91 G1 X1 Y2 F1500", "Y-1", "G2 X1 Y1 I0.5 J0.5", "G0 Y1"):
                self.set(machine, line)
            machine.wait_for("Idle")
            changes = machine.changes()
            for first, second in zip(LINES["first"], LINES["second"]):
                # The first entry is the initial level of the pin.
                edges = machine.edges_of(first, changes)[1:]
                self.assertGreater(len(edges), 1)
                self.assertEqual(edges, machine.edges_of(second, changes)[1:])

    def test_the_second_motor_can_turn_the_other_way_and_rest_high(self):
        with chip() as machine:
            self.set(machine, "$793=2", "$2=2", "$8=2")
            machine.run(20)
            levels = {signal: machine.levels()[machine.pins[signal]]
                      for lines in LINES.values() for signal in lines}
            self.assertEqual(list(levels.values()), [1, 0, 1, 1])
            machine.changes()
            self.set(machine, "$J=G91 Y1 F1200")
            machine.wait_for("Idle")
            changes = machine.changes()
            edges = machine.edges_of("Y step", changes)[1:]
            self.assertEqual(len(edges), 2 * STEPS_PER_MM)
            self.assertEqual(edges, machine.edges_of("second motor step", changes)[1:])
            self.assertEqual(machine.edges_of("Y direction", changes)[-1][1], 1)
            self.assertEqual(machine.edges_of("second motor direction", changes)[-1][1], 0)

    def test_the_second_motor_stands_still_unless_a_setting_names_its_axis(self):
        with chip() as machine:
            machine.changes()
            self.set(machine, "$J=G91 Y1 F1200")
            machine.wait_for("Idle")
            changes = machine.changes()
            self.assertEqual(len({level for _, level in machine.edges_of("second motor step", changes)}), 1)

    def squared(self, ahead, switches, *more, then=None):
        """The gantry after homing, then after the line `then`; what homing said."""
        with chip() as machine:
            self.set(machine, *SETTINGS, *more, "$X")
            machine.changes()
            gantry = Gantry(machine, ahead, switches)
            heard = gantry.say("$HY")
            gantry.run(50)
            at_home = dict(gantry.places)
            if then:
                gantry.say(then)
                gantry.run(1500)
            return gantry, at_home, heard

    def test_homing_squares_two_switches_at_different_places(self):
        for ahead, second_switch in ((0.8, 3.0), (-1.2, 3.4), (0.0, 3.0)):
            with self.subTest(ahead=ahead):
                switches = {"first": 3.0, "second": second_switch}
                gantry, at_home, heard = self.squared(ahead, switches, then="G91 G1 Y-1 F1500")
                self.assertNotIn("ALARM", heard)
                # $27 from its switch each, as without squaring, and on.
                for name, switch in switches.items():
                    self.assertAlmostEqual(at_home[name], switch - 1, delta=ACCURACY)
                    self.assertAlmostEqual(gantry.places[name], switch - 2, delta=ACCURACY)

    def test_a_switch_that_never_closes_ends_in_alarm_15(self):
        for missing, other in (("second", "first"), ("first", "second")):
            with self.subTest(missing):
                gantry, _, heard = self.squared(0, {missing: None, other: 2.0}, "$347=1.000", "$348=1.500")
                self.assertIn("ALARM:15", heard)
                # 1 % of 200 mm beyond the other, then nothing.
                self.assertAlmostEqual(gantry.places[missing] - gantry.places[other], 2.0, delta=0.05)

    def test_a_skew_over_the_limit_ends_in_alarm_15(self):
        gantry, _, heard = self.squared(-2.2, {"first": 2.0, "second": 2.0}, "$347=1.000", "$348=1.500")
        self.assertIn("ALARM:15", heard)
        self.assertLess(gantry.places["second"], 2.0)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cosim", required=True)
    parser.add_argument("--board", required=True)
    parser.add_argument("--image", required=True)
    parser.add_argument("--cusp")
    options, rest = parser.parse_known_args()
    unittest.main(argv=[sys.argv[0], *rest])
