// The way in which a tool goes down into uncut stock.
#pragma once

#include <cstdint>

namespace cusp::toolpath {

enum class EntryKind : std::uint8_t { kAuto, kHelix, kRamp, kPlunge };

}  // namespace cusp::toolpath
