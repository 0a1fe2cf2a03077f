// The image of an Octopus behind the maker's boot loader.
#include "boards/mill3/chip_traits.hpp"
#include "boards/octopus_f446/octopus_table.hpp"

namespace cusp::boards {

struct BehindLoader : OctopusTable {
    using Settings = hal::stm32f4::SettingsAtEndOf512K;
};

using Traits = ChipTraits<BehindLoader>;

}  // namespace cusp::boards

#include "boards/mill3/mill_main.inc"
