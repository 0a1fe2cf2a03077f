// The image of an Octopus with an STM32F429 behind the maker's boot loader.
#include "boards/mill3/chip_traits.hpp"
#include "boards/octopus_f429/octopus_f429_table.hpp"

namespace cusp::boards {

struct BehindLoader : OctopusF429Table {
    using Settings = hal::stm32f4::SettingsAtEndOf1M;
};

using Traits = ChipTraits<BehindLoader>;

}  // namespace cusp::boards

#include "boards/mill3/mill_main.inc"
