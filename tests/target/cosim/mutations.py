#!/usr/bin/env python3
"""Plants faults in drivers and traits, one at a time, and shows that the co-simulation finds each.

usage: mutations.py --cosim COSIM --cusp CUSP --board mill3_f405 --image IMAGE.bin

The board's main.cpp, which has all drivers in it, is compiled again with one line of one header changed
and linked with the libraries of the build that IMAGE is from; then a short program and one jog run on it.
Exit status: 0 each is found, 1 one is not, 2 something could not be built.
"""
import argparse
import contextlib
import io
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

import on_chip
from chip import ROOT, Chip, CosimFailed

PLAYER = "hal/stm32f4/dma_pulse_player.hpp"
LINK = "hal/stm32f4/dma_link.hpp"
CLOCKS = "hal/stm32f4/clock_tree.hpp"
# What a driver may get wrong: file, what stands there, what is put there.
FAULTS = {
    "wrong channel": (PLAYER, "kChannel = 7;", "kChannel = 6;"),
    "wrong stream": (PLAYER, "kStream = 1;", "kStream = 2;"),
    "flags never acknowledged": (PLAYER, "flag_clear().write(raised & kAllFlags);", ""),
    "acknowledged late": (PLAYER, "    const std::uint32_t raised = flags().read();\n"
                          "    flag_clear().write(raised & kAllFlags);\n",
                          "    const std::uint32_t raised = flags().read();\n"),
    "halves swapped": (PLAYER, "finish_half(first_over ? 1 : 0)", "finish_half(first_over ? 0 : 1)"),
    "gate shorter than a frame": (PLAYER, "kGateMargin = 20;", "kGateMargin = -200;"),
    "pace off by one": (PLAYER, "kServoTicksPerSecond) - 1);", "kServoTicksPerSecond));"),
    "port without its clock": ("hal/stm32f4/watchdog.hpp", "1U << 0U | 1U << 1U | 1U << 2U | 1U << 22U",
                               "1U << 0U | 1U << 1U | 1U << 22U"),
    "two pins swapped": (PLAYER, "return pins_up | pins_down << 16U;",
                         "return (pins_up & ~3U) | (pins_up & 1U) << 1U | (pins_up >> 1U & 1U) |"
                         " pins_down << 16U;"),
    "lines left inputs": (PLAYER, "set_pin(Port::gpio(), pin, PinMode::kOutput);",
                          "set_pin(Port::gpio(), pin, PinMode::kInput);"),
    "stream changed while it is on": (PLAYER, "    begin_gate();\n    const std::uint32_t raised",
                                      "    begin_gate();\n    stream().m0ar.write(0x20000000);\n"
                                      "    const std::uint32_t raised"),
    "too few wait states": ("boards/mill3_f405/board_traits.hpp", "168000000, 5, 2, 4, 1}",
                            "168000000, 3, 2, 4, 1}"),
    "slow bus too fast": ("boards/mill3_f405/board_traits.hpp", "168000000, 5, 2, 4, 1}",
                          "168000000, 5, 2, 2, 1}"),
    "voltage too low": (CLOCKS, "set_bits(Chip::power().cr, scale << 14U);",
                        "Chip::power().cr.write(0);"),
    "wrong baud rate": (LINK, "port.brr.write((bus_hz + baud / 2) / baud);",
                        "port.brr.write(bus_hz / 16 / baud);"),
    "limit pins swapped": ("boards/mill3_f405/mill_pins.hpp", "{'B', 12}, {'B', 13}", "{'B', 13}, {'B', 12}"),
    "no barrier": ("boards/mill3/mill_image.hpp", '__asm volatile("dsb" ::: "memory");', ""),
}


