#!/usr/bin/env python3
"""`cusp stream` sends a program to a board's shipping image, over a pseudo-terminal, at its baud rate.

usage: stream_to_chip.py --cosim COSIM --cusp CUSP --board BOARD --image IMAGE.bin [--usb] PROGRAM --end X,Y,Z
Exit status: 0 it was taken and the machine is at the end given, 1 it does not.
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile

from chip import Chip
from usb import Usb


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("cosim", "cusp", "board", "image", "end"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--usb", action="store_true", help="through its plug")
    parser.add_argument("program")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, Chip(options.cosim, options.image, options.board) as machine:
        machine.boot()
        if options.usb:
            plug = Usb(machine)
            plug.plug_in()
            plug.open()
        port = pathlib.Path(folder) / "port"
        machine.process.stdin.write(f"terminal {port} 600000\n")
        machine.process.stdin.flush()
        machine.process.stdout.readline()
        run = subprocess.run([options.cusp, "stream", port, options.program],
                             stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300)
        while machine.process.stdout.readline() != "done\n":
            pass
        state, place = machine.wait_for("Idle")
        lost = machine.state()["lost"]
    good = run.returncode == 0 and lost == 0 and \
        place == tuple(float(part) for part in options.end.split(","))
    print(f"the stream ended with status {run.returncode}; the machine is {state} at {place}; "
          f"{lost} bytes lost")
    if run.returncode != 0:
        print(run.stdout[-500:], run.stderr[-500:])
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
