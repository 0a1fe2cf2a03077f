// Offsets of regions bounded by lines and true arcs: every level is taken from the source contours,
// arcs stay arcs, and what is kept is decided by distance, not by the sign of an area.
//
//     const RegionOffset walls{region};
//     for (double distance = 3.0;; distance += 2.0) {
//         const Region2d level = walls.at(distance);
//         if (level.contours.empty()) { break; }
//         ...
//     }
//
// All source contours are offset together, so an island that meets the boundary or another island,
// a neck that closes and a part that splits need no case of their own: the raw offset pieces are
// cut where they cross, and a piece belongs to the result exactly where no source edge lies nearer.
#pragma once

#include <vector>

#include "host_tools/offset/contour.hpp"
#include "host_tools/offset/edge_tree.hpp"

namespace cusp::offset {

class RegionOffset {
public:
    // The contours must not cross themselves or each other (see region_check.hpp).
    explicit RegionOffset(Region2d source);

    // The points of the region at least `distance` (mm, > 0) from its contours, as contours with
    // the region on their left; empty where no such point is left. Every point of the result lies
    // within 1e-6 mm of that distance (tests/property/offset). Cost O(n log n) for n edges spread
    // evenly; less where a nearer level has been asked for, with what is left of the edges there.
    // Not for two threads at once.
    Region2d at(double distance) const;

    // Distance from the nearest contour; negative outside the region.
    double clearance(Vec2d point) const;

    // True where the point belongs to the region; points on a contour count either way.
    bool contains(Vec2d point) const { return tree_.surrounds(point); }

    // True where the distance from the nearest contour is below `reach`.
    bool any_nearer(Vec2d point, double reach) const { return tree_.any_nearer(point, reach); }

    // Distance from the nearest contour on either side, or `limit` where that is less.
    double nearest(Vec2d point, double limit) const { return tree_.nearest(point, limit); }

    const Region2d& source() const { return source_; }

private:
    Region2d source_;
    EdgeTree tree_;
    bool touching_;  // two contours have a point in common
    // Of each raw piece (RawPiece::origin): a distance from which on nothing of it is left. A const
    // query only adds to it.
    mutable std::vector<double> gone_;
};

// The region grown by `distance` (mm, > 0), corners rounded.
Region2d grown(const Region2d& region, double distance);

}  // namespace cusp::offset
