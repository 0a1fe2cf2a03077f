// Units of settings and reports, as Grbl has them: mm/min, and inches where asked for.
#pragma once

#include "firmware/base/inch.hpp"

namespace cusp::machine {

inline constexpr float kSecondsPerMinute = 60.0F;
inline constexpr float kMillimetresPerInch = static_cast<float>(cusp::kMillimetresPerInch);

}  // namespace cusp::machine
