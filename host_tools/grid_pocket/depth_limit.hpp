// Runs over the floor that are never cut deeper than max_depth: where one would be, passes above it
// take the metal first.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/clearing/standing_metal.hpp"
#include "host_tools/grid_pocket/grid_moves.hpp"

namespace cusp::host {

class DepthLimit {
public:
    // moves, path  that the runs are added to; outlive this
    // most         mm: no limit where there is none, but the depth is felt all the same
    DepthLimit(GridMoves& moves,
               const Toolpath& path,
               const Box2d& box,
               double top,
               std::optional<double> most);

    // As GridMoves::enter(), but to the first level where metal stands over the start of the run.
    void enter(const FloorFollower& floor,
               const std::vector<Vec2d>& corners,
               double metal,
               bool link,
               const GridMoves::CircleFloor& circle);

    // As FloorFollower::follow(), from where the tip stands at the first corner or over it.
    void follow(FloorFollower& floor,
                const std::vector<Vec2d>& corners,
                const GridMoves::CircleFloor& circle);

    // Whether following the corners would cut too deep anywhere.
    bool too_deep(const FloorFollower& floor, const std::vector<Vec2d>& corners);

    // Brings the metal up to date with all moves so far.
    void feel_moves();

    // mm: the deepest that the moves felt so far cut.
    double deepest() const { return deepest_; }

    // Passes that were added.
    int added() const { return added_; }

private:
    struct Stretch {
        double begin;  // mm along a segment
        double end;
        double level;  // z of a tip that does not cut too deep there
        double low;    // the lowest that moves may be
    };

    GridMoves& moves_;
    const Toolpath& path_;
    std::optional<double> most_;
    StandingMetal metal_;
    double look_;          // mm between places of a run that are looked at
    std::size_t felt_{0};  // moves that the metal knows of
    Vec3d at_{};           // where they end
    double deepest_{0};
    int added_{0};

    // Where a tip at the lowest over the floor would cut too deep.
    std::vector<Stretch> deep_stretches(const FloorFollower& floor, Vec2d a, Vec2d b) const;
    void follow_segment(FloorFollower& floor,
                        Vec2d a,
                        Vec2d b,
                        const GridMoves::CircleFloor& circle);
    void lower(FloorFollower& floor, Vec2d a, Vec2d b, const GridMoves::CircleFloor& circle);
};

}  // namespace cusp::host
