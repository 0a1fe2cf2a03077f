// One way backwards, then the other.
#include "host_tools/cam/finishing/mesh_traces.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/finishing/scallop_at_point.hpp"

namespace cusp::finishing {

Vec3d level_along(Vec3d normal)
{
    return Vec3d{-normal.y, normal.x, 0} / elementary::hypot(normal.x, normal.y);
}

std::optional<MeshPlace> place_on_mesh(const part_model::PartModel& model, Vec3d at)
{
    const auto top = model.height_at(at.x, at.y);
    return top ? std::optional{MeshPlace{top->point, top->normal}} : std::nullopt;
}

Points traced(const MeshPlace& from, const MissingTip& missing, const NextPlace& next)
{
    Points out;
    for (const double way : {-1.0, 1.0}) {
        std::optional<MeshPlace> at = from;
        for (int k = 0; k < kMostTraced && at; ++k) {
            const std::optional<Vec3d> tip = missing(*at);
            if (!tip) {
                break;
            }
            if (k > 0 || way < 0) {
                out.push_back(*tip);
            }
            at = next(*at, *tip, way);
        }
        if (way < 0) {
            std::reverse(out.begin(), out.end());
        }
    }
    return out;
}

Points longest_over_mesh(const MeshPlace& from,
                         const part_model::PartModel& model,
                         double step,
                         const MissingTip& missing)
{
    const auto along = [&](Vec3d axis) {
        return traced(from, missing, [&](const MeshPlace& at, Vec3d /*tip*/, double way) {
            const double slant = dot(at.normal, axis) / at.normal.z;
            return place_on_mesh(
                model, at.point + axis * (way * kTraceStep * step / std::sqrt(1 + slant * slant)));
        });
    };
    Points one = along({1, 0, 0});
    Points other = along({0, 1, 0});
    return length_of(other) > length_of(one) ? other : one;
}

}  // namespace cusp::finishing
