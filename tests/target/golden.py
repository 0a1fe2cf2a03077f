#!/usr/bin/env python3
"""Runs a program on the image under QEMU and in the host simulator, and compares the edges.

usage: golden.py PROGRAM [--settings FILE] [--script FILE] [--pins PLUGIN] [--as-it-is]
                 [--twice] [--keep FOLDER] [--cusp CUSP] [--image IMAGE]

Each run yields the list of (tick, levels of the six lines) after every change; the lists must be
equal, tick by tick, and the board's must have the checksum that `cusp sim --stats` says. With --pins
(pins/pin_watch.cpp, built) also what reached the port's pins in QEMU must be what the trace says, in
order. With --twice the image runs twice: its edges must be the same, and its pins must change at the
same instructions.
Exit status: 0 they are, 1 they are not, 2 something could not run.
"""
import argparse
import array
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import time
import zlib

import pins
from qemu import RunFailed, run_image

WIRES = ("step_x", "step_y", "step_z", "dir_x", "dir_y", "dir_z", "step_a", "dir_a")
ALWAYS = 6  # of them are in a dump
UNITS_IN_PICOSECONDS = {"s": 10**12, "ms": 10**9, "us": 10**6, "ns": 10**3, "ps": 1}
MICROSECOND = 10**6
BUILD = pathlib.Path(__file__).resolve().parents[2] / "build"


def read_trace(path):
    """The board's trace: one number an edge, tick * 256 + levels."""
    edges = array.array("Q")
    edges.frombytes(pathlib.Path(path).read_bytes())
    return edges


def read_header(file):
    """Bit of each wire's code, and picoseconds a time unit, from a value change dump's head."""
    bits, scale, text = {}, None, ""
    for line in file:
        text += line
        if "$enddefinitions" in line:
            break
    match = re.search(r"\$timescale\s+(\d+)\s*(\w+)\s+\$end", text)
    if match:
        scale = int(match.group(1)) * UNITS_IN_PICOSECONDS[match.group(2)]
    for code, name in re.findall(r"\$var\s+\w+\s+1\s+(\S+)\s+(\w+)", text):
        if name in WIRES:
            bits[code] = 1 << WIRES.index(name)
    if scale is None or len(bits) < ALWAYS:
        raise RunFailed("the value change dump has no timescale or lacks a wire")
    return bits, scale


def read_dump(path):
    """The simulator's trace from its value change dump, in the board's form."""
    edges = array.array("Q")
    with open(path) as file:
        bits, scale = read_header(file)
        levels = before = tick = 0
        for line in file:
            if line[0] == "#":
                if levels != before:
                    edges.append(tick << 8 | levels)
                    before = levels
                tick = int(line[1:]) * scale // MICROSECOND
            elif line[0] in "01":
                bit = bits.get(line[1:].rstrip())
                if bit:
                    levels = levels | bit if line[0] == "1" else levels & ~bit
        if levels != before:
            edges.append(tick << 8 | levels)
    return edges


