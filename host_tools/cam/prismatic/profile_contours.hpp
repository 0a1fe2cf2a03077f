// Contours of the tool's centre around loops, and the parts of the loops that it does not reach.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::prismatic {

// mm: tolerance of curves; lines and circles are exact.
inline constexpr double kFit = 2e-4;

// The material that the loops bound: on the left of its contours.
//
// Errors: InputError where a loop has no extent.
offset::Region2d material_of(const job::Prismatic& cut);

// The complement of the material; its contours have it on their left.
offset::Region2d opposite(offset::Region2d region);

// Stretches of loops that a tool does not touch.
struct Unreached {
    double length{};   // mm, of all
    double longest{};  // mm
    Vec2d place;       // in the longest
    // Loops that it touches nowhere, by their place in the list.
    std::vector<std::size_t> loops;
};

// waste    the region that the tool may be in
// centres  contours of the tool's centre at `distance` from those of `waste`
Unreached unreached(const offset::Region2d& waste,
                    const offset::Region2d& centres,
                    double distance);

// For each contour the one that lies directly around it, by its place in the list; none if nothing
// does.
std::vector<std::optional<std::size_t>> contours_around(
    const std::vector<offset::Contour>& contours);

}  // namespace cusp::prismatic
