// How deep passes would cut into the metal that stands, and how high it stands before them.
#pragma once

#include <cstddef>
#include <vector>

#include "host_tools/clearing/standing_metal.hpp"
#include "host_tools/contour_pocket/floor_path.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::host {

class CutDepth {
public:
    // box     all places that tools may touch
    // finest  the smaller of the tools: the metal is known at places a 24th of its radius apart
    // top     of the uncut stock, z
    // most    mm: no cut may be deeper
    CutDepth(const Box2d& box, const Tool& finest, double top, double most);

    // Another tool begins a path of its own.
    void begin(const Tool& tool);

    // Takes off what moves do that were added to the path since.
    void feel(const std::vector<ToolMove>& path);

    struct Found {
        double highest{-1e300};  // z: where a tip coming down over the path first touches metal
        double level{-1e300};    // z: a tip no lower is nowhere too deep; none where none is
        bool too_deep() const { return level > -1e299; }
    };
    // What following the path would cut, in turn.
    // share: of `most`, what it may
    Found along(const FloorPath& path, double share);

    // Whether a tip that comes down to `height` anywhere on the circle cuts too deep.
    bool too_deep_around(Vec2d centre, double radius, double height) const;

    double most() const { return most_; }

    // mm: the deepest that the moves felt so far cut.
    double deepest() const { return deepest_; }

private:
    void look(Vec3d from, Vec3d tip, double most, Found& found);

    StandingMetal metal_;
    StandingMetal ahead_;  // what along() cuts
    double most_;
    double apart_{};  // mm between places of a path
    std::size_t felt_{0};
    Vec3d at_{};
    double deepest_{0.0};
};

}  // namespace cusp::host