def edges_crc32(edges):
    """The checksum of `cusp sim --stats`: 10 bytes an edge, the direction of an axis before its step."""
    crc = before = 0
    for edge in edges:
        tick, levels = edge >> 8, edge & 255
        for wire in (1, 0, 3, 2, 5, 4):
            bit = 1 << (wire // 2 + (3 if wire % 2 else 0))
            if (levels ^ before) & bit:
                crc = zlib.crc32(struct.pack("<QBB", tick, wire, int(levels & bit != 0)), crc)
        before = levels
    return f"{crc:08x}"


def first_difference(left, right):
    if left == right:
        return None
    count = min(len(left), len(right))
    place = next((k for k in range(count) if left[k] != right[k]), count)

    def show(edges):
        if place >= len(edges):
            return f"ends after {len(edges)} edges"
        return f"edge {place} at tick {edges[place] >> 8}, levels {edges[place] & 255:06b}"
    return f"{show(left)} against {show(right)}"


def simulate(options, folder):
    dump, stats = folder / "host.vcd", folder / "host.json"
    command = [options.cusp, "sim", options.program, "--vcd", str(dump), "--stats", str(stats)]
    if options.settings:
        command += ["--settings", options.settings]
    if options.script:
        command += ["--script", options.script]
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode > 1 or not dump.exists():
        raise RunFailed(f"cusp sim: status {run.returncode}: {run.stderr[-500:]}")
    return run.returncode, read_dump(dump), json.loads(stats.read_text())["edges_crc32"]


def bare_lines(path):
    """The lines of a file that a sender sends: no comments, no empty lines."""
    for line in re.split(r"\r\n|\r|\n", pathlib.Path(path).read_bytes().decode("latin-1")):
        bare = re.sub(r"\([^)]*\)|;.*", "", line).strip()
        if bare and bare != "%":
            yield bare


def play(options, folder, name):
    """The settings go ahead of the program, as the lines that a sender would send."""
    program = folder / "board.ngc"
    text = "".join(f"{line}\n" for line in bare_lines(options.settings)) if options.settings else ""
    if options.as_it_is:
        text += pathlib.Path(options.program).read_bytes().decode("latin-1")
    else:
        text += "".join(f"{line}\n" for line in bare_lines(options.program))
    program.write_bytes(text.encode("latin-1"))
    trace = folder / name
    words = ["program", program, "trace", trace]
    if options.script:
        words += ["script", pathlib.Path(options.script).resolve()]
    log = folder / f"{name}.log"
    extra = pins.options_of(pathlib.Path(options.pins).resolve(), log) if options.pins else ()
    status, console = run_image(options.image, words, options.seconds, extra)
    (folder / f"{name}.txt").write_text(console)
    if status > 1:
        raise RunFailed(f"{options.image}: status {status}: {console[-500:]}")
    return status, read_trace(trace), pins.read_pins(log) if options.pins else None


def compare_pins(board, log):
    difference = pins.first_difference(board, log)
    if difference:
        yield f"trace and pins differ: {difference}"


def compare_again(options, folder, board, log):
    # A name of the same length: the guest reads it, and its instructions are counted.
    _, again, again_log = play(options, folder, "again")
    if board != again:
        yield f"two runs of the board differ: {first_difference(board, again)}"
    if log != again_log:
        yield "the pins of two runs of the board differ"


def compare(options, folder):
    started = time.monotonic()
    host_status, host, host_crc = simulate(options, folder)
    simulated = time.monotonic()
    board_status, board, board_pins = play(options, folder, "first")
    played = time.monotonic()
    print(f"{pathlib.Path(options.program).name}: {len(host)} edges on the host in "
          f"{simulated - started:.1f} s, {len(board)} on the board in {played - simulated:.1f} s")
    found = []
    if not options.may_stand_still and not host:
        found.append("the program moves nothing: nothing is compared")
    if options.twice:
        found += compare_again(options, folder, board, board_pins)
    if options.pins:
        found += compare_pins(board, board_pins)
    if host != board:
        found.append(f"host and board differ: {first_difference(host, board)}")
    if edges_crc32(board) != host_crc:
        found.append(f"edges_crc32: the host says {host_crc}, the board's edges have {edges_crc32(board)}")
    if host_status != board_status:
        found.append(f"the host ended with status {host_status}, the board with {board_status}")
    print("\n".join(found) if found else "equal, tick by tick" + ("; twice the same" if options.twice else ""))
    return 1 if found else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cusp", default=BUILD / "release/bin/cusp")
    parser.add_argument("--image", default=BUILD / "cortex-m4f/bin/mill3_f405_qemu.elf")
    parser.add_argument("program")
    parser.add_argument("--settings")
    parser.add_argument("--script")
    parser.add_argument("--pins", metavar="PLUGIN")
    parser.add_argument("--as-it-is", action="store_true",
                        help="the board reads comments and blank lines too")
    parser.add_argument("--twice", action="store_true", help="the image runs twice, alike")
    parser.add_argument("--keep", help="folder for the traces; default: none are kept")
    parser.add_argument("--seconds", type=int, default=300)
    parser.add_argument("--may-stand-still", action="store_true")
    options = parser.parse_args()
    try:
        if options.keep:
            pathlib.Path(options.keep).mkdir(parents=True, exist_ok=True)
            return compare(options, pathlib.Path(options.keep).resolve())
        with tempfile.TemporaryDirectory() as folder:
            return compare(options, pathlib.Path(folder))
    except (OSError, RunFailed) as error:
        print(f"golden: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
