// The image of an SKR 2 with an STM32F429 behind the maker's boot loader.
#include "boards/mill3/chip_traits.hpp"
#include "boards/skr2_f429/skr2_f429_table.hpp"

namespace cusp::boards {

struct BehindLoader : Skr2F429Table {
    using Settings = hal::stm32f4::SettingsAtEndOf1M;
};

using Traits = ChipTraits<BehindLoader>;

}  // namespace cusp::boards

#include "boards/mill3/mill_main.inc"
