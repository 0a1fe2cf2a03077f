// The image of an SKR 2 behind the maker's boot loader.
#include "boards/mill3/chip_traits.hpp"
#include "boards/skr2_f407/skr2_table.hpp"

namespace cusp::boards {

struct BehindLoader : Skr2Table {
    using Settings = hal::stm32f4::SettingsAtEndOf1M;
};

using Traits = ChipTraits<BehindLoader>;

}  // namespace cusp::boards

#include "boards/mill3/mill_main.inc"
