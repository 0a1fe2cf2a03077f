// The small controller's image.
#include "boards/black_pill_f411/pill_table.hpp"
#include "boards/mill3/chip_traits.hpp"

namespace cusp::boards {

using Traits = ChipTraits<PillTable>;

}  // namespace cusp::boards

#include "boards/mill3/mill_main.inc"
