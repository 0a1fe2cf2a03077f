// ChipTraits: the mill controller on the chip itself.
//
// A traits type of this board says: which parts it is made of (PulsePlayer, ByteLink, Panel,
// SettingsStore); start(board), called before the application exists; run(board, application), the
// main loop; and the two rules kTransmitInterrupt and kSpindleTimer.
#pragma once

#include <cstdint>

#include "boards/mill3_f405/mill_panel.hpp"
#include "hal/stm32f4/chip.hpp"
#include "hal/stm32f4/clock_tree.hpp"
#include "hal/stm32f4/dma_pulse_player.hpp"
#include "hal/stm32f4/flash_settings.hpp"
#include "hal/stm32f4/reset_reason.hpp"
#include "hal/stm32f4/usart_link.hpp"
#include "hal/stm32f4/watchdog.hpp"

namespace cusp::boards {

struct ChipTraits {
    using Chip = hal::stm32f4::Chip;
    using PulsePlayer = hal::stm32f4::DmaPulsePlayer<Chip, StepPort<Chip>>;
    using ByteLink = hal::stm32f4::UsartLink<Chip, ChipTraits>;
    using Panel = MillPanel<Chip, ChipTraits>;
    using SettingsStore = hal::stm32f4::FlashSettings<Chip>;

    static constexpr bool kTransmitInterrupt = true;
    static constexpr bool kSpindleTimer = true;
    static constexpr std::uint32_t kCrystalHz = 8000000;
    static constexpr std::uint32_t kBaud = 115200;

    template <class Board>
    static void start(Board& board) noexcept
    {
        using namespace hal::stm32f4;
        if (start_clocks<Chip>(kCrystalHz) == ClockSource::kNone) {
            fault("the clock did not start", __FILE__, __LINE__);
        }
        start_peripherals<Chip>();
        Panel::start();
        set_pin_function(Chip::port_a(), 9, 7);
        set_pin_function(Chip::port_a(), 10, 7);
        enable_interrupt<Chip>(kUsart1Interrupt, kSerialPriority);
        board.byte_link.start(kFastBusHz, kBaud);
        set_field(Chip::system().shpr3, 16, 8, kServoTickPriority);
    }

    template <class Board, class Application>
    [[noreturn]] static void run(Board& board, Application& application) noexcept
    {
        using namespace hal::stm32f4;
        report_last_fault(board.byte_link);
        enable_interrupt<Chip>(kDma2Stream1Interrupt, kPlayerPriority);
        board.pulse_player.start(kFastTimerHz);
        start_watchdog<Chip>();
        for (;;) {
            feed_watchdog<Chip>();
            if (!application.poll()) {
                __asm volatile("wfi");
            }
        }
    }
};

}  // namespace cusp::boards
