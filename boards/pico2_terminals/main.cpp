// The image of a Pico 2 on a breakout board with screw terminals.
#include "boards/mill3/pico_traits.hpp"
#include "boards/pico2_terminals/pico2_table.hpp"

namespace cusp::boards {

using Traits = PicoTraits<Pico2Table>;

}  // namespace cusp::boards

#include "boards/mill3/mill_main.inc"
