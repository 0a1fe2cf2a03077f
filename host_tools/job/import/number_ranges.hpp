// Ranges of the numbers in jobs and of the options that replace a job.
#pragma once

namespace cusp::import {

struct Range {
    double low;
    double high;
    bool above_low{false};  // `low` itself is not allowed
};

// mm, mm/min, rpm
inline constexpr double kLargest = 1e6;
inline constexpr Range kPositive{0, kLargest, true};
inline constexpr Range kNotNegative{0, kLargest};
inline constexpr Range kAnyNumber{-kLargest, kLargest};
// G-code has coordinates to 1e-4 mm and feeds to 1e-3 mm/min.
inline constexpr Range kTolerance{1e-5, kLargest};  // mm
inline constexpr Range kScale{1e-6, kLargest};      // of a part
inline constexpr Range kFeed{0.01, kLargest};       // mm/min

}  // namespace cusp::import
