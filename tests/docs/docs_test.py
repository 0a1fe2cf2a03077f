#!/usr/bin/env python3
"""Runs the command blocks of documents in order, and compares what they print with what is shown.

usage: docs_test.py CUSP TOP DOCUMENT...    (documents relative to TOP)

A block ```sh holds commands, a block ```console commands after "$ " and below each what it prints,
both streams; "..." means any text. Words after sh or console:
  no-run=REASON  is not run; REASONS below has the words
  needs=view     is run where the build has the pages of cusp view
  background     one command, which runs until the document ends
  stop-after=S   Ctrl-C comes after S seconds
  status=N       the exit status of the last command, 0 if not given
Each document has an empty folder of its own, with the tree's examples in it.
Exit status: 0 all agree, 1 not.
"""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

REASONS = {
    "install": "installs packages, as root",
    "source": "builds cusp or runs all tests: this test is one of them",
    "port": "needs a machine on a serial port",
    "server": "serves until its page is closed",
    "demo": "cusp demo plans it",
}
FENCE = re.compile(r"^```(\w*) ?(.*)$")
TIMEOUT_S = 600


class DocumentFault(Exception):
    pass


class Block:
    def __init__(self, place, words):
        self.place = place
        self.lines = []
        self.options = dict(word.partition("=")[::2] for word in words.split())
        unknown = set(self.options) - {"no-run", "needs", "background", "stop-after", "status"}
        if self.options.get("needs", "view") != "view":
            raise DocumentFault(f"{place}: needs={self.options['needs']} is not known")
        if unknown:
            raise DocumentFault(f"{place}: a block does not know {sorted(unknown)}")
        if "no-run" in self.options and self.options["no-run"] not in REASONS:
            raise DocumentFault(f"{place}: no-run={self.options['no-run']} is none of {sorted(REASONS)}")


def blocks_of(name, text):
    """Command blocks, as (block, list of (command, lines shown or None))."""
    found, block, language = [], None, ""
    for number, line in enumerate(text.splitlines(), 1):
        fence = FENCE.match(line)
        if block is None and fence:
            language = fence[1]
            block = Block(f"{name}:{number}", fence[2] if language in ("sh", "console") else "")
        elif fence and line.strip() == "```":
            if language in ("sh", "console"):
                found.append((block, commands_of(block, language)))
            block = None
        elif block is not None:
            block.lines.append(line)
    return found


def commands_of(block, language):
    commands = []
    for line in block.lines:
        if commands and commands[-1][0].endswith("\\"):
            commands[-1][0] += "\n" + line
        elif language == "sh" and line.strip():
            commands.append([line, None])
        elif language == "console" and line.startswith("$ "):
            commands.append([line[2:], []])
        elif language == "console" and commands:
            commands[-1][1].append(line)
        elif line.strip():
            raise DocumentFault(f"{block.place}: text before the first command")
    return commands


def agrees(shown, printed):
    """True if the text that is shown, "..." being anything, is all that was printed."""
    pattern = ".*?".join(re.escape(part) for part in shown.strip().split("..."))
    return re.fullmatch(pattern, printed.strip(), re.DOTALL) is not None


class Runner:
    def __init__(self, folder, path):
        self.folder = folder
        self.environment = dict(os.environ, PATH=path)
        self.background = []

    def start(self, command):
        # in a process group of its own, as a terminal has it: Ctrl-C reaches all of it
        return subprocess.Popen(["bash", "-c", command], cwd=self.folder, env=self.environment, text=True,
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                start_new_session=True)

    def run(self, block, commands):
        options = block.options
        if "background" in options:
            self.background.append(self.start(commands[0][0]))
            time.sleep(2)
            return
        for place, (command, shown) in enumerate(commands):
            process = self.start(command)
            try:
                printed, _ = process.communicate(timeout=float(options.get("stop-after", TIMEOUT_S)))
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGINT)
                printed, _ = process.communicate(timeout=TIMEOUT_S)
                if "stop-after" not in options:
                    raise DocumentFault(f"{block.place}: {command}: not done after {TIMEOUT_S} s")
            status = int(options.get("status", 0)) if place == len(commands) - 1 else 0
            if process.returncode != status:
                raise DocumentFault(f"{block.place}: {command}: exit status {process.returncode}, not {status}\n{printed}")
            if shown is not None and not agrees("\n".join(shown), printed):
                raise DocumentFault(f"{block.place}: {command}: prints\n{printed}\nand is shown as\n" + "\n".join(shown))

    def end(self):
        for process in self.background:
            os.killpg(process.pid, signal.SIGINT)
            process.communicate(timeout=TIMEOUT_S)


