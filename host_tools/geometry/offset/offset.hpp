// Offsets of regions bounded by lines and true arcs. Each offset is computed from the source
// contours, arcs remain arcs, and distances decide what is kept, not signs of areas.
//
//     const RegionOffset pocket{region};              // contours with the region on their left
//     for (double d = 1.0;; d += 2.0) {
//         const Region2d ring = pocket.at(d);         // points at least d mm from all contours
//         if (ring.contours.empty()) {
//             break;
//         }
//     }
//     pocket.clearance({3, 4});                       // mm from the nearest contour; < 0: outside
//
// All source contours are offset together. Thus an island that meets the boundary or another
// island, a neck that closes, and a part that splits need no case of their own. Raw offset pieces
// are cut where they cross. A piece belongs to the result exactly where no source edge is nearer.
#pragma once

#include <vector>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::offset {

// Not for use by two threads at once, const members included: at() remembers pieces that vanished.
class RegionOffset {
public:
    // Precondition: contours cross neither themselves nor each other (see region_check.hpp).
    explicit RegionOffset(Region2d source);

    // The points of the region at least `distance` (mm, > 0) from its contours, as contours with
    // the region on their left; empty if there is none. Every point of the result is within 1e-6 mm
    // of that distance from the source (tests/property/offset). If rounding defeats the joining at
    // this distance and at nine more within 1e-6 mm of it, it overlays the region with all points
    // that are too near (region_overlay.hpp): within 4e-6 mm. Cost O(n log n) for n evenly spread
    // edges; less after a smaller distance, which excludes edges.
    Region2d at(double distance) const;

    // Distance from the nearest contour; negative outside the region.
    double clearance(Vec2d point) const;

    // True if the point belongs to the region; undefined on a contour.
    bool contains(Vec2d point) const { return tree_.surrounds(point) != unbounded_; }

    // True if the nearest contour is nearer than `reach`.
    bool any_nearer(Vec2d point, double reach) const { return tree_.any_nearer(point, reach); }

    // The smaller of `limit` and the distance from the nearest contour, on either side.
    double nearest(Vec2d point, double limit) const { return tree_.nearest(point, limit); }

    // The nearest contour's nearest point. Precondition: there are contours.
    EdgeTree::Nearest nearest_edge(Vec2d point) const { return tree_.nearest_edge(point); }

    const Region2d& source() const { return source_; }

private:
    Region2d source_;
    EdgeTree tree_;
    bool touching_;   // two contours have a point in common
    bool unbounded_;  // the region is all that its contours do not enclose
    // For each raw piece (RawPiece::origin), a distance from which on nothing of it is left.
    mutable std::vector<double> gone_;
};

// The complement of the region: unbounded where the region is not.
Region2d reversed(const Region2d& region);

// The region grown by `distance` (mm, > 0), with rounded corners.
Region2d grown(const Region2d& region, double distance);

}  // namespace cusp::offset
