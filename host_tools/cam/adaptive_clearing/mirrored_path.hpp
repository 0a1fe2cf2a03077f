// Conventional milling is planned as climb milling of the mirror image about the y axis.
#pragma once

#include "host_tools/cam/adaptive_clearing/adaptive_clearing.hpp"

namespace cusp::adaptive_clearing {

// Still to the left of its contours.
offset::Region2d mirrored(const offset::Region2d& region);

void mirror(AdaptivePath& path);

}  // namespace cusp::adaptive_clearing
