#!/usr/bin/env python3
"""bCNC's own Sender class, without its windows, against a virtual mill with its line tapped.

usage: bcnc_run.py CUSP [BCNC]

BCNC is the folder with Sender.py: /usr/share/bcnc/bCNC of Debian's package bcnc. Exit status: 0 all
steps and the tap's counts are right, 1 not, 77 there is no bCNC.
"""
import os
import pathlib
import sys
import tempfile
import time

from virtual_mill import VirtualMill, say

BCNC = sys.argv[2] if len(sys.argv) > 2 else "/usr/share/bcnc/bCNC"
if not os.path.exists(f"{BCNC}/Sender.py"):
    say(f"no bCNC at {BCNC}")
    sys.exit(77)
HOME = tempfile.TemporaryDirectory()
os.environ["HOME"] = HOME.name
for part in ("", "lib", "plugins", "controllers"):
    sys.path.append(str(pathlib.Path(BCNC) / part))
import Utils  # noqa: E402

Utils.loadConfiguration()
from CNC import CNC, WAIT  # noqa: E402
from Sender import Sender  # noqa: E402


class Headless(Sender):
    """The parts that bCNC's window adds to its Sender."""

    def disable(self):
        pass

    def event_generate(self, *_, **__):
        pass

    def run_lines(self, lines):
        self.cleanAfter = True
        CNC.vars["errline"] = ""
        self.initRun()
        self._runLines = sys.maxsize
        self._gcount = 0
        CNC.vars["running"] = True
        CNC.vars["_OvChanged"] = True
        count = 1
        for line in CNC.compile(lines):
            if line is not None:
                self.queue.put(line + "\n" if isinstance(line, str) else line)
                count += 1
        self._runLines = count
        self.queue.put((WAIT,))

    def watch(self):
        """One cycle of the window's monitor: a run is over when all its lines are counted."""
        while not self.log.empty():
            self.log.get()
        if self.running and self._gcount >= self._runLines:
            self.runEnded()


def state():
    return CNC.vars["state"]


# Waits are generous: a sender that shares two cores with other tests may stall for seconds. So
# the motions that are to be seen under way last longer than that, and are cut short.
SOON = 30


