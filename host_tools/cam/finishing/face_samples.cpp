// Samples a face for the difference of its normals, and the side along which they differ.
#include "host_tools/cam/finishing/face_samples.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::finishing {

namespace {

constexpr double kNoArea = 1e-12;  // mm2

}  // namespace

std::optional<FaceSamples> sample_face(const part_model::PartModel& model,
                                       int surface,
                                       Vec2d low,
                                       Vec2d high)
{
    FaceSamples out;
    int missing = 0;
    Vec3d sum{};
    for (std::size_t k = 0; k < 9; ++k) {
        const Vec2d share{0.5 * static_cast<double>(k / 3), 0.5 * static_cast<double>(k % 3)};
        const nurbs::SurfacePoint p = model.tangents(surface, low.x + (high.x - low.x) * share.x,
                                                     low.y + (high.y - low.y) * share.y);
        out.points[k] = p.point;
        const Vec3d area = cross(p.du, p.dv);
        const double size = norm(area);
        missing += size > kNoArea ? 0 : 1;
        out.normals[k] = size > kNoArea ? area / size : Vec3d{};
        sum = sum + out.normals[k];
    }
    if (missing > 3 || !(norm(sum) > 0)) {
        return std::nullopt;
    }
    // At a pole that of the cell counts.
    sum = sum / norm(sum);
    out.low = 1;
    out.high = -1;
    for (Vec3d& n : out.normals) {
        n = norm(n) > 0 ? n : sum;
        out.turn = std::max(out.turn, norm(n - sum));
        out.low = std::min(out.low, n.z);
        out.high = std::max(out.high, n.z);
    }
    const auto turn_between = [&](std::size_t a, std::size_t b) {
        return std::max(norm(out.normals[a] - out.normals[4]),
                        norm(out.normals[b] - out.normals[4]));
    };
    out.turns_along_u = turn_between(1, 7) >= turn_between(3, 5);
    const auto bend_between = [&](std::size_t a, std::size_t b) {
        return std::abs(out.normals[a].z - 2 * out.normals[4].z + out.normals[b].z);
    };
    out.lines_bend_along_u = bend_between(1, 7) >= bend_between(3, 5);
    return out;
}

}  // namespace cusp::finishing
