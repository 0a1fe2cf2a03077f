#!/usr/bin/env python3
"""Tables of pins that no board may have: each must fail to compile, for its own reason; the boards' compile.

usage: pin_tables_test.py ROOT COMPILER
"""
import pathlib
import re
import subprocess
import sys

ROOT, COMPILER = pathlib.Path(sys.argv[1]), sys.argv[2]
TABLES = {"MillTable": "boards/mill3_f405/mill_table.hpp", "PillTable": "boards/black_pill_f411/pill_table.hpp",
          "NucleoTable": "boards/nucleo_f446_cnc_shield/nucleo_table.hpp",
          "Skr2Table": "boards/skr2_f407/skr2_table.hpp", "OctopusTable": "boards/octopus_f446/octopus_table.hpp"}
# Changes to the first table, two at once where there is an ` & `, and what the compiler must say of each.
WRONG = {
    "flood on X's step": ("flood = {'C', 7}", "flood = {'C', 0}", "a pin is named twice"),
    "two inputs on one pin": ("probe = {'B', 15}", "probe = {'B', 14}", "a pin is named twice"),
    "a limit on SWDIO": ("limit_x = {'B', 12}", "limit_x = {'A', 13}", "PA13 and PA14 are the debugger's"),
    "a button on SWCLK": ("hold = {'B', 9}", "hold = {'A', 14}", "PA13 and PA14 are the debugger's"),
    "an output on the crystal": ("mist = {'C', 8}", "mist = {'H', 0}", "PH0 and PH1 are the crystal's"),
    "the door on the serial port": ("door = {'B', 8}", "door = {'A', 10}", "a pin is the serial port's"),
    "a direction on USB": ("{'C', 5}}}", "{'A', 12}}}", "PA11 and PA12 are the USB plug's"),
    "pulses where timer 3 is not": ("{{'A', 6}, 1}", "{{'A', 0}, 1}", "does not have that channel of that timer"),
    "pulses on another channel": ("{{'A', 6}, 1}", "{{'A', 6}, 2}", "does not have that channel of that timer"),
    "pulses on another timer": ("{{'A', 6}, 1}", "{{'A', 6}, 1, 4}", "does not have that channel of that timer"),
    "pulses on the timer of the steps": ("{{'A', 6}, 1}", "{{'C', 9}, 4, 8}", "asks for the step pulses"),
    "no reset button": ("        pins.reset = {'B', 7};\n", "", "a line, input or output has no pin"),
    "a port that is not there": ("flood = {'C', 7}", "flood = {'J', 7}", "a pin is none of A0 to I15"),
    "a pin that is not there": ("flood = {'C', 7}", "flood = {'C', 16}", "a pin is none of A0 to I15"),
    "a second motor's step alone": ("{'C', 5}}}", "{'C', 5}, {'D', 2}}}", "a step without a direction"),
    "pins by their order": ("= [] {\n        PanelPins pins;", "= [] {\n        PanelPins pins{{'B', 12}, {'B', 13}};",
                            "no matching function"),
}
# The same in a table with wires to drives.
WRONG_WIRES = {
    "a drive's wire on a step": ("{{'E', 0}, {'D', 3}", "{{'E', 2}, {'D', 3}", "a pin is named twice"),
    "one wire for two drives": ("{{'E', 0}, {'D', 3}", "{{'D', 3}, {'D', 3}", "a pin is named twice"),
    "pulses on the wires' timer": ("{{'B', 0}, 3}", "{{'E', 9}, 1, 1}", "timer 1 is that of the drives' wires"),
    "steps on the wires' timer": ("Timer8Pace", "Timer1Pace", "timer 1 is that of the drives' wires"),
}

# And in that of a Pico 2.
PICO_TABLES = {"Pico2Table": "boards/pico2_terminals/pico2_table.hpp"}
WRONG_PICO = {
    "mist on a direction": ("mist = GP(14)", "mist = GP(6)", "a pin is named twice"),
    "a limit on the serial port": ("limit_x = GP(16)", "limit_x = GP(1)", "a pin is the serial port's"),
    "an output on the module's own LED": ("flood = GP(13)", "flood = GP(25)", "which the Pico 2 brings out"),
    "a pin that is not there": ("probe = GP(19)", "probe = GP(30)", "which the Pico 2 brings out"),
    "no door": ("        pins.door = GP(20);\n", "", "a line, input or output has no pin"),
    "lines far apart": ("{GP(2), GP(3) & start = GP(22)", "{GP(22), GP(3) & start = GP(2)", "on more than 16 neighbouring pins"),
    "a second motor's step alone": ("GP(8), GP(9)}", "GP(8)}", "a step without a direction"),
    "pins by their order": ("= [] {\n        PicoPanelPins pins;", "= [] {\n        PicoPanelPins pins{GP(16), GP(17)};",
                            "no matching function"),
}
PICO_RULES = """
#include "boards/mill3/pico_traits.hpp"
static_assert(cusp::boards::PicoPinRules<cusp::boards::{name}, cusp::hal::rp2350::UartLink<cusp::hal::rp2350::Chip>>::kHold);
static_assert(cusp::hal::rp2350::PulseWords<cusp::boards::{name}>::kPins > 0);
"""
RULES = """
#include "boards/mill3/pin_rules.hpp"
static_assert(cusp::boards::PinRules<cusp::boards::{name},
    cusp::boards::{name}::SerialPort<cusp::hal::stm32f4::Chip>,
    cusp::boards::{name}::Pace<cusp::hal::stm32f4::Chip>>::kHold);
"""


def compile_table(name, text):
    """The compiler's message; None where it takes the table."""
    source = text.replace("#pragma once\n", "") + (PICO_RULES if name in PICO_TABLES else RULES).format(name=name)
    run = subprocess.run([COMPILER, "-std=c++17", "-DCUSP_AXES=3", "-fsyntax-only", "-x", "c++", "-I", ROOT, "-"],
                         input=source, capture_output=True, text=True, cwd=ROOT)
    return run.stderr if run.returncode else None


def main():
    wrong = []
    tables = {**TABLES, **PICO_TABLES}
    changes = [*(("MillTable", *item) for item in WRONG.items()), *(("Skr2Table", *item) for item in WRONG_WIRES.items()),
               *(("Pico2Table", *item) for item in WRONG_PICO.items())]
    for name, path in tables.items():
        said = compile_table(name, (ROOT / path).read_text())
        if said is not None:
            wrong.append(f"{path} does not compile: {said[:600]}")
    for table, what, (old, new, reason) in changes:
        good = (ROOT / tables[table]).read_text()
        bad = good
        for one, other in zip(old.split(" & "), new.split(" & ")):
            if good.count(one) != 1:
                wrong.append(f"{what}: the table has {good.count(one)} of {one!r}")
            bad = bad.replace(one, other)
        said = compile_table(table, bad)
        if said is None:
            wrong.append(f"{what}: compiles")
        elif reason not in said:
            wrong.append(f"{what}: fails for another reason: {said[:600]}")
        elif len(set(re.findall(r"static assertion failed: (.*)", said))) > 1:
            wrong.append(f"{what}: fails for several reasons: {said[:600]}")
    print("\n".join(wrong) or f"pin_tables: {len(tables)} tables compile, {len(changes)} wrong ones do not")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