class Session:
    def __init__(self, mill):
        self.mill = mill
        self.sender = Headless()
        self.slid = 0.0
        CNC.vars["_OvFeed"] = CNC.vars["_OvRapid"] = CNC.vars["_OvSpindle"] = 100

    def until(self, what, condition, seconds):
        end = time.monotonic() + seconds
        while not condition():
            self.sender.watch()
            if time.monotonic() > end:
                raise TimeoutError(f"{what}: not within {seconds} s, state {state()}, "
                                   f"x {CNC.vars['mx']}, heard {self.mill.account.heard[-5:]}")
            time.sleep(0.02)

    def idle(self, seconds=60):
        self.until("Idle", lambda: state() == "Idle" and not self.sender.running, seconds)

    # After each job bCNC holds, resets and unlocks, and after a stop twice: what is sent before the
    # last of it is thrown away.
    def purged(self, resets):
        self.until("purge", lambda: self.mill.account.resets > resets, SOON)
        seen, since = 0, 0.0

        def quiet():
            nonlocal seen, since
            if seen != self.mill.account.resets or state() != "Idle":
                seen, since = self.mill.account.resets, time.monotonic()
            return time.monotonic() > since + 3
        self.until("quiet", quiet, 2 * SOON)
        self.idle()

    def open(self):
        self.sender.open(self.mill.port, 115200)
        self.until("status", lambda: state() == "Idle", SOON)
        for show in (self.sender.viewSettings, self.sender.viewParameters, self.sender.viewBuild,
                     self.sender.viewStartup):
            show()
        self.until("settings", lambda: "grbl_110" in CNC.vars, SOON)

    def program(self):
        lines = ["G21 G90", "(a comment)", "", "G0 Z1"]
        lines += [f"G1 X{i % 11 * 0.7:g} Y{i % 5 * 0.9:g} F6000" for i in range(100)]
        resets = self.mill.account.resets
        self.sender.run_lines(lines + ["G0 X3 Y4", "M30"])
        self.until("the end", lambda: not self.sender.running, 90)
        self.purged(resets)
        assert (CNC.vars["mx"], CNC.vars["my"]) == (3.0, 4.0), CNC.vars["mx"]

    def hold_and_resume(self):
        resets = self.mill.account.resets
        self.sender.run_lines(["G90 G21", "G1 X40 F300", "G1 X3 F6000"])
        self.until("Run", lambda: state() == "Run", SOON)
        time.sleep(0.5)
        self.sender.feedHold()
        self.until("Hold:0", lambda: state() == "Hold:0", SOON)
        held_at = CNC.vars["mx"]
        time.sleep(0.5)
        assert CNC.vars["mx"] == held_at
        self.sender.resume()
        self.until("the end", lambda: not self.sender.running, 90)
        self.purged(resets)
        assert CNC.vars["mx"] == 3.0

    # bCNC counts its steps from the last report: if that was late it stops beside the value, and a
    # user would move the slider again.
    def moves_override(self, reported, wanted):
        if CNC.vars[reported] != wanted and time.monotonic() > self.slid + 1:
            self.slid = time.monotonic()
            CNC.vars["_OvChanged"] = True
        return CNC.vars[reported] == wanted

    def overrides(self):
        resets = self.mill.account.resets
        self.sender.run_lines(["G90 G21", "G1 X43 F20", "G1 X3 F6000"])
        self.until("Run", lambda: state() == "Run", SOON)
        # One after the other: bCNC stops at the first of them that is reached.
        for name, value in (("Feed", 112), ("Rapid", 25), ("Spindle", 89)):
            CNC.vars["_Ov" + name] = value
            CNC.vars["_OvChanged"] = True
            self.until(name, lambda reported="Ov" + name, wanted=value:
                       self.moves_override(reported, wanted), SOON)
        CNC.vars["_OvFeed"] = CNC.vars["_OvRapid"] = CNC.vars["_OvSpindle"] = 100
        CNC.vars["_OvChanged"] = True
        self.sender.stopRun()
        self.purged(resets)

    def jog_and_cancel(self):
        self.sender.sendGCode("$J=G91 X60 F200")
        self.until("Jog", lambda: state() == "Jog", SOON)
        self.sender.serial_write(chr(0x85))
        self.until("Idle", lambda: state() == "Idle", SOON)
        assert CNC.vars["mx"] < 60
        self.sender.goto(3.0)
        self.until("back", lambda: CNC.vars["mx"] == 3.0 and state() == "Idle", SOON)

    def stop(self):
        resets = self.mill.account.resets
        self.sender.run_lines(["G90 G21", "G1 X60 F300", "G1 X3 F6000"])
        self.until("Run", lambda: state() == "Run", SOON)
        self.sender.stopRun()
        self.purged(resets)
        assert not self.sender.running

    def bad_line(self):
        resets = self.mill.account.resets
        self.sender.run_lines(["G90 G21", "G1 X4 F3000", "G1 X5 Q7", "G1 X6"])
        self.until("the error", lambda: any(line.startswith("error:")
                                            for line in self.mill.account.heard), SOON)
        time.sleep(1)
        self.sender.stopRun()
        self.purged(resets)

    def reset_in_motion(self):
        self.sender.sendGCode("G90 G1 X60 F300")
        self.until("Run", lambda: state() == "Run", SOON)
        time.sleep(0.3)
        self.sender.softReset()
        self.until("ALARM:3", lambda: "ALARM:3" in self.mill.account.heard, SOON)
        self.sender.unlock()
        self.until("Idle", lambda: state() == "Idle", SOON)

    def homing(self):
        for setting in ("$22=1", "$25=6000", "$24=600"):
            self.sender.sendGCode(setting)
        time.sleep(1)
        self.sender.home()
        self.until("homed", lambda: (CNC.vars["mx"], CNC.vars["my"], CNC.vars["mz"]) ==
                   (-1.0, -1.0, -1.0) and state() == "Idle", 60)

    def check_mode(self):
        held_at = CNC.vars["mx"]
        self.sender.checkGcode()
        self.until("Check", lambda: state() == "Check", SOON)
        self.sender.sendGCode("G91 G1 X-5 F1000")
        self.sender.sendGCode("G1 X-5 Q3")
        time.sleep(1)
        self.sender.checkGcode()
        self.until("out of Check", lambda: state() != "Check", SOON)
        assert CNC.vars["mx"] == held_at

    def close(self):
        self.sender.close()


STEPS = (Session.open, Session.program, Session.hold_and_resume, Session.overrides,
         Session.jog_and_cancel, Session.stop, Session.bad_line, Session.reset_in_motion,
         Session.homing, Session.check_mode, Session.close)


def main():
    failed = 0
    with VirtualMill(sys.argv[1]) as mill:
        session = Session(mill)
        for step in STEPS:
            start = time.monotonic()
            fault = ""
            try:
                step(session)
            except (AssertionError, TimeoutError) as error:
                fault = f"{type(error).__name__} {error}"
                failed += 1
            say(f"{step.__name__:16} {time.monotonic() - start:6.1f} s  {fault or 'good'}")
        wrong = mill.account.verdict()
        say(mill.account.summary())
        for fault in wrong:
            say(f"tap: {fault}")
    return 1 if failed or wrong else 0


if __name__ == "__main__":
    sys.exit(main())
