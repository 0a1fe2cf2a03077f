// Control points bound a surface: one height of all of them is the height of the floor.
#include "host_tools/job/job/level_floor.hpp"

#include <cmath>

namespace cusp::job {

std::optional<double> level_floor(const Operation& operation)
{
    constexpr double kLevel = 1e-6;  // mm
    if (operation.part.floor.empty()) {
        return std::nullopt;
    }
    const double level = operation.part.floor.front().points.front().z;
    for (const nurbs::Surface& surface : operation.part.floor) {
        for (const Vec3d p : surface.points) {
            if (std::abs(p.z - level) > kLevel) {
                return std::nullopt;
            }
        }
    }
    return level;
}

}  // namespace cusp::job
