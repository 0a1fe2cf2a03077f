// Writes the moves of one tool through a pocket: entries into metal, links, cuts and retracts.
#pragma once

#include <vector>

#include "host_tools/clearing/tip_floor.hpp"
#include "host_tools/contour_pocket/floor_path.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::host {

struct PocketHeights {
    double top;        // of the stock, mm
    double clearance;  // z at which rapid moves run, mm
};

class PocketMoves {
public:
    explicit PocketMoves(const PocketHeights& heights) : heights_{heights} {}

    // Down to the start of a closed pass in uncut metal: round the pass again and again on a gentle
    // slope until the pass lies wholly at its depth; straight down where `plunge`.
    void enter_along(const FloorPath& pass, bool plunge);

    // Down on a helix of the given radius about the pass's start. floor_at gives the lowest tip
    // there.
    void enter_by_helix(Vec3d centre, double radius, const TipFloor& floor);

    void cut(const FloorPath& pass) { follow(MoveKind::kCut, pass); }
    void link(const FloorPath& path) { follow(MoveKind::kLink, path); }
    void retract();

    std::vector<ToolMove> take() { return std::move(moves_); }
    int retracts() const { return retracts_; }
    int points() const { return points_; }

private:
    void line(MoveKind kind, Vec3d end);
    void approach(Vec3d start);
    void follow(MoveKind kind, const FloorPath& path);

    PocketHeights heights_;
    std::vector<ToolMove> moves_;
    Vec3d at_{};
    int retracts_{};
    int points_{};
};

}  // namespace cusp::host
