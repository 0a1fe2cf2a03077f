// BoardPage: wiring and flashing of a board as a page in Markdown, from its table. For programs of the host.
#pragma once

#include <array>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "boards/mill3/pin_rules.hpp"
#include "hal/stm32f4/chip.hpp"

namespace cusp::boards {

// `Table` as in boards/mill3/chip_traits.hpp. A table that pin_rules.hpp refuses does not compile here either.
template <class Table>
class BoardPage {
    using Chip = hal::stm32f4::Chip;
    using SerialPort = typename Table::template SerialPort<Chip>;
    static_assert(PinRules<Table, SerialPort, typename Table::template Pace<Chip>>::kHold);

public:
    // `out` must outlive this. `chip`: "STM32F407".
    BoardPage(std::ostream& out, std::string_view name, std::string_view chip)
        : out_{out}, name_{name}, chip_{chip}
    {
    }

    void write()
    {
        write_head();
        write_lines();
        write_motors();
        write_inputs();
        write_outputs();
        write_plugs();
        write_notes();
        write_flashing();
    }

private:
    static constexpr const PanelPins& kPins = Table::kPanelPins;
    static constexpr unsigned kHertzPerMegahertz = 1000000;

    struct Signal {
        std::string name;
        Pin pin;
    };
    // One row for all that the board has; without any there is no row.
    void row(const std::vector<Signal>& signals,
             std::string_view level,
             std::string_view where = "")
    {
        std::string names;
        std::string pins;
        for (const Signal& signal : signals) {
            if (is_there(signal.pin)) {
                names += (names.empty() ? "" : ", ") + signal.name;
                pins += (pins.empty() ? "P" : ", P") + std::string{signal.pin.port} +
                        std::to_string(signal.pin.number);
            }
        }
        if (!names.empty()) {
            out_ << "| " << names << " | " << pins << " | " << level << " | " << where << " |\n";
        }
    }

