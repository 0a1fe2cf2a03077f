// DriveBus: TMC5160 drives on three wires that they share (SPI, mode 3) on any pins, a bit at a time.
//
// A select line for each, low while it is spoken to: the pin of its socket that is a TMC2209's wire. The main
// loop writes and reads the bits; who interrupts it only makes one last longer. Two datagrams take some 50 us.
// Never tried on silicon; runs against a model of the drives in tests/target/cosim.
#pragma once

#include <cstdint>

#include "firmware/base/span.hpp"
#include "hal/stm32f4/pins.hpp"

namespace cusp::hal::stm32f4 {

// A board may lack all.
struct DriveBusPins {
    Pin clock;
    Pin to_drives;
    Pin from_drives;  // may be the debugger's clock: it is read and pulled up, no more
};

// `Table` has kDriveWires, the select lines, and kDriveBus, a DriveBusPins.
template <class Chip, class Table>
class DriveBus {
public:
    // The clock rests high. The select lines are DriveWire's at rest. Uses no statics.
    // Precondition: the clocks of the ports are on.
    static void rest() noexcept
    {
        constexpr Pin kFrom = Table::kDriveBus.from_drives;
        set_field(Chip::port(kFrom.port).pupdr, kFrom.number * 2, 2,
                  static_cast<std::uint32_t>(Pull::kUp));
        for (const Pin pin : {Table::kDriveBus.clock, Table::kDriveBus.to_drives}) {
            set_level(Chip::port(pin.port), pin.number, true);
            set_pin(Chip::port(pin.port), pin.number, PinMode::kOutput);
        }
    }

    // See hal/contract/board.hpp.
    void ask(unsigned drive,
             Span<const std::uint8_t> bytes,
             Span<std::uint8_t> answer) const noexcept
    {
        exchange(drive, bytes, answer);
        exchange(drive, {}, answer);
    }

private:
    static constexpr unsigned kBitsOfByte = 8;
    // Reads of a port between two edges: with the loop more than 0.2 us, twice what a drive with the slowest
    // clock of its own needs.
    static constexpr unsigned kPauseReads = 16;

    static void pause() noexcept
    {
        for (unsigned i = 0; i < kPauseReads; ++i) {
            static_cast<void>(Chip::port(Table::kDriveBus.clock.port).idr.read());
        }
    }
    static void put(Pin pin, bool level) noexcept
    {
        set_level(Chip::port(pin.port), pin.number, level);
    }
    // Zeros after the last of `bytes`.
    static void exchange(unsigned drive,
                         Span<const std::uint8_t> bytes,
                         Span<std::uint8_t> answer) noexcept
    {
        const Pin select = Table::kDriveWires[drive];
        // It may have been left as an input.
        set_pin(Chip::port(select.port), select.number, PinMode::kOutput);
        put(select, false);
        pause();
        for (std::size_t i = 0; i < answer.size(); ++i) {
            answer[i] = exchange(i < bytes.size() ? bytes[i] : std::uint8_t{0});
        }
        put(select, true);
        pause();
        pause();
    }
    // Both ends change their line as the clock falls, and read as it rises.
    static std::uint8_t exchange(unsigned byte) noexcept
    {
        constexpr Pin kFrom = Table::kDriveBus.from_drives;
        unsigned heard = 0;
        for (unsigned bit = kBitsOfByte; bit > 0; --bit) {
            put(Table::kDriveBus.to_drives, (byte >> (bit - 1) & 1U) != 0);
            put(Table::kDriveBus.clock, false);
            pause();
            heard = heard << 1U | (Chip::port(kFrom.port).idr.read() >> kFrom.number & 1U);
            put(Table::kDriveBus.clock, true);
            pause();
        }
        return static_cast<std::uint8_t>(heard);
    }
};

}  // namespace cusp::hal::stm32f4