class Builder:
    """Compiles and links the board's image with a changed header."""

    def __init__(self, image, folder):
        self.build = pathlib.Path(image).resolve().parents[1]
        self.board = pathlib.Path(image).stem
        self.folder = folder
        commands = subprocess.run(["ninja", "-C", str(self.build), "-t", "commands",
                                   f"bin/{self.board}.elf"], check=True, capture_output=True,
                                  text=True).stdout.splitlines()
        self.compile = next(line for line in commands if f"boards/{self.board}/main.cpp" in line
                            and " -c " in line)
        self.link = commands[-1]

    def run(self, command):
        done = subprocess.run(command, shell=True, cwd=self.build, capture_output=True, text=True)
        if done.returncode != 0:
            raise OSError(f"{command[:200]} ...: {done.stderr[-500:]}")

    def make(self, file, old, new):
        """The image with `new` for `old`, as a .bin."""
        text = (ROOT / file).read_text()
        if old not in text:
            raise OSError(f"{file} has no {old!r}: the list of faults is out of date")
        changed = self.folder / "overlay" / file
        changed.parent.mkdir(parents=True, exist_ok=True)
        changed.write_text(text.replace(old, new, 1))
        try:
            objects = re.search(r"-o (\S+main\.cpp\.obj)", self.compile).group(1)
            mine = self.folder / "main.obj"
            flags = f" -w -I{self.folder / 'overlay'} -I{ROOT}"
            command = self.compile.replace(f"-o {objects}", f"-o {mine}")
            self.run(command.replace(" -I" + str(ROOT) + " ", f"{flags} ", 1)
                     if f" -I{ROOT} " in command else command.replace(" -c ", f"{flags} -c ", 1))
            elf = self.folder / "changed.elf"
            step = next(part for part in self.link.split("&&") if " -o bin/" in part)
            step = step.replace(objects, str(mine)).replace(f"-o bin/{self.board}.elf", f"-o {elf}")
            self.run(re.sub(r"-Map=\S+", f"-Map={self.folder / 'changed.map'}", step))
            image = self.folder / "changed.bin"
            self.run(shlex.join(["arm-none-eabi-objcopy", "-O", "binary", "--gap-fill", "0xff",
                                 str(elf), str(image)]))
            return image
        finally:
            changed.unlink()


def find(options, image):
    """What the co-simulation says of an image; None where it finds nothing."""
    options.image = image
    try:
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as said:
            if not on_chip.compare(options, pathlib.Path(folder)):
                return said.getvalue().strip().splitlines()[-1]
        with Chip(options.cosim, image, options.board) as machine:
            machine.boot()
            machine.pin(machine.pins["limit X"], 1)
            machine.run(20)
            machine.send("?")
            if "|Pn:X|" not in machine.run(50).replace(">", "|"):
                return "the limit switch of X is not reported"
    except (AssertionError, CosimFailed, on_chip.RunFailed) as error:
        return str(error).strip().splitlines()[-1]
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("cosim", "cusp", "board", "image"):
        parser.add_argument(f"--{name}", required=True)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        program = folder / "short.ngc"
        program.write_text("G91 G1 X1 Y0.5 Z-0.2 F1200\nG0 X-1\nG2 X1 Y1 I0.5 J0.5\nM2\n")
        options.program, options.settings, options.script = program, None, None
        options.as_it_is = options.may_stand_still = False
        options.chip_seconds = options.seconds = 0.0
        missed = []
        try:
            builder = Builder(options.image, folder)
            said = find(options, builder.make(PLAYER, "kChannel = 7;", "kChannel = 7 ;"))
            print(f"no fault: {said}")
            missed += ["no fault"] if said else []
            for fault, (file, old, new) in FAULTS.items():
                said = find(options, builder.make(file, old, new))
                print(f"{fault}: {said or 'NOT FOUND'}", flush=True)
                missed += [] if said else [fault]
        except (OSError, subprocess.CalledProcessError, StopIteration) as error:
            print(f"mutations: {error}", file=sys.stderr)
            return 2
    print(f"{len(FAULTS)} faults planted; wrong: {missed or 'none'}")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
