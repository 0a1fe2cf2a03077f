#!/usr/bin/env python3
"""The board's image with its serial line at 1 Mbaud: no byte is lost, whatever the core does.

usage: fast_serial.py --cosim COSIM --board BOARD --image IMAGE.bin [--cusp CUSP]

Only kBaud of the board's table is changed (mutations.py compiles it); then the serial tests of
faults_on_chip.py run with a sender at that rate: settings restored over erased sectors, the most pulses.
Exit status: that of the tests, 2 where the image can't be built.
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile

from chip import WIRED_AS
from mutations import Builder

HERE = pathlib.Path(__file__).resolve().parent
BAUD = 1000000
TABLES = {"mill3_f405": "mill_table", "black_pill_f411": "pill_table", "nucleo_f446_cnc_shield": "nucleo_table",
          "skr2_f407": "skr2_table", "octopus_f446": "octopus_table"}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("cosim", "board", "image"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--cusp")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        try:
            builder = Builder(options.image, pathlib.Path(folder))
            board = WIRED_AS.get(options.board, options.board)
            image = builder.make(f"boards/{board}/{TABLES[board]}.hpp",
                                 "kBaud = 115200;", f"kBaud = {BAUD};")
        except (OSError, subprocess.CalledProcessError, StopIteration) as error:
            print(f"fast_serial: {error}", file=sys.stderr)
            return 2
        return subprocess.run([sys.executable, HERE / "faults_on_chip.py", "--cosim", options.cosim,
                               "--board", options.board, "--image", str(image), "--baud", str(BAUD),
                               "Serial"]).returncode


if __name__ == "__main__":
    sys.exit(main())
