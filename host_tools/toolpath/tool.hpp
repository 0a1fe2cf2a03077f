// A rotating cutter: its end as a profile, a cylindrical shank above it.
#pragma once

#include <cstdint>

namespace cusp::toolpath {

enum class ToolShape : std::uint8_t { kBall, kFlat, kBull };

// "ball", "flat" or "bull".
const char* name_of(ToolShape shape);

struct Tool {
    int number{1};
    ToolShape shape{ToolShape::kBall};
    double radius{};         // mm
    double corner_radius{};  // mm: radius for a ball, 0 for a flat end mill
};

// Height of the tool's lower side over its tip at distance `d` from its axis; infinity beyond the
// radius.
double profile_height(const Tool& tool, double d);

}  // namespace cusp::toolpath
