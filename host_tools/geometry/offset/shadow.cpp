// Edges that two triangles share cancel each other; the others are the border, which an overlay cleans.
#include "host_tools/geometry/offset/shadow.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>

#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/offset/region_overlay.hpp"

namespace cusp::offset {
namespace {

using Triangle = std::array<Vec3d, 3>;

constexpr double kWeld = 1e-6;     // mm: corners of triangles in one cell of this size are one
constexpr double kUpright = 1e-9;  // twice the area in plan over the square of the longest side

using Corner = std::array<std::int64_t, 2>;

struct BorderSide {
    Corner from;
    Corner to;

    bool forwards() const { return from < to; }
    std::pair<Corner, Corner> ends() const { return std::minmax(from, to); }
};

Corner corner_of(Vec2d p) { return {std::llround(p.x / kWeld), std::llround(p.y / kWeld)}; }

Vec2d place_of(Corner c)
{
    return {static_cast<double>(c[0]) * kWeld, static_cast<double>(c[1]) * kWeld};
}

double doubled_area(Vec2d a, Vec2d b, Vec2d c) { return cross(b - a, c - a); }

// The border of polygons: sides that come once more in one direction than in the other.
class PolygonBorder {
public:
    // Seen from above, of either sense.
    void add(const std::vector<Vec2d>& polygon)
    {
        double twice = 0;
        double longest = 0;
        for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
            twice += doubled_area(polygon[0], polygon[k], polygon[k + 1]);
            longest = std::max(
                {longest, norm(polygon[k] - polygon[0]), norm(polygon[k + 1] - polygon[k])});
        }
        if (std::abs(twice) <= kUpright * longest * longest) {
            return;
        }
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            const Corner a = corner_of(polygon[k]);
            const Corner b = corner_of(polygon[(k + 1) % polygon.size()]);
            if (a != b) {
                sides_.push_back(twice > 0 ? BorderSide{a, b} : BorderSide{b, a});
            }
        }
    }

    // Closed chains of the sides that are left; they may overlap.
    Region2d region()
    {
        cancel();
        std::sort(sides_.begin(), sides_.end(), [](const BorderSide& a, const BorderSide& b) {
            return std::tie(a.from, a.to) < std::tie(b.from, b.to);
        });
        std::vector<bool> taken(sides_.size(), false);
        Region2d border;
        for (std::size_t k = 0; k < sides_.size(); ++k) {
            if (!taken[k]) {
                border.contours.push_back(contour_from(k, taken));
            }
        }
        return border;
    }

private:
    // Of the sides between the same two corners those stay by which one direction has more.
    void cancel()
    {
        std::sort(sides_.begin(), sides_.end(),
                  [](const BorderSide& a, const BorderSide& b) { return a.ends() < b.ends(); });
        std::vector<BorderSide> left;
        for (std::size_t k = 0; k < sides_.size();) {
            const std::size_t first = k;
            std::ptrdiff_t more = 0;
            for (; k < sides_.size() && sides_[k].ends() == sides_[first].ends(); ++k) {
                more += sides_[k].forwards() ? 1 : -1;
            }
            const auto [low, high] = sides_[first].ends();
            const BorderSide side = more > 0 ? BorderSide{low, high} : BorderSide{high, low};
            left.insert(left.end(), static_cast<std::size_t>(std::abs(more)), side);
        }
        sides_ = std::move(left);
    }

    // As many sides leave each corner as arrive there, so a walk ends where it began.
    Contour contour_from(std::size_t first, std::vector<bool>& taken) const
    {
        Contour contour;
        for (std::size_t k = first;;) {
            const BorderSide& side = sides_[k];
            taken[k] = true;
            contour.push_back(line_edge(place_of(side.from), place_of(side.to)));
            if (side.to == sides_[first].from) {
                return contour;
            }
            const auto next = std::lower_bound(
                sides_.begin(), sides_.end(), side.to,
                [](const BorderSide& a, const Corner& corner) { return a.from < corner; });
            k = static_cast<std::size_t>(next - sides_.begin());
            while (taken[k]) {
                ++k;
            }
        }
    }

    std::vector<BorderSide> sides_;
};

// The same point from both triangles at an edge.
Vec3d point_at_height(Vec3d low, Vec3d high, double z)
{
    const double share = (z - low.z) / (high.z - low.z);
    return low + (high - low) * share;
}

// The part of the triangle that is not below z.
std::vector<Vec2d> clipped(const Triangle& triangle, double z)
{
    std::vector<Vec2d> out;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d a = triangle[k];
        const Vec3d b = triangle[(k + 1) % 3];
        if (a.z >= z) {
            out.push_back(in_plan(a));
        }
        if ((a.z >= z) != (b.z >= z)) {
            out.push_back(in_plan(a.z < b.z ? point_at_height(a, b, z) : point_at_height(b, a, z)));
        }
    }
    return out;
}

Region2d cleaned(PolygonBorder& border) { return united(border.region(), {}); }

bool is_level(const Triangle& t)
{
    const auto [low, high] = std::minmax({t[0].z, t[1].z, t[2].z});
    const Vec3d across = cross(t[1] - t[0], t[2] - t[0]);
    return high - low <= kLevelGround && std::abs(across.z) > kLevelGround * kLevelGround;
}

Region2d level_triangles(const std::vector<Triangle>& triangles, double z)
{
    PolygonBorder border;
    for (const Triangle& t : triangles) {
        if (is_level(t) && std::abs(t[0].z - z) <= kStandsAbove) {
            border.add({in_plan(t[0]), in_plan(t[1]), in_plan(t[2])});
        }
    }
    return cleaned(border);
}

}  // namespace

Region2d shadow_above(const std::vector<Triangle>& triangles, double z)
{
    PolygonBorder border;
    for (const Triangle& triangle : triangles) {
        const std::vector<Vec2d> polygon = clipped(triangle, z + kStandsAbove);
        if (polygon.size() >= 3) {
            border.add(polygon);
        }
    }
    return cleaned(border);
}

Region2d level_ground(const std::vector<Triangle>& triangles, double z)
{
    return without(level_triangles(triangles, z), shadow_above(triangles, z));
}

std::vector<LevelHeight> level_heights(const std::vector<Triangle>& triangles)
{
    std::map<std::int64_t, LevelHeight> heights;  // by steps of kStandsAbove
    for (const Triangle& t : triangles) {
        if (is_level(t)) {
            LevelHeight& level =
                heights.try_emplace(std::llround(t[0].z / kStandsAbove), LevelHeight{t[0].z, 0})
                    .first->second;
            level.area += std::abs(doubled_area(in_plan(t[0]), in_plan(t[1]), in_plan(t[2]))) / 2;
        }
    }
    std::vector<LevelHeight> largest;
    for (const auto& [step, level] : heights) {
        if (level.area >= kLeastLevel) {
            largest.push_back(level);
        }
    }
    std::stable_sort(largest.begin(), largest.end(),
                     [](const LevelHeight& a, const LevelHeight& b) { return a.area > b.area; });
    largest.resize(std::min(largest.size(), kMostLevels));
    std::sort(largest.begin(), largest.end(),
              [](const LevelHeight& a, const LevelHeight& b) { return a.z < b.z; });
    std::vector<LevelHeight> out;
    for (const LevelHeight& level : largest) {
        const bool is_same = !out.empty() && level.z - out.back().z <= kStandsAbove;
        const double seen = is_same ? 0.0 : area(level_ground(triangles, level.z));
        if (seen >= kLeastLevel) {
            out.push_back({level.z, seen});
        }
    }
    return out;
}

}  // namespace cusp::offset
