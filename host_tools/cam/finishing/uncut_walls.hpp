// Walls that are vertical or nearly so, beside which stock is left, and the passes along them.
#pragma once

#include <functional>
#include <vector>

#include "host_tools/cam/finishing/scallop_at_point.hpp"
#include "host_tools/cam/finishing/wall_side.hpp"

namespace cusp::finishing {

class FinishArea;

// The part of the facets that is in the area, by slope and height; loops do not count.
std::vector<WallFacet> facets_in(const FinishArea& area, const std::vector<WallFacet>& facets);

// The work beside walls that `MeshScallopCheck` and `ScallopCheck` share: each gives its vertical
// facets, and WallSide looks at both sides of them.
//
// Walls are looked at on several threads; which looks at which does not depend on their number.
class UncutWalls {
public:
    // places  of the check, with its passes; kept
    UncutWalls(const GougeFreePathFitter& path_fitter, ScallopAtPoint& places);

    // Keeps the sides of facets in the fitter's area beside which stock is left, the lowest first: a pass at the foot of a
    // wall also cuts the stock over it.
    void find(const std::vector<WallFacet>& all);

    // Adds the passes that are missing along them. Each is given to `cut`, which must add the path it
    // cuts to the places. Forgets sides that are cut then.
    void add_missing(const std::function<void(const Points&)>& cut);

    // Forgets sides that have been cut since. mm: the most stock left beside the others.
    double measure_left();

    std::size_t size() const { return walls_.size(); }

private:
    struct Wall {
        WallSide side;
        std::vector<WallSide::Run> runs;  // where stock is left
    };
    // Plan boxes of the passes, grown by the tool's radius.
    struct Box {
        Vec2d low;
        Vec2d high;
    };
    class Cutter;

    struct Search {
        const ScallopAtPoint places;
        WallSide::KnownReach known;
    };
    // Calls work(search, k) for each k below count, neighbours with one search.
    void share_out(std::size_t count, const std::function<void(Search&, std::size_t)>& work) const;
    std::vector<WallSide::Run> missing_in_area(const WallSide& side,
                                               const ScallopAtPoint& places,
                                               WallSide::KnownReach& known) const;
    // Nothing to do where no pass was added since.
    void look_again();

    const GougeFreePathFitter& path_fitter_;
    ScallopAtPoint& places_;
    std::vector<Wall> walls_;
    std::size_t moves_seen_{};  // of the passes, when all walls were looked at last
};

}  // namespace cusp::finishing
