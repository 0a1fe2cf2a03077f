// Slope and bend of a floor over a box in plan: bounds proved by the control points of its
// surfaces.
//
//     const SurfaceBounds floor{surfaces};
//     const SurfaceBounds::Bounds here = floor.over({0, 0}, {2, 1});
//     here.down;  // 1/mm: z + down / 2 * (x^2 + y^2) is convex there, where `edges` is false
//
// Use: a tool's height over a floor is the maximum of the floor's heights under it, each less the
// tool's own. A maximum of functions that become convex by the same parabola does so too. Thus it
// lies above the lines through neighbouring places and below the chords between places, but for
// that parabola.
//
// Method: bend_bounds() of cells that are halved to about the size of the box.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/part_model/bend_bounds.hpp"
#include "host_tools/geometry/part_model/bezier_cell.hpp"
#include "host_tools/geometry/part_model/trim_region.hpp"

namespace cusp::drop_cutter {

// Not for use by two threads at once.
class SurfaceBounds {
public:
    explicit SurfaceBounds(const std::vector<nurbs::Surface>& surfaces);

    struct Bounds : part_model::BendBounds {
        bool edges{};  // whether an edge, a trim or a crease may be in the box
    };
    // Bounds over the box [low, high], mm; all zero where there is no surface.
    Bounds over(Vec2d low, Vec2d high) const;

private:
    struct Patch {
        std::size_t surface;
        std::unique_ptr<part_model::BezierCell> cell;
        // True if there is an edge or a crease at its first and last u, first and last v.
        std::array<bool, 4> ends;
    };
    void add(const part_model::BezierCell& cell,
             const Patch& patch,
             Vec2d low,
             Vec2d high,
             Bounds& bounds) const;

    std::vector<part_model::TrimRegion> trims_;
    mutable std::atomic<std::size_t> made_{0};
    std::vector<Patch> patches_;
};

}  // namespace cusp::drop_cutter
