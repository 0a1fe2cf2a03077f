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
# Changes to the first table, and what the compiler must say of each.
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


def compile_table(name, text):
    """What the compiler says; None where it takes the table."""
    source = text.replace("#pragma once\n", "") + f"""
#include "boards/mill3/pin_rules.hpp"
static_assert(cusp::boards::PinRules<cusp::boards::{name},
    cusp::boards::{name}::SerialPort<cusp::hal::stm32f4::Chip>,
    cusp::boards::{name}::Pace<cusp::hal::stm32f4::Chip>>::kHold);
"""
    run = subprocess.run([COMPILER, "-std=c++17", "-fsyntax-only", "-x", "c++", "-I", ROOT, "-"],
                         input=source, capture_output=True, text=True, cwd=ROOT)
    return run.stderr if run.returncode else None


def main():
    wrong = []
    for name, path in TABLES.items():
        said = compile_table(name, (ROOT / path).read_text())
        if said is not None:
            wrong.append(f"{path} does not compile: {said[:600]}")
    for table, what, (old, new, reason) in [*(("MillTable", *item) for item in WRONG.items()),
                                            *(("Skr2Table", *item) for item in WRONG_WIRES.items())]:
        good = (ROOT / TABLES[table]).read_text()
        if good.count(old) != 1:
            wrong.append(f"{what}: the table has {good.count(old)} of {old!r}")
            continue
        said = compile_table(table, good.replace(old, new))
        if said is None:
            wrong.append(f"{what}: compiles")
        elif reason not in said:
            wrong.append(f"{what}: fails for another reason: {said[:600]}")
        elif len(set(re.findall(r"static assertion failed: (.*)", said))) > 1:
            wrong.append(f"{what}: fails for several reasons: {said[:600]}")
    print("\n".join(wrong) or f"pin_tables: {len(TABLES)} tables compile, {len(WRONG) + len(WRONG_WIRES)} wrong ones do not")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
