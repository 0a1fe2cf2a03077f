#!/usr/bin/env python3
"""Plants faults in drivers and traits, one at a time, and shows that the co-simulation finds each.

usage: mutations.py --cosim COSIM --cusp CUSP --board mill3_f405|black_pill_f411|skr2_f407 --image IMAGE.bin [-k PATTERN]

The board's main.cpp, which has all drivers in it, is compiled again with one line of one header changed
and linked with the libraries of the build that IMAGE is from; then a short program and one jog run on it.
Exit status: 0 each is found, 1 one is not, 2 something could not be built.
"""
import argparse
import contextlib
import functools
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
PACE = "hal/stm32f4/pace.hpp"
PORTS = "hal/stm32f4/step_ports.hpp"
TABLE = "boards/mill3_f405/mill_table.hpp"
PILL = "boards/black_pill_f411/pill_table.hpp"
SKR2 = "boards/skr2_f407/skr2_table.hpp"
# Faults of a driver: file, its text, the faulty text in its place.
FAULTS = {
    "wrong channel": (PACE, "{1, 7, detail", "{1, 6, detail"),
    "wrong stream": (PACE, "{1, 7, detail", "{2, 7, detail"),
    "flags never acknowledged": (PLAYER, "flag_clear().write(raised & kAllFlags);", ""),
    "acknowledged late": (PLAYER, "    const std::uint32_t raised = flags().read();\n"
                          "    flag_clear().write(raised & kAllFlags);\n",
                          "    const std::uint32_t raised = flags().read();\n"),
    "halves swapped": (PLAYER, "finish_half(first_over ? 1 : 0)", "finish_half(first_over ? 0 : 1)"),
    "half that plays by the counter": (PLAYER, "finish_half(first_over ? 1 : 0)",
                                       "finish_half(stream().ndtr.read() > kPulseTicksPerFrame ? 0 : 1)"),
    "gate shorter than a frame": (PLAYER, "kGateMargin = 20;", "kGateMargin = -200;"),
    "gate two frames long": (PLAYER, "kGateMargin = 20;", "kGateMargin = 1000;"),
    "pace off by one": (PLAYER, "kServoTicksPerSecond) - 1);", "kServoTicksPerSecond));"),
    "port without its clock": ("boards/mill3/chip_traits.hpp", "return ports;", "return ports & ~4U;"),
    "two lines swapped": (PORTS, "return {static_cast<PulseLines>((raise & ~inverted) | (lower & inverted)),",
                          "raise = static_cast<PulseLines>((raise & ~3U) | (raise & 1U) << 1U | (raise >> 1U & 1U));\n"
                          "    return {static_cast<PulseLines>((raise & ~inverted) | (lower & inverted)),"),
    "lines left inputs": (PLAYER, "pin.number, PinMode::kOutput);", "pin.number, PinMode::kInput);"),
    "stream changed while it is on": (PLAYER, "    const std::uint32_t raised = flags().read();",
                                      "    stream().m0ar.write(0x20000000);\n"
                                      "    const std::uint32_t raised = flags().read();"),
    "too few wait states": (TABLE, "168000000, 5, 2, 4, 1}", "168000000, 3, 2, 4, 1}"),
    "slow bus too fast": (TABLE, "168000000, 5, 2, 4, 1}", "168000000, 5, 2, 2, 1}"),
    "voltage too low": (CLOCKS, "set_bits(Chip::power().cr, scale << 14U);",
                        "Chip::power().cr.write(0);"),
    "wrong baud rate": (LINK, "port.brr.write((bus_hz + baud / 2) / baud);",
                        "port.brr.write(bus_hz / 16 / baud);"),
    "limit pins swapped": (TABLE, "limit_x = {'B', 12};\n        pins.limit_y = {'B', 13}",
                            "limit_x = {'B', 13};\n        pins.limit_y = {'B', 12}"),
    "no barrier": ("boards/mill3/mill_image.hpp", '__asm volatile("dsb" ::: "memory");', ""),
}

# These faults on the pill, which has other rates, clocks and pins.
FAULTS_OF_PILL = {
    **FAULTS,
    "wrong channel": (PACE, "{5, 6, detail", "{5, 7, detail"),
    "wrong stream": (PACE, "{5, 6, detail", "{4, 6, detail"),
    "port without its clock": ("boards/mill3/chip_traits.hpp", "return ports;", "return ports & ~2U;"),
    "too few wait states": (PILL, "96000000, 3, 1, 2, 3}", "96000000, 2, 1, 2, 3}"),
    "slow bus too fast": (PILL, "25000000, 96000000, 3", "25000000, 120000000, 3"),
    "limit pins swapped": (PILL, "limit_x = {'B', 5};\n        pins.limit_y = {'B', 6}",
                            "limit_x = {'B', 6};\n        pins.limit_y = {'B', 5}"),
}

