"""A sender's end of a pseudo-terminal or socket, line by line."""
import os
import re
import select
import socket
import termios
import time
import tty


class Port:
    def __init__(self, name):
        self.socket = None
        if name.startswith("tcp:"):
            host, port = name[4:].rsplit(":", 1)
            self.socket = socket.create_connection((host, int(port)), timeout=5)
            self.descriptor = self.socket.fileno()
        else:
            self.descriptor = os.open(name, os.O_RDWR | os.O_NOCTTY)
            # TCSAFLUSH, the default, now and then drops the greeting
            tty.setraw(self.descriptor, termios.TCSANOW)
        self.buffer = b""
        self.lines = []

    def close(self):
        if self.socket:
            self.socket.close()
        else:
            os.close(self.descriptor)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def send(self, data):
        if isinstance(data, str):
            data = data.encode("latin-1")
        while data:
            data = data[os.write(self.descriptor, data):]

    def in_waiting(self):
        return bool(self.buffer) or bool(select.select([self.descriptor], [], [], 0)[0])

    def flush_input(self):
        if not self.socket:
            termios.tcflush(self.descriptor, termios.TCIFLUSH)
        self.buffer = b""
        while select.select([self.descriptor], [], [], 0)[0]:
            os.read(self.descriptor, 4096)

    def read_line(self, seconds=10):
        """The next line without its end; None where none comes in time."""
        end = time.monotonic() + seconds
        while b"\n" not in self.buffer:
            left = end - time.monotonic()
            if left <= 0 or not select.select([self.descriptor], [], [], left)[0]:
                return None
            data = os.read(self.descriptor, 4096)
            if not data:
                return None
            self.buffer += data
        line, self.buffer = self.buffer.split(b"\n", 1)
        text = line.rstrip(b"\r").decode("latin-1")
        self.lines.append(text)
        return text

    def wait_for(self, pattern, seconds=10):
        """The first line that matches, and the lines before it."""
        end = time.monotonic() + seconds
        before = []
        while True:
            line = self.read_line(max(0.0, end - time.monotonic()))
            if line is None:
                raise TimeoutError(f"no {pattern} within {seconds} s, but {before[-8:]}")
            if re.search(pattern, line):
                return line, before
            before.append(line)

    def ask(self, line, seconds=10):
        """Sends a line; what came before its answer, and the answer."""
        self.send(line + "\n")
        answer, before = self.wait_for(r"^(ok|error:\d+)$", seconds)
        return [text for text in before if not text.startswith("<")], answer

    def state(self):
        self.send("?")
        return self.wait_for(r"^<")[0]

    def wait_state(self, state, seconds=20):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            report = self.state()
            if report.startswith("<" + state):
                return report
            time.sleep(0.02)
        raise TimeoutError(f"not {state} within {seconds} s but {report}")
