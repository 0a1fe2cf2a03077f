// Counts what the RP2350's player takes of a frame with an edge in each microsecond, the most that there can be.
#pragma once

#include "firmware/base/assert.hpp"
#include "hal/rp2350/pio_pulse_player.hpp"
#include "tests/target/budget/instruction_meter.hpp"

namespace cusp::test {

// QEMU has neither its DMA nor its PIO: the registers are plain memory, the queue always full.
struct StillPico {
    using Word = hal::cortex_m::DeviceWord;
    static inline hal::rp2350::Dma<Word> still_dma{};
    static inline hal::rp2350::Pio<Word> still_pio{};
    static inline hal::rp2350::PinFunctions<Word> still_functions{};
    static inline hal::rp2350::Pads<Word> still_pads{};
    static inline hal::rp2350::CorePins<Word> still_pins{};
    static auto& dma() noexcept { return still_dma; }
    static auto& pio0() noexcept { return still_pio; }
    static auto& functions() noexcept { return still_functions; }
    static auto& pads() noexcept { return still_pads; }
    static auto& core_pins() noexcept { return still_pins; }
    static std::uint32_t bus_address(const volatile void* memory) noexcept
    {
        return hal::cortex_m::Core::bus_address(memory);
    }
};
struct StillLines {
    static constexpr hal::rp2350::LinePins kLines{
        {hal::rp2350::GP(2), hal::rp2350::GP(3), hal::rp2350::GP(4), hal::rp2350::GP(5),
         hal::rp2350::GP(6), hal::rp2350::GP(7), hal::rp2350::GP(8), hal::rp2350::GP(9)}};
};

// `player` is a static: its halves are large. `full`: the frame.
template <class Out>
void count_pio(hal::rp2350::PioPulsePlayer<StillPico, StillLines>& player,
               const PulseFrame& full,
               Out& out)
{
    InstructionMeter fill{"player_pio_full"};
    StillPico::still_pio.flevel.write(8);
    player.start(150000000);
    for (unsigned tick = 0; tick < 20; ++tick) {
        fill.begin();
        const bool taken = player.try_play(full);
        static_cast<void>(player.on_interrupt());
        fill.end();
        CUSP_ASSERT(taken && !player.underrun());
    }
    fill.report(out);
}

}  // namespace cusp::test
