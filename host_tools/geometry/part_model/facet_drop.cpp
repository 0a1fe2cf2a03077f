// The tool's lower side is convex, so on a plane or a side its height has one maximum over the places
// that it may touch.
#include "host_tools/geometry/part_model/facet_drop.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/part_model/bracketed_zero.hpp"

namespace cusp::part_model {

using toolpath::Tool;

namespace {

constexpr double kUprightPlane = 1e-9;  // z of a normal
constexpr double kNear = 1e-6;          // radii: the height changes by the square of that
constexpr int kRounds = 60;             // of a search along a side
constexpr double kUprightSide = 1e-9;   // mm, seen from above

double square_in_plan(Vec3d p, double x, double y)
{
    return (p.x - x) * (p.x - x) + (p.y - y) * (p.y - y);
}

// The ball dropped on the side between two corners: the upper of two roots; none where it touches
// the line beyond a corner.
std::optional<FacetContact> drop_ball_on_side(Vec3d a, Vec3d b, double x, double y, double radius)
{
    const Vec3d d = b - a;
    const double square = dot(d, d);
    const double cos_square = (d.x * d.x + d.y * d.y) / square;
    if (cos_square < 1e-14) {
        return std::nullopt;
    }
    const double along = ((x - a.x) * d.x + (y - a.y) * d.y);
    const double half = along * d.z / square;
    const double constant = square_in_plan(a, x, y) - along * along / square - radius * radius;
    const double root = half * half - cos_square * constant;
    if (root < 0) {
        return std::nullopt;
    }
    const double rise = (half + std::sqrt(root)) / cos_square;
    const double share = (along + rise * d.z) / square;
    if (share < 0 || share > 1) {
        return std::nullopt;
    }
    return FacetContact{a.z + rise, a + d * share};
}

// The highest contact along a side: rise() of the height has one zero.
template <class Rise>
double highest_place(double low, double high, double near, const Rise& rise)
{
    const Bracket top = bracketed_zero({low, high}, {near, kRounds}, rise);
    return 0.5 * (top.low + top.high);
}

std::optional<FacetContact> drop_on_side(
    Vec3d a, Vec3d b, const ToolProfile& tool, double x, double y)
{
    const Vec3d d = b - a;
    const double length = elementary::hypot(d.x, d.y);
    const auto contact = [&](double share) {
        const Vec3d p = a + d * share;
        const double away = std::min(elementary::hypot(p.x - x, p.y - y), tool.radius());
        return FacetContact{p.z - tool.height(away), p};
    };
    if (length < kUprightSide) {
        const double share = d.z > 0 ? 1 : 0;
        const Vec3d top = a + d * share;
        return square_in_plan(top, x, y) <= tool.radius() * tool.radius()
                   ? std::optional{contact(share)}
                   : std::nullopt;
    }
    const double beside = ((x - a.x) * d.y - (y - a.y) * d.x) / length;
    const double room = tool.radius() * tool.radius() - beside * beside;
    if (room < 0) {
        return std::nullopt;
    }
    const double foot = ((x - a.x) * d.x + (y - a.y) * d.y) / length;
    const double low = std::max(0.0, foot - std::sqrt(room));
    const double high = std::min(length, foot + std::sqrt(room));
    if (low > high) {
        return std::nullopt;
    }
    const double slope = d.z / length;
    // Positive where the height rises along the side.
    const auto rise = [&](double place) {
        const double along = place - foot;
        const double away = std::min(std::sqrt(beside * beside + along * along), tool.radius());
        const ToolProfile::Slope lower = tool.slope(away);
        return slope * lower.along - (away > 0 ? lower.up * along / away : 0);
    };
    return contact(highest_place(low, high, kNear * tool.radius(), rise) / length);
}

std::optional<FacetContact> drop_ball_on_sides(const Facet& facet,
                                               double x,
                                               double y,
                                               double radius)
{
    const std::array<Vec3d, 3>& at = facet.corners;
    std::optional<FacetContact> best;
    const auto take = [&](const FacetContact& other) {
        if (!best || other.centre > best->centre) {
            best = other;
        }
    };
    for (std::size_t k = 0; k < 3; ++k) {
        if (const auto side = drop_ball_on_side(at[k], at[(k + 1) % 3], x, y, radius)) {
            take(*side);
        }
        const double up = radius * radius - square_in_plan(at[k], x, y);
        if (up >= 0) {
            take({at[k].z + std::sqrt(up), at[k]});
        }
    }
    return best;
}

}  // namespace

ToolProfile::ToolProfile(const Tool& tool)
    : core_{core_of(tool, {0, 0, -tool.corner_radius})}, corner_{tool.corner_radius}
{
    if (core_.widening > 0) {
        lean_cosine_ = 1 / std::sqrt(1 + core_.widening * core_.widening);
        lean_sine_ = core_.widening * lean_cosine_;
    }
    joined_ = core_.radius + corner_ * lean_cosine_;
    top_ = core_.greatest_radius() + corner_ * lean_cosine_;
}

double ToolProfile::height(double away) const
{
    const auto arc = [&](double from_middle) {
        return -std::sqrt(std::max(0.0, corner_ * corner_ - from_middle * from_middle));
    };
    if (away > radius()) {
        return kInfinite;
    }
    if (away <= joined_ || core_.widening == 0) {
        return arc(std::max(0.0, away - core_.radius));
    }
    if (away <= top_) {
        return (away - joined_) / core_.widening - corner_ * lean_sine_;
    }
    return core_.cone_height() + arc(away - core_.widest);
}

ToolProfile::Slope ToolProfile::slope(double away) const
{
    const auto arc = [&](double from_middle) {
        const double sine = corner_ > 0 ? std::min(1.0, from_middle / corner_) : 1;
        return Slope{std::sqrt(1 - sine * sine), sine};
    };
    if (away <= core_.radius) {
        return {1, 0};
    }
    if (away <= joined_ || core_.widening == 0) {
        return arc(away - core_.radius);
    }
    return away <= top_ ? Slope{lean_sine_, lean_cosine_} : arc(away - core_.widest);
}

std::optional<FacetContact> drop_on_facet(
    const Facet& facet, const ToolProfile& tool, double x, double y, double least)
{
    const Vec3d n = facet.normal;
    const std::array<Vec3d, 3>& at = facet.corners;
    if (n.z >= kUprightPlane) {
        const Vec3d touches = tool.core().farthest_against(n) - n * tool.corner();
        const Vec3d over = Vec3d{x, y, 0} + touches - at[0];
        const double end = -dot(over, n) / n.z;
        // A tool on the facet is never higher than one on the facet's plane.
        if (end < least) {
            return std::nullopt;
        }
        const Vec3d contact{x + touches.x, y + touches.y, end + touches.z};
        if (facet.holds(contact)) {
            return FacetContact{end, contact};
        }
    }
    if (tool.core().is_point()) {
        return drop_ball_on_sides(facet, x, y, tool.corner());
    }
    std::optional<FacetContact> best;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d& a = at[k];
        const Vec3d& b = at[(k + 1) % 3];
        if (std::max(a.z, b.z) + tool.corner() < least) {
            continue;
        }
        const auto side = drop_on_side(a, b, tool, x, y);
        if (side && (!best || side->centre > best->centre)) {
            best = side;
        }
    }
    return best;
}

}  // namespace cusp::part_model
