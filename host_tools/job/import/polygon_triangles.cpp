// Cuts the first corner that is convex and whose triangle holds no other corner.
#include "host_tools/job/import/polygon_triangles.hpp"

#include <cstddef>

namespace cusp::import {
namespace {

Vec3d mean_normal(const std::vector<Vec3d>& corners)
{
    Vec3d sum{};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3d a = corners[i] - corners[0];
        const Vec3d b = corners[(i + 1) % corners.size()] - corners[0];
        sum = sum + cross(a, b);
    }
    return sum;
}

// True if p is in the triangle or on its edge; the triangle turns left seen against the normal.
bool holds(const std::array<Vec3d, 3>& triangle, Vec3d p, Vec3d normal)
{
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d side = triangle[(i + 1) % 3] - triangle[i];
        if (dot(cross(side, p - triangle[i]), normal) < 0) {
            return false;
        }
    }
    return true;
}

bool is_ear(const std::vector<Vec3d>& corners, std::size_t at, Vec3d normal)
{
    const std::size_t size = corners.size();
    const std::array<Vec3d, 3> ear{corners[(at + size - 1) % size], corners[at],
                                   corners[(at + 1) % size]};
    if (!(dot(cross(ear[1] - ear[0], ear[2] - ear[1]), normal) > 0)) {
        return false;
    }
    for (const Vec3d& p : corners) {
        if (p != ear[0] && p != ear[1] && p != ear[2] && holds(ear, p, normal)) {
            return false;
        }
    }
    return true;
}

}  // namespace

std::vector<std::array<Vec3d, 3>> polygon_triangles(std::vector<Vec3d> corners)
{
    const Vec3d normal = mean_normal(corners);
    std::vector<std::array<Vec3d, 3>> triangles;
    while (corners.size() > 3) {
        std::size_t ear = 0;
        while (ear < corners.size() && !is_ear(corners, ear, normal)) {
            ++ear;
        }
        ear %= corners.size();  // none: the polygon is not simple, or rounding hides the last ears
        const std::size_t size = corners.size();
        triangles.push_back(
            {corners[(ear + size - 1) % size], corners[ear], corners[(ear + 1) % size]});
        corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    triangles.push_back({corners[0], corners[1], corners[2]});
    return triangles;
}

}  // namespace cusp::import