def has_pages(cusp):
    with tempfile.TemporaryDirectory() as scratch:
        program = pathlib.Path(scratch) / "p.ngc"
        program.write_text("G0 X1\n")
        done = subprocess.run([cusp, "view", program, "-o", program.with_suffix(".html")], capture_output=True, text=True)
        if done.returncode not in (0, 2):
            raise DocumentFault(f"cusp view: exit status {done.returncode}: {done.stderr}")
        return done.returncode == 0


def check_document(name, text, cusp, examples):
    ran = 0
    with tempfile.TemporaryDirectory() as scratch:
        if examples:
            shutil.copytree(examples, pathlib.Path(scratch) / "examples")
        runner = Runner(scratch, f"{cusp.parent}{os.pathsep}{os.environ['PATH']}")
        try:
            for block, commands in blocks_of(name, text):
                if "no-run" in block.options:
                    print(f"{block.place}: not run: {REASONS[block.options['no-run']]}")
                    continue
                if "needs" in block.options and not has_pages(cusp):
                    print(f"{block.place}: not run: this build has no pages (npm)")
                    continue
                begin = time.monotonic()
                runner.run(block, commands)
                ran += len(commands)
                print(f"{block.place}: {len(commands)} run in {time.monotonic() - begin:.1f} s", flush=True)
        finally:
            runner.end()
    if not ran:
        raise DocumentFault(f"{name}: no command was run")


class Documents(unittest.TestCase):
    def refused(self, words, text):
        with self.assertRaises(DocumentFault) as caught:
            check_document("text", text, CUSP, None)
        self.assertIn(words, str(caught.exception))

    def test_notices_what_is_shown_otherwise(self):
        check_document("text", "```console\n$ echo one two; echo three\none ...\nthree\n```\n", CUSP, None)
        self.refused("prints\none", "```console\n$ echo one\ntwo\n```\n")
        self.refused("prints\none\ntwo", "```console\n$ echo one; echo two\none\n```\n")
        self.refused("prints", "```console\n$ true\nsomething\n```\n")

    def test_notices_failing_commands_and_documents_without_any(self):
        self.refused("exit status 1, not 0", "```sh\nfalse\n```\n")
        self.refused("exit status 0, not 1", "```sh status=1\ntrue\n```\n")
        self.refused("no command was run", "```sh no-run=install\nfalse\n```\n")
        self.refused("is none of", "```sh no-run=weather\ntrue\n```\n")
        self.refused("is not known", "```sh needs=weather\ntrue\n```\n")
        self.refused("does not know", "```sh sideways\ntrue\n```\n")

    def test_keeps_the_order_in_one_folder(self):
        check_document("text", "```sh\necho one >f\n```\n\n```console\n$ cat f\none\n```\n", CUSP, None)

    def test_stops_what_is_to_be_stopped(self):
        check_document("text", "```console stop-after=0.5 status=3\n$ trap 'exit 3' INT; while :; do sleep 0.1; done\n```\n", CUSP, None)

    def test_the_documents(self):
        for name in NAMES:
            with self.subTest(name):
                check_document(name, (TOP / name).read_text(), CUSP, TOP / "examples")


if __name__ == "__main__":
    CUSP, TOP, NAMES = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]), sys.argv[3:]
    unittest.main(argv=sys.argv[:1])
