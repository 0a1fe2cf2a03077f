// The body of a board's main.cpp: the image of cusp::boards::Traits, and what the vectors call of it.
//
//   namespace cusp::boards { using Traits = ChipTraits<MyTable>; }
//   #include "boards/mill3/mill_main.hpp"
#pragma once

#include "boards/mill3/mill_image.hpp"

namespace {

using Image = cusp::boards::MillImage<cusp::boards::Traits>;

Image image;

__attribute__((section(".vectors"), used)) constexpr cusp::hal::stm32f4::VectorTable kVectors =
    Image::vectors();

}  // namespace

// tests/checks/image.py proves what the first three may reach.
extern "C" {
void cusp_servo_tick() { image.servo_tick(); }
void cusp_player_interrupt() { image.player_interrupt(); }
void cusp_serial_interrupt() { image.serial_interrupt(); }
void cusp_board_stop() { cusp::boards::Traits::stop(); }
}

void cusp_main() { image.run(); }
