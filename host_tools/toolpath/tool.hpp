// A rotating cutter: its end as a profile, a cylindrical shank above it.
#pragma once

#include <cstdint>
#include <optional>

namespace cusp::toolpath {

enum class ToolShape : std::uint8_t { kBall, kFlat, kBull };

enum class Coolant : std::uint8_t { kOff, kMist, kFlood };

// How a tool cuts where it has figures of its own.
struct CuttingRates {
    double feed{};                  // mm/min; 0: the job's
    double plunge_feed{};           // mm/min; 0: the job's
    std::optional<double> spindle;  // rpm; none: the job's
};

// "ball", "flat" or "bull".
const char* name_of(ToolShape shape);

struct Tool {
    int number{1};
    ToolShape shape{ToolShape::kBall};
    double radius{};         // mm
    double corner_radius{};  // mm: radius for a ball, 0 for a flat end mill
    CuttingRates rates{};
    Coolant coolant{Coolant::kOff};
};

// Height of the tool's lower side over its tip at distance `d` from its axis; infinity beyond the
// radius.
double profile_height(const Tool& tool, double d);

}  // namespace cusp::toolpath
