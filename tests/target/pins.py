"""Reads what reached the step port's pins from QEMU's log with the plugin pins/pin_watch.cpp."""
import array
import re

from qemu import RunFailed

# GPIOC's set/reset register is the one that the player writes; the six lines are pins 0 to 5.
WRITE = re.compile(r"GPIOC: unimplemented device write \(size 4, offset 0x018, value 0x(\w+)\)")
LINES = 0x3F


def options_of(plugin, log):
    """QEMU's options: the plugin gives the time, its log of unmodelled stores the value."""
    return ["-plugin", str(plugin), "-d", "unimp,plugin", "-D", str(log)]


def read_pins(log):
    """Two lists, an item each time that a pin changes: instructions so far, levels of the lines."""
    times, levels = array.array("Q"), array.array("B")
    now, waiting = 0, None
    with open(log, errors="replace") as file:
        for line in file:
            match = WRITE.match(line)
            if match is not None:
                if waiting is not None:
                    raise RunFailed(f"{log}: a store to the port has no time")
                waiting = int(match.group(1), 16)
            elif line.startswith("pin "):
                if waiting is None:
                    raise RunFailed(f"{log}: a store to the port has no value")
                after = (now & ~(waiting >> 16) | waiting) & LINES
                if after != now:
                    times.append(int(line[4:]))
                    levels.append(after)
                now, waiting = after, None
    return times, levels


def first_difference(edges, pins):
    """Difference of the trace (tick * 256 + levels) and the pins, None if there is none.

    The trace's ticks rise, so each change of the pins has its tick from the trace; the pins must
    change in the same order, to the same levels, and never two edges at one instruction.
    """
    times, levels = pins
    if len(edges) != len(levels):
        return f"{len(edges)} edges in the trace, {len(levels)} changes of the pins"
    for place, edge in enumerate(edges):
        if edge & 0xFF != levels[place]:
            return (f"edge {place} at tick {edge >> 8}: levels {edge & 0xFF:06b} in the trace, "
                    f"{levels[place]:06b} on the pins")
        if place and times[place] <= times[place - 1]:
            return f"edge {place}: the pins' times do not rise"
    return None