# Faults of lines on several ports: planted in the SKR 2, whose three it has.
FAULTS_OF_PORTS = {
    "second stream by the wrong channel": (PACE, "{3, 7, detail", "{3, 6, detail"),
    "third stream on a wrong request": (PACE, "{4, 7, detail::compare_request(3)",
                                        "{4, 7, detail::compare_request(4)"),
    "requests spread over the microsecond": (PLAYER, "timer.cr2.write(kAllRequestsAtUpdate);",
                                             "timer.ccr2.write(40);"),
    "one ring for two ports": (PLAYER, "bus_address(rings_[port].data())",
                               "bus_address(rings_[port / 2].data())"),
    "a word of one port only": (PLAYER, "((rings_[kPort][half][edge.tick] =",
                                "((rings_[0][half][edge.tick] ="),
    "a ring that is not erased": (PLAYER, "__builtin_memset(ring[half].data(), 0, sizeof ring[half]);",
                                  "if (&ring != &rings_.back()) "
                                  "__builtin_memset(ring[half].data(), 0, sizeof ring[half]);"),
    "directions of two ports swapped": (SKR2, "{'E', 1}, {'D', 4}", "{'D', 4}, {'E', 1}"),
    "a port without its clock": ("boards/mill3/chip_traits.hpp", "return ports;", "return ports & ~8U;"),
    "a stream left on at the stop": (PLAYER, "cr1.write(0);\n    for (unsigned port = 0; port < kPorts;",
                                     "cr1.write(0);\n    for (unsigned port = 0; port < 2;"),
    "flags of one stream only cleared": (PLAYER, "stream_flag_clear(Chip::dma2(), number).write(",
                                         "stream_flag_clear(Chip::dma2(), 1).write("),
}

# Faults that would delay a stop; stops_on_chip.py judges. `--stops` plants these, on any board.
APP = "firmware/app/app.hpp"
FAULTS_OF_STOPS = {
    "bytes not seen by the tick": (APP, "        machine_.notice(byte);\n", ""),
    "outputs left to the main loop": (APP, "    if (cut) {\n", "    if (cut && false) {\n"),
    "drives left to the main loop": (APP, "    if (drives_cut) {", "    if (false) {"),
    "outputs on after an underrun": (APP, " || board_.pulse_player.underrun()", ""),
    "a door that cuts nothing": ("firmware/machine/stops.hpp", "kCutting = kHalting | kDoor", "kCutting = kHalting"),
    "a byte that cuts nothing": ("firmware/machine/stops.hpp", "byte_pending(cutting_byte_) ||", "false ||"),
    "an overrun that is not read away": (LINK, "static_cast<void>(Port::usart().dr.read());", ""),
    "a watchdog fed without ticks": ("boards/mill3/main_loop.hpp", "if (ticks != fed_at)", "if (true)"),
}

# Faults of USB; usb_on_chip.py judges. `--usb-faults` plants these, on a board with a plug.
USB, ENDPOINTS, TWO_LINKS = "hal/usb_serial/usb_serial.hpp", "hal/stm32f4/usb_endpoints.hpp", "boards/mill3/two_links.hpp"
FAULTS_OF_USB = {
    "more urgent than the tick": ("hal/cortex_m/cortex_m.hpp", "kUsbPriority = 0xE0", "kUsbPriority = 0x00"),
    "47 MHz": (CLOCKS, "plan.usb_divisor() << 24U", "(plan.usb_divisor() + 1) << 24U"),
    "takes what has no room": (USB, "received_.room() >= kUsbPacket", "true"),
    "never takes more": (USB, "if (there && wants_room_.load(std::memory_order_relaxed)) {", "if (false) {"),
    "waits for a port that is closed": (USB, "return open() ? kSendSize", "return true ? kSendSize"),
    "answers of before": (USB, "send_tail_.store(send_head_.load(std::memory_order_relaxed), std::memory_order_release);", ""),
    "no empty packet": (USB, "full_packet_ = size == kUsbPacket;", "full_packet_ = false;"),
    "toggles kept over a halt": (ENDPOINTS, "(resumed == endpoint ? kUsbDataZero : 0U)", "0U"),
    "toggles kept over a configuration": (ENDPOINTS, "kBulkOut | kUsbDataZero | kUsbSetNak", "kBulkOut | kUsbSetNak"),
    "a request amid an answer": (USB, "    Endpoints::cancel_in(0);\n    control_waits_ = false;\n    const", "    const"),
    "the host's sleep not seen": (USB, "!suspended_ && (control_", "(control_"),
    "one link starves the other": (TWO_LINKS, "other_first_ = !other_first_;", ""),
    "links mixed": (TWO_LINKS, "may_turn() && !amid_line_ && !(text && parks)", "true"),
    "a cut line goes on": (TWO_LINKS, "lost_ = lost_ || ends_line_;", ""),
    "what was lost is not told": (TWO_LINKS, "parked_lost_ = true;\n        }\n    }\n    return false;",
                                  "}\n    }\n    return false;"),
    "never holds": (TWO_LINKS, "return usb.sender_left() && usb_has_turn_;", "return false;"),
}

