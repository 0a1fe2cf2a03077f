// Ways through a pocket that are not loops.
#pragma once

#include "host_tools/offset/offset.hpp"

namespace cusp::host {

// Whether the tool's axis stays in the pocket and `least` mm off its walls all along the way.
bool is_free(const RegionOffset& walls, const Edge& way, double least);

}  // namespace cusp::host
