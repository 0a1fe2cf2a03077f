// The figures of a verification as text.
#pragma once

#include <string>

#include "host_tools/judge/verify/verify.hpp"

namespace cusp::verify {

// One key for each figure, mm rounded to 1e-6, and "broken": docs/stats.md.
std::string statistics_json(const Verification& result);

// One line for each figure, then the bounds that do not hold.
std::string verification_text(const Verification& result);

}  // namespace cusp::verify
