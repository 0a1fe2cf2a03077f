// The tour of drills and mills that go from hole to hole.
#include "host_tools/cam/prismatic/hole_tour.hpp"

#include <algorithm>

#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/geometry/toolpath/short_tour.hpp"

#include "fmt/format.h"

namespace cusp::prismatic {

using job::Hole;
using job::Operation;
using toolpath::PlannedOperation;

std::vector<std::size_t> hole_tour(const std::vector<Hole>& holes)
{
    std::vector<Vec2d> places;
    for (const Hole& hole : holes) {
        places.push_back(hole.at);
    }
    return toolpath::short_tour(places, {0, 0});
}

void warn_of_narrower_holes(const Operation& operation, PlannedOperation& planned)
{
    constexpr std::size_t kNamed = 10;
    const std::vector<Hole>& holes = operation.prismatic->narrower_holes;
    for (std::size_t k = 0; k < std::min(kNamed, holes.size()); ++k) {
        planned.stats.warnings.push_back(fmt::format(
            "{}: the hole of {:g} mm at x {:.6g} y {:.6g} mm is narrower than tool {} of {:g} mm: "
            "left out",
            operation.prismatic->file, holes[k].diameter, holes[k].at.x, holes[k].at.y,
            operation.tool.number, 2 * operation.tool.radius));
    }
    if (holes.size() > kNamed) {
        planned.stats.warnings.push_back(fmt::format("{} more are narrower than the tool: left out",
                                                     counted(holes.size() - kNamed, "hole")));
    }
}

}  // namespace cusp::prismatic
