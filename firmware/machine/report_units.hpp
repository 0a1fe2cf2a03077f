// Units of settings and reports, as Grbl has them: mm/min, and inches where asked for.
#pragma once

namespace cusp::machine {

inline constexpr float kSecondsPerMinute = 60.0F;
inline constexpr float kMillimetresPerInch = 25.4F;

}  // namespace cusp::machine
