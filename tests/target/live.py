#!/usr/bin/env python3
"""Streams a program to the image under QEMU over a live serial line and asks for the machine's position.

usage: live.py --cusp CUSP --image IMAGE PROGRAM --end X,Y,Z [--alone]

QEMU's serial port is a TCP socket that `cusp stream` opens; --alone sends the lines from here, each
after the answer to the one before, without cusp.
Exit status: 0 the stream was taken without an error and the machine is idle at the end given,
1 it does not, 2 something could not run.
"""
import argparse
import re
import socket
import subprocess
import sys
import time

from golden import bare_lines
from qemu import EXACT_TIME, MACHINE, semihosting


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Line:
    """A sender's end of the serial line."""

    def __init__(self, port, seconds=20):
        deadline = time.monotonic() + seconds
        while True:
            try:
                self.socket = socket.create_connection(("127.0.0.1", port), timeout=seconds)
                break
            except OSError:
                if time.monotonic() > deadline:
                    raise
                time.sleep(0.1)
        self.text = ""

    def send(self, text):
        self.socket.sendall(text.encode())

    def wait_for(self, pattern, seconds=60):
        """The next matching output of the controller; output before it is dropped."""
        deadline = time.monotonic() + seconds
        while True:
            match = re.search(pattern, self.text)
            if match:
                self.text = self.text[match.end():]
                return match
            if time.monotonic() > deadline:
                raise OSError(f"the controller does not say {pattern}, but {self.text[-200:]!r}")
            received = self.socket.recv(4096)
            if not received:
                raise OSError("the controller has closed the line")
            self.text += received.decode(errors="replace")


def stream_alone(port, program):
    line = Line(port)
    for text in bare_lines(program):
        line.send(text + "\n")
        answer = line.wait_for(r"(ok|error:\d+|ALARM:\d+)\r?\n").group(1)
        if answer != "ok":
            print(f"{text}: {answer}")
            return 1
    return 0


def stand(port, seconds):
    """Position once the machine is idle, in mm."""
    line = Line(port)
    deadline = time.monotonic() + seconds
    while True:
        line.send("?")
        report = line.wait_for(r"<(\w+)[^|>]*\|MPos:([-\d.,]+)[|>]")
        if report.group(1) in ("Idle", "Alarm") or time.monotonic() > deadline:
            return report.group(1), report.group(2)
        time.sleep(0.2)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cusp")
    parser.add_argument("--image", required=True)
    parser.add_argument("--end", required=True)
    parser.add_argument("--alone", action="store_true")
    parser.add_argument("--seconds", type=int, default=120)
    parser.add_argument("program")
    options = parser.parse_args()
    port = free_port()
    serial = ["-serial", f"tcp:127.0.0.1:{port},server=on,wait=off,nodelay=on"]
    try:
        with subprocess.Popen([*MACHINE, *serial, *EXACT_TIME, *semihosting(["real"]), "-kernel",
                               options.image], stdin=subprocess.DEVNULL) as qemu:
            try:
                if options.alone:
                    status = stream_alone(port, options.program)
                else:
                    Line(port).socket.close()  # QEMU listens from now on
                    status = subprocess.run(
                        [options.cusp, "stream", f"tcp:127.0.0.1:{port}", options.program],
                        stdin=subprocess.DEVNULL, timeout=options.seconds).returncode
                state, place = stand(port, options.seconds)
            finally:
                qemu.kill()
    except (OSError, subprocess.TimeoutExpired) as error:
        print(f"live: {error}", file=sys.stderr)
        return 2
    good = status == 0 and state == "Idle" and \
        [float(x) for x in place.split(",")] == [float(x) for x in options.end.split(",")]
    print(f"the stream ended with status {status}; the machine is {state} at {place}")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
