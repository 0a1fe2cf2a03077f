"""`cusp sim --serve` as a context: a virtual mill behind a tap, with its control port."""
import os
import pathlib
import re
import socket
import subprocess
import sys
import tempfile
import time

from line_tap import LineTap


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class VirtualMill:
    """Starts the controller, and a tap unless `tap` is False; `port` is what a sender opens."""

    def __init__(self, cusp, *options, settings="", tap=True, steps_per_mm=800):
        self.steps_per_mm = steps_per_mm
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.scratch.name)
        self.control_port = free_port()
        self.settings = self.folder / "settings.txt"
        self.settings.write_text(settings)
        direct = str(self.folder / "controller")
        self.process = subprocess.Popen(
            [cusp, "sim", "--serve", "--pty", direct, "--control", f"127.0.0.1:{self.control_port}",
             "--settings", str(self.settings), *options],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        first = self.process.stdout.readline()
        if "serving on" not in first:
            raise OSError(f"cusp does not serve: {first}{self.process.stdout.read()}")
        self.direct = direct
        self.tap = LineTap(direct, str(self.folder / "port")) if tap else None
        self.port = self.tap.link if tap else direct

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.tap:
            self.tap.close()
        self.process.terminate()
        self.process.wait(10)
        self.process.stdout.close()
        self.scratch.cleanup()

    @property
    def account(self):
        return self.tap.account

    def wait_until(self, condition, seconds):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end or self.process.poll() is not None:
                raise TimeoutError(f"waited {seconds} s in vain")
            time.sleep(0.01)

    def command(self, text):
        """One command of the control port, and its answer."""
        with socket.create_connection(("127.0.0.1", self.control_port), timeout=5) as line:
            line.sendall(text.encode() + b"\n")
            answer = b""
            while not answer.endswith(b"\n"):
                received = line.recv(4096)
                if not received:
                    break
                answer += received
        return answer.decode().strip()

    def where(self):
        """The position by its steps: mm from the start."""
        text = self.command("where")
        steps = re.search(r"steps (-?\d+),(-?\d+),(-?\d+)", text)
        return tuple(int(count) / self.steps_per_mm for count in steps.groups())


def say(text):
    print(text, file=sys.stderr, flush=True)
