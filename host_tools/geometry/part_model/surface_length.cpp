// Sums of chords.
#include "host_tools/geometry/part_model/surface_length.hpp"

#include <algorithm>

namespace cusp::part_model {

using nurbs::Surface;

double longest_row(const Surface& surface, bool along_u)
{
    const auto size_u = static_cast<std::size_t>(surface.size_u);
    const auto size_v = static_cast<std::size_t>(surface.size_v);
    const std::size_t rows = along_u ? size_v : size_u;
    const std::size_t count = along_u ? size_u : size_v;
    double longest = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        const auto point = [&](std::size_t k) {
            return surface.points[along_u ? k * size_v + row : row * size_v + k];
        };
        double length = 0;
        for (std::size_t k = 1; k < count; ++k) {
            length += norm(point(k) - point(k - 1));
        }
        longest = std::max(longest, length);
    }
    return longest;
}

double length_between(const PartModel& model, int surface, Vec2d from, Vec2d to, int parts)
{
    double sum = 0;
    Vec3d last = model.evaluate(surface, from.x, from.y).point;
    for (int k = 1; k <= parts; ++k) {
        const Vec2d at = from + (to - from) * (static_cast<double>(k) / parts);
        const Vec3d next = model.evaluate(surface, at.x, at.y).point;
        sum += norm(next - last);
        last = next;
    }
    return sum;
}

}  // namespace cusp::part_model
