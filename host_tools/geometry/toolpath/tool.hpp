// A rotating cutter: its end as a profile, a cylindrical shank above it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace cusp::toolpath {

enum class ToolShape : std::uint8_t { kBall, kFlat, kBull, kVee, kDrill, kTaper };

enum class Coolant : std::uint8_t { kOff, kMist, kFlood };

// Feeds and speeds of a tool that has its own.
struct CuttingRates {
    double feed{};                  // mm/min; 0: the job's
    double plunge_feed{};           // mm/min; 0: the job's
    std::optional<double> spindle;  // rpm; none: the job's
};

// "ball", "flat", "bull", "vee", "drill" or "taper".
const char* name_of(ToolShape shape);

struct Tool {
    int number{1};
    ToolShape shape{ToolShape::kBall};
    double radius{};  // mm
    double
        corner_radius{};  // mm: radius for a ball, 0 for a flat end mill; of a taper that of its ball
    // Vee, drill and taper: the whole angle between the flanks, radians.
    double tip_angle{};
    double tip_radius{};  // mm: of the flat at the tip of a vee or a taper
    CuttingRates rates{};
    Coolant coolant{Coolant::kOff};
};

// True if the end is a cone: a vee, a drill or a taper.
bool is_conical(const Tool& tool);

// mm: the radius of the level bottom; 0 for a ball, a drill, and a vee with a sharp tip.
double flat_radius(const Tool& tool);

// mm: the radius of the thinnest tool; infinite if there is none.
double least_radius(const std::vector<Tool>& tools);

// Height of the tool's lower side over its tip at distance `d` from its axis; infinity beyond the
// radius.
double profile_height(const Tool& tool, double d);

}  // namespace cusp::toolpath
