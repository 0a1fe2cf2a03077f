// Ground: slopes, horizontal areas and undercuts of a part, from sampled points.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::part_info {

// A sampled point of the part with the area that it represents.
struct GroundPlace {
    Vec3d point;
    Vec3d normal;      // unit: out of a solid; upwards where there is none
    double area{};     // mm^2; 0: an edge or a corner
    bool two_sided{};  // vertical, and the side of the material is unknown
    bool below{};      // the underside of a solid
};

struct Ground {
    double area{};  // mm^2, of everything
    // Steepest upward point that is visible from above, degrees from horizontal.
    double steepest{};
    Vec3d steepest_at;
    // Without vertical walls; no value where there is nothing else.
    std::optional<double> steepest_slope;
    Vec3d steepest_slope_at;
    double vertical_area{};
    double level_area{};
    std::optional<Vec3d> level_at;  // the highest
    // Hidden from above, without the horizontal underside of a solid: the undercuts.
    double hidden_area{};
    std::optional<Vec3d> hidden_at;  // in the largest piece
};

// Degrees: above the first a point counts as vertical, below the second as horizontal.
inline constexpr double kVerticalDegrees = 89.9;
inline constexpr double kLevelDegrees = 0.1;

// Slope in degrees from horizontal, 0 to 90.
double steepness(const GroundPlace& place);

// The part's greatest height at (x, y); no value beside the part.
using TopOfPart = std::function<std::optional<double>(double x, double y)>;

// True if the normal points down, or if the part covers the point 0.01 mm in front of `place`: no
// tool from above reaches it, however thin.
bool hidden_from_above(const TopOfPart& top, const GroundPlace& place);

// Sums over sampled points; the accuracy of areas depends on their density.
//
// hidden  for each point, by hidden_from_above()
Ground ground_of(const std::vector<GroundPlace>& places,
                 const std::vector<char>& hidden,
                 double lowest);

}  // namespace cusp::part_info
