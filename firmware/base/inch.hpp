// The inch, exactly.
#pragma once

namespace cusp {

inline constexpr double kMillimetresPerInch = 25.4;

}  // namespace cusp