# Faults of the drives' wires; drives_on_chip.py judges. `--drive-faults` plants these, on a board with wires.
WIRE = "hal/stm32f4/drive_wire.hpp"
FAULTS_OF_DRIVES = {
    "19 kbaud": (WIRE, "kBaud = 40000", "kBaud = 19000"),
    "highest bit first": (WIRE, "(bits >> i & 1U)", "(bits >> (i == 0 || i == 9 ? i : 9 - i) & 1U)"),
    "the wire never turned round": (WIRE, "PinMode::kInput, Pull::kUp);", "PinMode::kOutput);"),
    "the wire left an input": (WIRE, "    set_pin(port(), pin_.number, PinMode::kOutput);\n    phase_", "    phase_"),
    "no stop bit's end": (WIRE, "    words_[count] = high;", "    count -= 2;"),
    "bits read at their edges": (WIRE, "sample + kSamples / 2;", "sample + kSamples - 1;"),
    "an answer cut short": (WIRE, "+ kMostBytes * kBitsOfByte + 12", "+ kMostBytes * kBitsOfByte - 12"),
    "wires of two drives swapped": (SKR2, "{'E', 0}, {'D', 3}", "{'D', 3}, {'E', 0}"),
    "another sense resistor": (SKR2, "kSenseMilliohms = 110", "kSenseMilliohms = 75"),
    "drives never asked": (APP, "    serve_drives();\n", ""),
    "an erase amid an answer": (APP, "if (board_.drive_wire.let_go()) {", "if (false) {"),
    "a request that is given up counts": (APP, "machine_.drives().put_off(", "machine_.drives().take({}, "),
    "a request given up on a wire that is driven": (WIRE, "Pull::kUp);\n    halt();", "Pull::kUp);\n    set_pin(port(), "
                                                    "pin_.number, PinMode::kOutput);\n    halt();"),
}


# Faults of the drives' bus; bus_drives_on_chip.py judges. `--bus-faults` plants these, on skr2_f407.
BUS = "hal/stm32f4/drive_bus.hpp"
FAULTS_OF_BUS = {
    "bits closer than a drive takes them": (BUS, "kPauseReads = 16", "kPauseReads = 1"),
    "lowest bit of a byte first": (BUS, "byte >> (bit - 1)", "byte >> (kBitsOfByte - bit)"),
    "the clock upside down": (BUS, "kDriveBus.clock, false);\n            pause();", "kDriveBus.clock, true);\n            pause();"),
    "the answer to the datagram before": (BUS, "        exchange(drive, {}, answer);\n", ""),
    "one long datagram": (BUS, "        put(select, true);\n", ""),
    "the other level selects": (BUS, "put(select, false);", "put(select, true);"),
    "pins left as inputs": ("boards/mill3/chip_traits.hpp", "            DriveBus::rest();\n", ""),
    "data and clock swapped": (SKR2, "{{'E', 15}, {'E', 14}", "{{'E', 14}, {'E', 15}"),
    "the answer from another pin": (SKR2, "{'A', 14}}", "{'E', 13}}"),
    "select lines of two drives swapped": (SKR2, "{'E', 0}, {'D', 3}", "{'D', 3}, {'E', 0}"),
    "another resistor": (SKR2, "kBusSenseMilliohms = 75", "kBusSenseMilliohms = 110"),
    "answers not taken": (APP, "drives.take({bytes.data(), bytes.size()}, tick);", ""),
}


