// The mill controller's image.
#include "boards/mill3/chip_traits.hpp"
#include "boards/mill3_f405/mill_table.hpp"

namespace cusp::boards {

using Traits = ChipTraits<MillTable>;

}  // namespace cusp::boards

#include "boards/mill3/mill_main.inc"
