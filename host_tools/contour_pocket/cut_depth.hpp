// How deep passes would cut into the metal that stands, and how high it stands before them.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "host_tools/clearing/standing_metal.hpp"
#include "host_tools/contour_pocket/floor_path.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::host {

constexpr double kUnlimitedDepth = 1e300;

class CutDepth {
public:
    // box     all places that tools may touch
    // finest  the smaller of the tools: the metal is known at places a 24th of its radius apart
    // top     of the uncut stock, z
    // most    mm: no cut may be deeper; kUnlimitedDepth where any may
    CutDepth(const Box2d& box, const Tool& finest, double top, double most);

    // Another tool begins a path of its own.
    void begin(const Tool& tool);

    // Takes off what moves do that were added to the path since.
    void feel(const std::vector<ToolMove>& path);

    // What following the path would cut, move by move: no value where that is nowhere deeper than
    // `share` of what may be; else z of a level that a tip on the path may be raised to.
    std::optional<double> level_over(const FloorPath& path, double share);

    // z: where a tip that comes down over the path first touches metal.
    double highest(const FloorPath& path) const;

    // z: where a tip that comes down over the place first touches metal.
    double highest_at(Vec2d place) const;

    // z: where a tip that comes down somewhere on the circle first touches metal.
    double highest_around(Vec2d centre, double radius) const;

    double most() const { return most_; }

    // mm: the deepest that the moves felt so far cut.
    double deepest() const { return deepest_; }

private:
    template <class Visit>
    void walk(const FloorPath& path, Visit visit) const;

    StandingMetal metal_;
    StandingMetal ahead_;  // what level_over() cuts
    double most_;
    double apart_{};  // mm between places of a path
    std::size_t felt_{0};
    Vec3d at_{};
    double deepest_{0.0};
};

}  // namespace cusp::host
