// Local search, for each side of the box, on the Bezier patches that may contain the extreme point.
#include "host_tools/job/import/part_extent.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/part_model/pattern_search.hpp"
#include "host_tools/geometry/part_model/trim_region.hpp"
#include "host_tools/job/job/loop_shape.hpp"

namespace cusp::import {

using job::loop_polyline;
using nurbs::BezierPatch;
using nurbs::Curve;
using nurbs::Surface;
using part_model::pattern_search;
using part_model::TrimRegion;

namespace {

constexpr double kEdgeError = 1e-4;  // mm, of trims
constexpr double kRounding = 1e-9;   // mm, of control points

Vec3d least(Vec3d a, Vec3d b)
{
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}

Vec3d greatest(Vec3d a, Vec3d b)
{
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

// A side of the box: axis and direction.
struct Side {
    unsigned axis;
    double sign;

    double reach(Vec3d p) const { return sign * p[axis]; }
};

class FarthestPlaces {
public:
    explicit FarthestPlaces(const std::vector<Surface>& surfaces)
        : surfaces_{surfaces}, regions_(surfaces.size())
    {
        for (std::size_t k = 0; k < surfaces.size(); ++k) {
            for (BezierPatch& patch : bezier_patches(surfaces[k])) {
                patches_.push_back({k, std::move(patch)});
            }
        }
    }

    // The coordinate of the extreme point. A patch is inside the hull of its control points.
    double farthest(Side side)
    {
        std::vector<std::pair<double, const Patch*>> bounds;
        for (const Patch& patch : patches_) {
            double bound = -kInfinite;
            for (const Vec3d point : patch.bezier.surface.points) {
                bound = std::max(bound, side.reach(point));
            }
            bounds.emplace_back(bound, &patch);
        }
        std::stable_sort(bounds.begin(), bounds.end(),
                         [](const auto& a, const auto& b) { return a.first > b.first; });
        std::vector<bool> looked_at_edges(surfaces_.size(), false);
        double most = -kInfinite;
        for (const auto& [bound, patch] : bounds) {
            if (bound <= most + kRounding) {
                break;
            }
            if (!looked_at_edges[patch->surface]) {
                looked_at_edges[patch->surface] = true;
                for (const auto& edge : region(patch->surface).edges(surfaces_[patch->surface])) {
                    most = std::max({most, side.reach(edge[0]), side.reach(edge[1])});
                }
            }
            most = std::max(most, climbed(*patch, side));
        }
        return side.sign * most;
    }

private:
    struct Patch {
        std::size_t surface;
        BezierPatch bezier;
    };

    const TrimRegion& region(std::size_t surface)
    {
        std::optional<TrimRegion>& made = regions_[surface];
        if (!made) {
            made.emplace(surfaces_[surface], kEdgeError);
        }
        return *made;
    }

    // Starts at the farthest point of a lattice. Minus infinity where all of them are trimmed off.
    double climbed(const Patch& patch, Side side)
    {
        constexpr int kCells = 8;
        constexpr double kFinest = 1e-7;  // of the patch
        const Surface& s = patch.bezier.surface;
        const TrimRegion& trims = region(patch.surface);
        double most = -kInfinite;
        const auto is_farther = [&](Vec2d place) {
            if (std::min(place.x, place.y) < 0 || std::max(place.x, place.y) > 1) {
                return false;
            }
            const double u = s.u_begin() + place.x * (s.u_end() - s.u_begin());
            const double v = s.v_begin() + place.y * (s.v_end() - s.v_begin());
            const double reach = side.reach(point_at(s, u, v));
            if (reach <= most || (trims.trimmed() && !trims.inside(u, v))) {
                return false;
            }
            most = reach;
            return true;
        };
        std::optional<Vec2d> best;
        for (int k = 0; k < (kCells + 1) * (kCells + 1); ++k) {
            const Vec2d place{static_cast<double>(k % (kCells + 1)) / kCells,
                              static_cast<double>(k / (kCells + 1)) / kCells};
            if (is_farther(place)) {
                best = place;
            }
        }
        if (best) {
            pattern_search(*best, 0.5 / kCells, kFinest, is_farther);
        }
        return most;
    }

    const std::vector<Surface>& surfaces_;
    std::vector<std::optional<TrimRegion>> regions_;
    std::vector<Patch> patches_;
};

}  // namespace

PartExtent extent_of_surfaces(const std::vector<Surface>& surfaces)
{
    FarthestPlaces places{surfaces};
    return {{places.farthest({0, -1}), places.farthest({1, -1}), places.farthest({2, -1})},
            {places.farthest({0, 1}), places.farthest({1, 1}), places.farthest({2, 1})}};
}

double highest_of_surfaces(const std::vector<Surface>& surfaces)
{
    return FarthestPlaces{surfaces}.farthest({2, 1});
}

PartExtent extent_of_triangles(const Triangles& triangles)
{
    PartExtent box{triangles.front().front(), triangles.front().front()};
    for (const std::array<Vec3d, 3>& triangle : triangles) {
        for (const Vec3d corner : triangle) {
            box = {least(box.low, corner), greatest(box.high, corner)};
        }
    }
    return box;
}

PartExtent extent_of_curves(const std::vector<Curve>& chain)
{
    constexpr double kChord = 1e-3;  // mm
    Vec2d low{kUnbounded, kUnbounded};
    Vec2d high{-kUnbounded, -kUnbounded};
    for (const Vec2d& p : loop_polyline(chain, kChord)) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    return {{low.x, low.y, 0}, {high.x, high.y, 0}};
}

PartExtent joined(const PartExtent& a, const PartExtent& b)
{
    return {least(a.low, b.low), greatest(a.high, b.high)};
}

}  // namespace cusp::import
