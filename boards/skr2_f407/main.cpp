// The image of an SKR 2.
#include "boards/mill3/chip_traits.hpp"
#include "boards/skr2_f407/skr2_table.hpp"

namespace cusp::boards {

using Traits = ChipTraits<Skr2Table>;

}  // namespace cusp::boards

#include "boards/mill3/mill_main.inc"
