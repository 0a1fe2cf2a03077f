// The mill controller's image: every object of the firmware is a static of this file.
#include "boards/mill3/mill_board.hpp"
#include "boards/mill3_f405/board_traits.hpp"
#include "firmware/app/app.hpp"
#include "hal/stm32f4/vectors.hpp"

namespace {

using namespace cusp;
using Traits = boards::MillTraits;
using Board = boards::MillBoard<Traits>;
static_assert(hal::is_board<Board>());

Board board;
app::App<Board> application{board};

}  // namespace

extern "C" {

// tests/checks/image.py proves what these three may reach.
void cusp_servo_tick() { application.tick(); }

void cusp_player_interrupt()
{
    if (board.pulse_player.on_interrupt()) {
        hal::stm32f4::pend_servo_tick<Traits::Chip>();
    }
}

void cusp_board_stop() { Traits::stop(); }

void cusp_serial_interrupt() { board.byte_link.on_interrupt(); }
}

namespace {

constexpr std::array<hal::stm32f4::InterruptEntry, 2> kInterrupts{{
    {Traits::Pace::kInterrupt, cusp_player_interrupt},
    {hal::stm32f4::kUsart1Interrupt, cusp_serial_interrupt},
}};

__attribute__((section(".vectors"), used)) constexpr hal::stm32f4::VectorTable kVectors =
    hal::stm32f4::make_vectors(
        &cusp_stack_top, cusp_reset, cusp_exception, cusp_servo_tick, kInterrupts);

}  // namespace

void cusp_main() { Traits::run(board, application); }
