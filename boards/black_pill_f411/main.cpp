// The small controller's image.
#include "boards/black_pill_f411/pill_traits.hpp"
#include "boards/mill3/mill_image.hpp"

namespace {

using Traits = cusp::boards::PillTraits;
using Image = cusp::boards::MillImage<Traits>;

Image image;

__attribute__((section(".vectors"), used)) constexpr cusp::hal::stm32f4::VectorTable kVectors =
    Image::vectors();

}  // namespace

// tests/checks/image.py proves what the first three may reach.
extern "C" {
void cusp_servo_tick() { image.servo_tick(); }
void cusp_player_interrupt() { image.player_interrupt(); }
void cusp_serial_interrupt() { image.serial_interrupt(); }
void cusp_board_stop() { Traits::stop(); }
}

void cusp_main() { image.run(); }