# Faults of the spindle's line; spindle_on_chip.py judges. `--spindle-faults` plants these, on a board with one.
SPINDLE_WIRE = "hal/stm32f4/spindle_wire.hpp"
FAULTS_OF_SPINDLE = {
    "the transceiver left on": (SPINDLE_WIRE, "    talk(false);\n    run(receive", "    run(receive"),
    "the transceiver never on": (SPINDLE_WIRE, "    talk(true);\n", ""),
    "half the rate": (SPINDLE_WIRE, "/ baud);\n    port.cr3", "/ baud * 2);\n    port.cr3"),
    "never hears": (SPINDLE_WIRE, "port.cr1.write(kPortEnable | kReceiver);", ""),
    "an erase amid a message": (APP, "if (board_.spindle_wire.let_go()) {", "if (false) {"),
    "a pending stop not told": ("firmware/machine/machine.hpp", "tell_vfd(cuts_outputs())", "tell_vfd(false)"),
    "never spoken to": (APP, "    serve_spindle();\n", ""),
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
            compiler, words = command.split(" ", 1)
            self.run(f"{compiler}{flags} {words}")  # the changed header is looked for first
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
    """The fault that the co-simulation finds in an image, or None."""
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
            machine.pin(machine.pins["limit X"], 0)
            steps = machine.steps_after_an_underrun()[1]
            if steps != [800, 800, 800]:
                return f"after an underrun 1 mm is {steps} steps"
            machine.ask("$J=G91 X30 F3000")
            machine.run(200)
            machine.changes()
            machine.command("core stop")
            machine.run(50)
            steps = machine.steps(machine.changes())
            if steps > 44:  # 40 a frame
                return f"{steps} steps after the core stood still"
    except (AssertionError, CosimFailed, on_chip.RunFailed) as error:
        return str(error).strip().splitlines()[-1]
    return None


def find_by(script, options, image):
    """The report of a script on an image; None if it finds nothing."""
    done = subprocess.run([sys.executable, str(pathlib.Path(__file__).with_name(script)), "--cosim", options.cosim,
                           "--board", options.board, "--cusp", options.cusp, "--image", str(image)],
                          capture_output=True, text=True)
    failed = re.findall(r"^(?:FAIL|ERROR): (\w+)", done.stderr, re.M) or re.findall(r"^(\w+): (?!holds)", done.stdout, re.M)
    return None if done.returncode == 0 else f"{len(failed)} failures: {', '.join(sorted(set(failed)))}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("cosim", "cusp", "board", "image"):
        parser.add_argument(f"--{name}", required=True)
    sets = {"stops": ("the faults that delay a stop", "stops_on_chip.py", FAULTS_OF_STOPS),
            "usb-faults": ("the faults of USB and of two links", "usb_on_chip.py", FAULTS_OF_USB),
            "drive-faults": ("the faults of the drives' wires", "drives_on_chip.py", FAULTS_OF_DRIVES),
            "bus-faults": ("the faults of the drives' bus", "bus_drives_on_chip.py", FAULTS_OF_BUS),
            "spindle-faults": ("the faults of the spindle's line", "spindle_on_chip.py", FAULTS_OF_SPINDLE)}
    for name, (what, _, _) in sets.items():
        parser.add_argument(f"--{name}", dest="chosen", action="store_const", const=name, help=what)
    parser.add_argument("-k", default="", help="the faults whose name has this")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        program = folder / "short.ngc"
        program.write_text("G91 G1 X1 Y0.5 Z-0.2 F1200\nG0 X-1\nG2 X1 Y1 I0.5 J0.5\nM2\n")
        options.program, options.settings, options.script = program, None, None
        options.as_it_is = options.may_stand_still = options.usb = False
        options.chip_seconds = options.seconds = 0.0
        options.most_ticks = 20000  # ten times what it takes
        missed = []
        by_board = {"skr2_f407": FAULTS_OF_PORTS, "black_pill_f411": FAULTS_OF_PILL}
        _, script, faults = sets.get(options.chosen, ("", None, by_board.get(options.board, FAULTS)))
        look = functools.partial(find_by, script) if script else find
        try:
            builder = Builder(options.image, folder)
            said = look(options, builder.make(PACE, "kClockBit = 1;", "kClockBit = 1 ;"))
            print(f"no fault: {said}")
            missed += ["no fault"] if said else []
            faults = {name: fault for name, fault in faults.items() if re.search(options.k, name)}
            for fault, (file, old, new) in faults.items():
                said = look(options, builder.make(file, old, new))
                print(f"{fault}: {said or 'NOT FOUND'}", flush=True)
                missed += [] if said else [fault]
        except (OSError, subprocess.CalledProcessError, StopIteration) as error:
            print(f"mutations: {error}", file=sys.stderr)
            return 2
    print(f"{len(faults)} faults planted; wrong: {missed or 'none'}")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
