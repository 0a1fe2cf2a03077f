// MillImage: all objects of a mill controller's firmware, and the entries of its interrupts.
#pragma once

#include "boards/mill3/mill_board.hpp"
#include "firmware/app/app.hpp"
#include "hal/cortex_m/cortex_m.hpp"
#include "hal/cortex_m/vectors.hpp"

namespace cusp::boards {

// A board's main.cpp has one, as a static, and hands it what the vectors call; `Traits` as in
// boards/mill3/chip_traits.hpp.
template <class Traits>
class MillImage {
    using Board = MillBoard<Traits>;
    static_assert(hal::is_board<Board>());

public:
    // The queue lies apart, where the linker script has core-coupled memory for it.
    explicit MillImage(planner::PathQueue& queue) noexcept : application_{board_, queue} {}

    void servo_tick() noexcept
    {
        application_.tick();
        Traits::after_tick(board_);
        finish_stores();
    }
    void player_interrupt() noexcept
    {
        if (board_.pulse_player.on_interrupt() && Traits::live()) {
            hal::cortex_m::pend_servo_tick<typename Traits::Chip>();
        }
        finish_stores();
    }
    void serial_interrupt() noexcept
    {
        board_.byte_link.on_interrupt();
        if constexpr (hal::has_drive_wire<Board>) {
            board_.drive_wire.on_interrupt();
        }
        if constexpr (hal::has_spindle_wire<Board>) {
            board_.spindle_wire.on_interrupt();
        }
        finish_stores();
    }
    void usb_interrupt() noexcept
    {
        if constexpr (Traits::kUsb) {
            board_.byte_link.usb.on_interrupt();
        }
        finish_stores();
    }
    [[noreturn]] void run() noexcept { Traits::run(board_, application_); }

    static constexpr auto vectors() noexcept
    {
        return hal::cortex_m::make_vectors<Traits::kInterruptCount>(
            &cusp_stack_top, cusp_reset, cusp_exception, cusp_servo_tick, Traits::interrupts());
    }

private:
    // Erratum 838869 of the Cortex-M4: with a store under way at the end of an exception the next
    // may be entered by a wrong vector.
    static void finish_stores() noexcept { __asm volatile("dsb" ::: "memory"); }

    Board board_;
    app::App<Board> application_;
};

}  // namespace cusp::boards
