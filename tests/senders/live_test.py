#!/usr/bin/env python3
"""Each state, realtime byte and line of the live controller against a model of Grbl's documents (live_model.py).

usage: live_test.py CUSP [--mills N] [--walks N] [--seed N] [-k TEXT]
The virtual mill runs in real time: several of them share the work. -k: the trials whose name has the text.
"""
import argparse
import concurrent.futures
import re
import sys
import threading
import time

import live_model
from port import Port
from virtual_mill import VirtualMill, say

SETTINGS = "$120=10\n$121=10\n$122=10\n$20=0\n$22=1\n$25=30\n$26=50\n$341=0\n"
SECONDS = 8  # until it must be as the model says; a busy machine may need them


class MillDriver:
    patience = 400

    def __init__(self, cusp):
        self.mill = VirtualMill(cusp, tap=False, settings=SETTINGS)
        self.port = Port(self.mill.port)
        self.port.wait_for("^Grbl")
        self.away = 1
        self.opened = False

    def close(self):
        self.port.close()
        self.mill.__exit__(None, None, None)

    def door(self, opened):
        if opened != self.opened:
            self.mill.command("high door" if opened else "free door")
            self.opened = opened

    def fresh(self):
        self.door(False)
        time.sleep(0.01)
        self.port.send(live_model.RESET)
        self.port.wait_for("^Grbl")
        self.port.ask("$X")
        self.port.ask(live_model.PASSES_M1.strip())
        for line in (live_model.NO_LASER + live_model.NO_SETTER).splitlines():
            self.port.ask(line)
        self.away = -self.away

    def say(self, text):
        """Lines one by one; the spindle is up before it takes half a minute to be."""
        for line in text.splitlines(True):
            line = line.format("" if self.away > 0 else "-")
            if line == "M3S1000\n":
                self.port.ask("$394=0")
            if not line.endswith("\n") or line.startswith(live_model.UNANSWERED):
                self.port.send(line)
            else:
                self.port.ask(line.strip())
            if line == "M3S1000\n":
                self.port.ask("$394=30")
        self.port.lines.clear()

    def send(self, text):
        self.port.send(text)

    def wait(self, seconds):
        time.sleep(seconds)

    def steps(self):
        text = self.mill.command("where")
        return re.search(r"steps (\S+)", text).group(1), text

    def observe(self):
        report = self.port.state()
        before, _ = self.steps()
        time.sleep(0.02)
        after, text = self.steps()
        spindle, flood, mist = (int(word) for word in
                                re.search(r"spindle (\d+) flood (\d) mist (\d)", text).groups())
        outputs = frozenset(letter for letter, on in zip("SFM", (spindle, flood, mist)) if on)
        return (re.match(r"<([A-Z][a-z]+(:\d)?)", report).group(1), outputs, before != after,
                not re.search(r"FS:\d+,0\b", report))

    def heard(self):
        while self.port.read_line(0.005) is not None:
            pass
        lines, self.port.lines = self.port.lines, []
        return "".join(line + "\r\n" for line in lines)

    def heard_until(self, answer):
        if answer:
            self.port.wait_for("^" + re.escape(answer) + "$", SECONDS)
        else:
            time.sleep(0.05)
        return self.heard()


def attempts(arguments):
    """A state that passes by itself may be over before a busy machine has looked; the co-simulation looks in time."""
    return 3 if arguments[0] in live_model.UNSTEADY else 1


def run(cusp, trials, failures, lock):
    driver = MillDriver(cusp)
    try:
        while True:
            with lock:
                if not trials:
                    return
                function, *arguments = trials.pop()
            for attempts_left in reversed(range(attempts(arguments))):
                try:
                    function(driver, *arguments)
                    break
                except (live_model.Differs, TimeoutError) as error:
                    if not attempts_left:
                        failures.append(f"{arguments}: {error}")
    finally:
        driver.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cusp")
    parser.add_argument("--mills", type=int, default=8)
    parser.add_argument("--walks", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-k", default="")
    arguments = parser.parse_args()
    trials = live_model.all_trials()
    trials += [(live_model.walk, seed, 10) for seed in range(arguments.seed, arguments.seed + arguments.walks)]
    trials = [trial for trial in trials if arguments.k in str(trial[1:])]
    count, failures, lock = len(trials), [], threading.Lock()
    begin = time.monotonic()
    with concurrent.futures.ThreadPoolExecutor(arguments.mills) as pool:
        for future in [pool.submit(run, arguments.cusp, trials, failures, lock) for _ in range(arguments.mills)]:
            future.result()
    for failure in failures:
        say(failure)
    say(f"{count} trials, {len(failures)} failed, {time.monotonic() - begin:.0f} s; walks from seed {arguments.seed}")
    return 1 if failures or not count else 0


if __name__ == "__main__":
    sys.exit(main())
