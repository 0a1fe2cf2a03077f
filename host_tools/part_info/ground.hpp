// The part as places to look at, and what they say of the ground: how steep, level, hidden.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::part_info {

// One place of the part with the piece of it that it stands for.
struct GroundPlace {
    Vec3d point;
    Vec3d normal;      // unit: out of a solid; upwards where there is none
    double area{};     // mm^2; 0: an edge or a corner
    bool two_sided{};  // upright, and which side is metal is not known
    bool below{};      // of the solid, looking down
};

struct Ground {
    double area{};  // mm^2, of everything
    // Of what looks up and nothing stands over; degrees from level.
    double steepest{};
    Vec3d steepest_at;
    // The same without upright walls; none where there is nothing else.
    std::optional<double> steepest_slope;
    Vec3d steepest_slope_at;
    double upright_area{};
    double level_area{};
    std::optional<Vec3d> level_at;  // the highest
    // Hidden from above, but for the level underside of a solid: a tool from above can't reach it.
    double hidden_area{};
    std::optional<Vec3d> hidden_at;  // the place of the largest piece
};

// Steeper counts as upright, less steep as level, degrees.
inline constexpr double kUprightDegrees = 89.9;
inline constexpr double kLevelDegrees = 0.1;

// Degrees between the ground and level, 0 to 90.
double steepness(const GroundPlace& place);

// Height of the part's highest place at (x, y); none beside it.
using TopOfPart = std::function<std::optional<double>(double x, double y)>;

// Whether anything stands over the ground a hundredth of a millimetre in front of the place, or the
// place looks down: a thin tool can't come to it.
bool hidden_from_above(const TopOfPart& top, const GroundPlace& place);

// Sums over places; areas are as good as the places are close.
//
// hidden  of each place, as hidden_from_above()
Ground ground_of(const std::vector<GroundPlace>& places,
                 const std::vector<char>& hidden,
                 double lowest);

}  // namespace cusp::part_info
