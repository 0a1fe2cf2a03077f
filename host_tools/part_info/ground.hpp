// Ground: slopes, level places and undercuts of a part, from sampled places.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::part_info {

// One place of the part with the area that it represents.
struct GroundPlace {
    Vec3d point;
    Vec3d normal;      // unit: out of a solid; upwards where there is none
    double area{};     // mm^2; 0: an edge or a corner
    bool two_sided{};  // upright, and the side of the material is not known
    bool below{};      // the underside of a solid
};

struct Ground {
    double area{};  // mm^2, of everything
    // Steepest of what faces up and is visible from above; degrees from level.
    double steepest{};
    Vec3d steepest_at;
    // The same without upright walls; none where there is nothing else.
    std::optional<double> steepest_slope;
    Vec3d steepest_slope_at;
    double upright_area{};
    double level_area{};
    std::optional<Vec3d> level_at;  // the highest
    // Hidden from above, without the level underside of a solid: a tool from above can't reach it.
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

// Whether the part covers a point a hundredth of a millimetre in front of the place, or the place
// faces down: no thin tool reaches it.
bool hidden_from_above(const TopOfPart& top, const GroundPlace& place);

// Sums over places; areas are as accurate as the places are dense.
//
// hidden  for each place, by hidden_from_above()
Ground ground_of(const std::vector<GroundPlace>& places,
                 const std::vector<char>& hidden,
                 double lowest);

}  // namespace cusp::part_info