    void write_head()
    {
        constexpr const auto& kClocks = Table::kClocks;
        out_ << "# " << name_ << ": a 3-axis mill controller\n\n"
             << "An " << chip_ << " at " << kClocks.core_hz / kHertzPerMegahertz << " MHz with "
             << (kClocks.external ? "a clock from outside" : "a crystal") << " of "
             << kClocks.crystal_hz / kHertzPerMegahertz
             << " MHz. Written from the board's table: change that, not this page.\n\n"
             << "## Wiring\n\nAll signals are 3.3 V. Pins not listed are unused.\n\n"
             << "| signal | pin | level | notes |\n|---|---|---|---|\n";
    }
    void write_lines()
    {
        const auto& lines = Table::kLines;
        row({{"X step", lines[0]}, {"Y step", lines[1]}, {"Z step", lines[2]}}, "high = step",
            "`$0` us wide");
        row({{"X direction", lines[3]}, {"Y direction", lines[4]}, {"Z direction", lines[5]}},
            "high = plus", "`$29` us before the step");
        row({{"second motor step", lines[6]}, {"second motor direction", lines[7]}},
            "as the axis that `$793` names");
    }
    void write_motors()
    {
        const auto& off = kPins.drives_off;
        if (is_there(off[1])) {
            row({{"drives enable X", off[0]},
                 {"drives enable Y", off[1]},
                 {"drives enable Z", off[2]},
                 {"drives enable second", off[3]}},
                "low = drives have current");
        } else {
            row({{"drives enable", off[0]}}, "low = drives have current", "one line for all");
        }
        const auto& wires = detail::drive_pins<Table>;
        row({{"X drive UART", wires[0]},
             {"Y drive UART", wires[1]},
             {"Z drive UART", wires[2]},
             {"second drive UART", wires[3]}},
            "40 kbaud", "TMC2209");
        const auto& bus = detail::drive_bus_pins<Table>;
        row({{"drives SPI clock", bus.clock},
             {"drives SPI out", bus.to_drives},
             {"drives SPI in", bus.from_drives}},
            "mode 3", "TMC5160, selected by the pin above");
        row({{"drives power", kPins.power}}, "high from the start on");
    }
    void write_inputs()
    {
        constexpr std::string_view kClosed = "normally closed to ground; pull-up inside";
        row({{"limit X", kPins.limit_x}, {"Y", kPins.limit_y}, {"Z", kPins.limit_z}},
            "high = tripped", kClosed);
        row({{"limit second", kPins.second_limit}}, "high = tripped", "read with `$794=1` alone");
        row({{"probe", kPins.probe}}, "high = touched",
            "for a plate that closes to ground set `$6=1`");
        row({{"door", kPins.door}, {"hold", kPins.hold}, {"reset", kPins.reset}}, "high = pressed",
            kClosed);
        row({{"start", kPins.start}}, "high = pressed", "contact to 3.3 V; pull-down inside");
        row({{"emergency stop", kPins.emergency_stop}, {"motor fault", kPins.motor_fault}},
            "high = tripped", kClosed);
        row({{"spindle at speed", kPins.at_speed}}, "low = at speed", "read with `$797=1`");
    }
    void write_outputs()
    {
        row({{"flood", kPins.flood}, {"mist", kPins.mist}}, "high = on");
        row({{"spindle on", kPins.spindle_on}, {"spindle reverse", kPins.spindle_reverse}},
            "high = on, high = M4");
        row({{"spindle pulses", kPins.spindle_pulses.pin}}, "`$33` Hz, 0 to 100 %",
            "timer " + std::to_string(kPins.spindle_pulses.timer) + ", channel " +
                std::to_string(kPins.spindle_pulses.channel));
        const auto& line = detail::spindle_wire_pins<Table>;
        row({{"spindle transmit", line.transmit}, {"receive", line.receive}, {"sends", line.sends}},
            "`$374` baud, 8N1", "an RS-485 transceiver's DI, RO, and DE with RE");
    }
    void write_plugs()
    {
        row({{"serial transmit", SerialPort::kTransmit}, {"receive", SerialPort::kReceive}},
            std::to_string(Table::kBaud) + " baud, 8N1", "to an adapter's RX and TX");
        if (detail::has_usb<Table>) {
            row({{"USB minus", hal::stm32f4::kUsbMinus}, {"plus", hal::stm32f4::kUsbPlus}},
                "full speed", "a serial port");
        }
        row({{"debug", {'A', 13}}, {"debug clock", {'A', 14}}}, "SWDIO, SWCLK");
    }
    void write_notes()
    {
        out_ << "\nAn input that is not wired reads as tripped, and the machine stays in alarm 10: "
                "`$14` inverts controls one by one (1 reset, 2 hold, 4 start, 8 door, 64 emergency "
                "stop, 256 motor fault), and `$14=331` is a board with none of them wired. For "
                "limits that close when tripped set `$5=1`.\n\n"
                "Outputs float until the kept settings say which level is off: give spindle, "
                "coolant and PWM lines a pull-down, the enable lines a pull-up.\n\n"
             << "The board plays " << Table::kMostStepsPerSecond
             << " steps/s on each axis; settings that ask for more are refused. Look at the step "
                "lines with a logic analyser before a motor is connected.\n";
    }
    void write_flashing()
    {
        out_ << "\n## Flashing\n\n| with | command |\n|---|---|\n"
             << "| ST-Link, stlink-tools | `st-flash --format ihex write " << name_ << ".hex` |\n"
             << "| ST-Link, OpenOCD | `openocd -f interface/stlink.cfg -f target/stm32f4x.cfg -c "
                "\"program "
             << name_ << ".elf verify reset exit\"` |\n";
        if (detail::has_usb<Table>) {
            out_ << "| USB, the chip's own loader | BOOT0 to 3.3 V, reset, then `dfu-util -a 0 -s "
                    "0x08000000:leave -D "
                 << name_ << ".bin` |\n";
        }
    }

    std::ostream& out_;
    const std::string name_;
    const std::string chip_;
};

}  // namespace cusp::boards
