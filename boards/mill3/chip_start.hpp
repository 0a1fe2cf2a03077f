// ChipStart: start, main loop and end that all boards with a chip of the STM32F4 family share.
//
// A traits type of a board says: which parts it is made of (Chip, StepPort, PulsePlayer, ByteLink,
// Panel, SettingsStore); start(board), called before the application exists; run(board,
// application), the main loop; stop(), the end after a fault; and what its parts ask of it
// (kSpindleTimer, kPanelPins ...).
#pragma once

#include <cstdint>

#include "hal/stm32f4/chip.hpp"
#include "hal/stm32f4/clock_tree.hpp"
#include "hal/stm32f4/pins.hpp"
#include "hal/stm32f4/reset_reason.hpp"
#include "hal/stm32f4/watchdog.hpp"

namespace cusp::boards {

// `Own` is the traits type that inherits this: it has kClocks, kBaud, Pace, PulsePlayer and Panel.
template <class Own>
struct ChipStart {
    using Chip = hal::stm32f4::Chip;

    // Whether the end of a frame calls for the servo tick.
    static constexpr bool live() noexcept { return true; }
    static constexpr unsigned player_interrupt() noexcept { return Own::Pace::kInterrupt; }

    template <class Board>
    static void start(Board& board) noexcept
    {
        using namespace hal::stm32f4;
        note_reset_cause<Chip>();
        clock_source_ = start_clocks<Chip>(Own::kClocks);
        if (clock_source_ == ClockSource::kNone) {
            fault("the clock did not start", __FILE__, __LINE__);
        }
        start_peripherals<Chip>(Own::Pace::kClockBit);
        Own::Panel::start();
        set_pin_function(Chip::port_a(), 9, 7);
        set_pin_function(Chip::port_a(), 10, 7);
        enable_interrupt<Chip>(kUsart1Interrupt, kSerialPriority);
        enable_interrupt<Chip>(kTransmitStreamInterrupt, kSerialPriority);
        board.byte_link.start(Own::kClocks.fast_bus_hz(), Own::kBaud);
        set_field(Chip::system().shpr3, 16, 8, kServoTickPriority);
    }

    // After a fault: all that moves is switched off, then a fresh start that tells the reason.
    [[noreturn]] static void stop() noexcept
    {
        Own::PulsePlayer::stop();
        Own::Panel::switch_everything_off();
        hal::stm32f4::reset_chip<Chip>();
    }

    // After each servo tick: what a reset from now on means for the position.
    template <class Board>
    static void after_tick(const Board& board) noexcept
    {
        hal::stm32f4::mark_motion(board.pulse_player.moving());
    }

    template <class Board, class Application>
    [[noreturn]] static void run(Board& board, Application& application) noexcept
    {
        using namespace hal::stm32f4;
        report_reset(board.byte_link, clock_source_);
        enable_interrupt<Chip>(player_interrupt(), kPlayerPriority);
        board.pulse_player.start(Own::kClocks.fast_timer_hz(), Own::kClocks.slow_timer_hz(),
                                 reset_amid_motion());
        start_watchdog<Chip>();
        for (;;) {
            feed_watchdog<Chip>();
            if (!application.poll()) {
                __asm volatile("wfi");
            }
        }
    }

private:
    static inline hal::stm32f4::ClockSource clock_source_{hal::stm32f4::ClockSource::kNone};
};

}  // namespace cusp::boards
