// The image of an SKR 2 with an STM32F429.
#include "boards/mill3/chip_traits.hpp"
#include "boards/skr2_f429/skr2_f429_table.hpp"

namespace cusp::boards {

using Traits = ChipTraits<Skr2F429Table>;

}  // namespace cusp::boards

#include "boards/mill3/mill_main.inc"
