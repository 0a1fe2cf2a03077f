// Cuts the passes of a cleared region on a floor: lays each, enters, links and retracts.
#pragma once

#include <functional>

#include "host_tools/clearing/clearing.hpp"
#include "host_tools/contour_pocket/cut_depth.hpp"
#include "host_tools/contour_pocket/floor_path.hpp"
#include "host_tools/contour_pocket/pocket_moves.hpp"
#include "host_tools/import/job.hpp"

namespace cusp::host {

struct CutSettings {
    FloorPathSettings laying;
    EntryKind entry{EntryKind::kAuto};
    double first{};  // mm: least distance of the tool's centre from the walls
    // Passes that nowhere go deeper than this are left out (cut by the layer above).
    double skip_above{1e300};
    // Which passes have paths that are cut at several heights (flattened()); empty: none.
    std::vector<bool> repeated;
    // Of the depth allowed: what a pass may cut as far as the metal is known.
    double depth_share{1.0};
    // Where entries start, from the height of the pass there.
    std::function<EntryHeights(double)> entry_heights;
};

class FloorCutter {
public:
    // depth  where given, passes that would cut too deep are cut at levels over them first, and
    //        entries start over the metal that stands
    FloorCutter(const Operation& operation,
                const TipFloor& floor,
                PocketMoves& moves,
                CutDepth* depth)
        : operation_{operation}, floor_{floor}, moves_{moves}, depth_{depth}
    {
    }

    // Throws InputError where a pass leaves the floor.
    void cut(const ClearedRegion& cleared, const CutSettings& settings);

    // mm; 0, or negative by how much some move may cut into the floor.
    double least_gap() const { return least_gap_; }

private:
    // A pass as it is laid.
    struct Laid {
        ClearingPass pass;
        FloorPathSettings laying;
        FloorPath path;
    };
    Laid lay(const ClearingPass& pass, const CutSettings& settings, bool repeated);
    bool too_deep(const FloorPath& path, const CutSettings& settings) const;
    bool link(const Laid& laid, const CutSettings& settings);
    Laid cut_above(const Laid& laid, const CutSettings& settings, bool repeated);
    FloorPath laid(const std::vector<Edge>& plan, const FloorPathSettings& laying);
    void enter(const Laid& cut, const CutSettings& settings);
    double metal_around(Vec2d start, double radius) const;

    const Operation& operation_;
    const TipFloor& floor_;
    PocketMoves& moves_;
    CutDepth* depth_;
    double least_gap_{0.0};
};

}  // namespace cusp::host
