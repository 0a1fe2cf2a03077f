"""A tap on the serial line: everything passes, every byte outstanding and every answer is counted.

A sender opens the tap's link (a pseudo-terminal) instead of the controller's. The tap requires of the controller: one
answer for each line end, in order; never more bytes outstanding than were promised; ASCII alone; status reports of
Grbl's form.
"""
import collections
import os
import re
import select
import termios
import threading
import time
import tty

REALTIME = {0x18, ord("?"), ord("!"), ord("~")} | set(range(0x80, 0x100))
RESET = 0x18
ANSWER = re.compile(r"^(ok|error:\d+)$")
NUMBERS = r"-?\d+\.\d+,-?\d+\.\d+,-?\d+\.\d+"
REPORT = re.compile(
    r"^<(Idle|Run|Jog|Alarm|Check|Home|Sleep|Hold:[01]|Door:[0-3])"
    rf"\|[MW]Pos:{NUMBERS}(\|Bf:\d+,\d+)?(\|Ln:\d+)?\|FS:\d+(\.\d)?,\d+"
    rf"(\|Pn:P?X?Y?Z?D?H?R?S?)?(\|WCO:{NUMBERS})?(\|Ov:\d+,\d+,\d+(\|A:[SC]?F?M?)?)?>$")


class Account:
    """The counts of one line, of both directions."""

    def __init__(self, room=1024):
        self.room = room
        self.outstanding = collections.deque()
        self.line = bytearray()
        self.said = b""
        self.most_outstanding = 0
        self.line_ends = 0
        self.answers = 0
        self.errors = []
        self.resets = 0
        self.cut_off = 0
        self.reports = 0
        self.longest_report_wait = 0.0
        self.questions = collections.deque()
        self.faults = []
        self.sent_lines = []
        self.heard = []

    def to_controller(self, data, now):
        for byte in data:
            if byte == RESET:
                self.resets += 1
                self.cut_off += len(self.outstanding)
                self.outstanding.clear()
                self.line.clear()
            elif byte == ord("?"):
                self.questions.append(now)
            elif byte in (10, 13):
                self.line_ends += 1
                self.outstanding.append(len(self.line) + 1)
                self.sent_lines.append(bytes(self.line))
                self.line.clear()
            elif byte not in REALTIME:
                self.line.append(byte)
        waiting = sum(self.outstanding) + len(self.line)
        self.most_outstanding = max(self.most_outstanding, waiting)

    def from_controller(self, data, now):
        self.said += data
        while b"\n" in self.said:
            line, self.said = self.said.split(b"\n", 1)
            if not line.endswith(b"\r"):
                self.faults.append(f"a line without CR: {line!r}")
            try:
                self.take(line.rstrip(b"\r").decode("ascii"), now)
            except UnicodeDecodeError:
                self.faults.append(f"not ASCII: {line!r}")

    def take(self, line, now):
        self.heard.append(line)
        if line.startswith("<"):
            self.reports += 1
            # Several questions before one answer are one question.
            if self.questions:
                self.longest_report_wait = max(self.longest_report_wait, now - self.questions[0])
                self.questions.clear()
            if not REPORT.match(line):
                self.faults.append(f"a report of another form: {line}")
        elif ANSWER.match(line):
            self.answers += 1
            if line != "ok":
                self.errors.append(line)
            if not self.outstanding:
                self.faults.append(f"{line} that no line end asked for")
            else:
                self.outstanding.popleft()
        elif "ok" in line and not line.startswith(("[", ">")):
            self.faults.append(f"an answer that is not alone: {line}")

    def verdict(self):
        """The faults found when all is at rest; empty if there are none."""
        wrong = list(self.faults)
        if self.outstanding:
            wrong.append(f"{len(self.outstanding)} lines without an answer")
        if self.line_ends != self.answers + self.cut_off + len(self.outstanding):
            wrong.append(f"{self.line_ends} line ends, {self.answers} answers, {self.cut_off} cut off")
        if self.most_outstanding > self.room:
            wrong.append(f"{self.most_outstanding} bytes outstanding")
        return wrong

    def summary(self):
        return (f"{self.line_ends} line ends, {self.answers} answers ({len(self.errors)} errors), "
                f"{self.cut_off} cut off by {self.resets} resets, at most {self.most_outstanding} bytes "
                f"outstanding, {self.reports} reports, slowest {1000 * self.longest_report_wait:.1f} ms")


class LineTap:
    """Relays between a new pseudo-terminal at `link` and the controller at `controller`."""

    def __init__(self, controller, link, room=1024):
        self.account = Account(room)
        self.master, slave = os.openpty()
        tty.setraw(slave)
        name = os.ttyname(slave)
        if os.path.islink(link):
            os.unlink(link)
        os.symlink(name, link)
        self.link = link
        os.close(slave)
        self.controller_name = controller
        self.controller = -1
        self.stopping = False
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def has_sender(self):
        poll = select.poll()
        poll.register(self.master, 0)
        return not any(events & select.POLLHUP for _, events in poll.poll(0))

    def run(self):
        while not self.stopping:
            if self.controller < 0:
                if not self.has_sender():
                    time.sleep(0.001)
                    continue
                self.controller = os.open(self.controller_name, os.O_RDWR | os.O_NOCTTY)
                tty.setraw(self.controller, termios.TCSANOW)  # as in port.py
            elif not self.has_sender():
                os.close(self.controller)
                self.controller = -1
                continue
            try:
                self.relay()
            except OSError:
                time.sleep(0.001)

    def relay(self):
        ready, _, _ = select.select([self.master, self.controller], [], [], 0.02)
        now = time.monotonic()
        if self.master in ready:
            data = os.read(self.master, 4096)
            self.account.to_controller(data, now)
            os.write(self.controller, data)
        if self.controller in ready:
            data = os.read(self.controller, 4096)
            while data.endswith(b"\r"):  # a sender may take it for the line's end, and send before the tap has counted
                data += os.read(self.controller, 1)
            self.account.from_controller(data, now)
            os.write(self.master, data)

    def close(self):
        self.stopping = True
        self.thread.join()
        if self.controller >= 0:
            os.close(self.controller)
        os.close(self.master)
        if os.path.islink(self.link):
            os.unlink(self.link)
