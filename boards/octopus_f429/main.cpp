// The image of an Octopus with an STM32F429.
#include "boards/mill3/chip_traits.hpp"
#include "boards/octopus_f429/octopus_f429_table.hpp"

namespace cusp::boards {

using Traits = ChipTraits<OctopusF429Table>;

}  // namespace cusp::boards

#include "boards/mill3/mill_main.inc"
