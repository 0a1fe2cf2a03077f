// The mill controller's image for QEMU.
#include "boards/mill3_f405_qemu/qemu_traits.hpp"

namespace cusp::boards {

using Traits = QemuTraits;

}  // namespace cusp::boards

#include "boards/mill3/mill_main.inc"
