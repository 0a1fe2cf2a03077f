#!/usr/bin/env python3
"""The board's shipping image in each state, at each realtime byte and line, against a model of Grbl's documents.

usage: live_on_chip.py --cosim COSIM --board BOARD --image IMAGE.bin [--cusp CUSP] [--share K/N] [--walks N] [--seed N]
                       [-k TEXT]
The model is that of the virtual mill, tests/senders/live_model.py. --share: each Nth trial, from the Kth on.
-k: the trials whose name has the text.
"""
import argparse
import pathlib
import re
import sys

from chip import ROOT, SPINDLE_CHANNEL, Chip, CosimFailed

sys.path.insert(0, str(ROOT / "tests" / "senders"))
import live_model  # noqa: E402 (beside the other senders)


# What a state sets, and the line that undoes it.
RESTORES = {"$394": "$394=0", live_model.STOPS_AT_M1: live_model.PASSES_M1.strip(),
            live_model.LASER: live_model.NO_LASER.strip()}


class ChipDriver:
    patience = 100

    def __init__(self, machine):
        self.machine = machine
        machine.boot()
        machine.send("$X\n")
        machine.run(20)
        for line in ("$120=10", "$121=10", "$122=10", "$22=1", "$25=30", "$26=50"):
            machine.ask(line)
        self.away, self.text = 1, ""
        self.opened = False
        self.restores = set()  # what undoes the settings of the state before

    def door(self, opened):
        if opened != self.opened:
            self.machine.pin(self.machine.pins["door"], 1 if opened else 0)
            self.machine.run(10)
            self.opened = opened

    def fresh(self):
        self.door(False)
        self.machine.send(live_model.RESET)
        self.machine.run(1000, "help]\r\n")
        self.machine.ask("$X")
        for line in sorted(self.restores):
            self.machine.ask(line)
        self.restores.clear()
        self.away = -self.away

    def say(self, text):
        for line in text.splitlines(True):
            line = line.format("" if self.away > 0 else "-")
            if not line.endswith("\n") or line.startswith(live_model.UNANSWERED):
                self.send(line)
            else:
                self.machine.ask(line.strip())
            for changed, restored in RESTORES.items():
                if line.startswith(changed):
                    self.restores.add(restored)

    def send(self, text):
        self.machine.send(text)
        self.run(2)

    def run(self, milliseconds, until=""):
        self.text += self.machine.run(milliseconds, until)

    def wait(self, seconds):
        self.run(1000 * seconds)

    def observe(self):
        self.machine.changes()
        self.run(15)
        levels = self.machine.levels()
        changes = self.machine.changes()
        steps = sum(self.machine.steps(changes, axis) for axis in "XYZ")
        self.machine.send("?")
        report = self.machine.run(200, ">\r\n")
        match = re.search(r"<([A-Z][a-z]+(?::\d)?)[^>]*FS:\d+,(\d+)", report)
        if match is None:
            raise live_model.Differs(f"no report, but {report!r}")
        pins = zip("SFM", ("spindle on", "flood", "mist"))
        outputs = frozenset(letter for letter, signal in pins if levels[self.machine.pins[signal]])
        if live_model.NO_LASER.strip() in self.restores and not self.power():
            outputs -= {"S"}
        return match.group(1), outputs, steps > 0, match.group(2) != "0"

    def power(self):
        channel = SPINDLE_CHANNEL[self.machine.pins["spindle pulses"]]
        return self.machine.answered("spindle")[str(channel)]

    def heard(self):
        text, self.text = self.text, ""
        return re.sub(r"<[^>]*>\r\n", "", text)

    def heard_until(self, answer):
        if answer and answer + "\r\n" not in self.text:
            self.run(3000, answer + "\r\n")
        self.run(10)
        return self.heard()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cosim", required=True)
    parser.add_argument("--cusp")
    parser.add_argument("--board", required=True)
    parser.add_argument("--image", required=True)
    parser.add_argument("--share", default="1/1")
    parser.add_argument("--walks", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-k", default="")
    arguments = parser.parse_args()
    first, step = map(int, arguments.share.split("/"))
    trials = [trial for trial in live_model.all_trials() if trial[1] not in live_model.HOMED][first - 1::step]
    trials += [(live_model.walk, seed, 6) for seed in range(arguments.seed, arguments.seed + arguments.walks)]
    trials = [trial for trial in trials if arguments.k in str(trial[1:])]
    failed = 0
    with Chip(arguments.cosim, pathlib.Path(arguments.image), arguments.board) as machine:
        driver = ChipDriver(machine)
        for function, *words in trials:
            try:
                function(driver, *words)
            except (live_model.Differs, CosimFailed) as error:
                failed += 1
                print(f"{words}: {error}")
    print(f"{len(trials)} trials, {failed} failed; walks from seed {arguments.seed}")
    return 1 if failed or not trials else 0


if __name__ == "__main__":
    sys.exit(main())
