// The image of a Nucleo board with a CNC shield.
#include "boards/mill3/chip_traits.hpp"
#include "boards/nucleo_f446_cnc_shield/nucleo_table.hpp"

namespace cusp::boards {

using Traits = ChipTraits<NucleoTable>;

}  // namespace cusp::boards

#include "boards/mill3/mill_main.inc"
