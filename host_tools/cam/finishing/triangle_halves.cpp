// Parts come in the order in which halves are made.
#include "host_tools/cam/finishing/triangle_halves.hpp"

#include <algorithm>

namespace cusp::finishing {

namespace {

constexpr double kShortestPart = 1.0 / 4096;  // of the triangle's longest side

}  // namespace

LongSide longest_side(const Corners& corners)
{
    LongSide out{0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
        const double length = norm(corners[(k + 1) % 3] - corners[k]);
        if (k == 0 || length > out.length) {
            out = {length, k};
        }
    }
    return out;
}

std::array<Corners, 2> halves_of(const Corners& corners, std::size_t side)
{
    const Vec3d half = (corners[side] + corners[(side + 1) % 3]) * 0.5;
    const Vec3d across = corners[(side + 2) % 3];
    return {{{corners[side], half, across}, {half, corners[(side + 1) % 3], across}}};
}

std::vector<Corners> parts_of(const Corners& corners, double longest)
{
    const double most = std::max(longest, kShortestPart * longest_side(corners).length);
    std::vector<Corners> out;
    std::vector<Corners> open{corners};
    while (!open.empty()) {
        const Corners part = open.back();
        open.pop_back();
        const LongSide side = longest_side(part);
        if (side.length <= most) {
            out.push_back(part);
            continue;
        }
        const std::array<Corners, 2> halves = halves_of(part, side.side);
        open.insert(open.end(), halves.rbegin(), halves.rend());
    }
    return out;
}

double area_of(const Corners& corners)
{
    return 0.5 * norm(cross(corners[1] - corners[0], corners[2] - corners[0]));
}

}  // namespace cusp::finishing
