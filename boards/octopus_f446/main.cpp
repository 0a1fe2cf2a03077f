// The image of an Octopus.
#include "boards/mill3/chip_traits.hpp"
#include "boards/octopus_f446/octopus_table.hpp"

namespace cusp::boards {

using Traits = ChipTraits<OctopusTable>;

}  // namespace cusp::boards

#include "boards/mill3/mill_main.inc"
