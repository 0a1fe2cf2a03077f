// Cuts the passes of a cleared region on a floor: lays each, enters, links and retracts.
#pragma once

#include <functional>

#include "host_tools/clearing/clearing.hpp"
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
    // Where entries start, from the height of the pass there.
    std::function<EntryHeights(double)> entry_heights;
};

class FloorCutter {
public:
    FloorCutter(const Operation& operation, const TipFloor& floor, PocketMoves& moves)
        : operation_{operation}, floor_{floor}, moves_{moves}
    {
    }

    // Throws InputError where a pass leaves the floor.
    void cut(const ClearedRegion& cleared, const CutSettings& settings);

    // mm; 0, or negative by how much some move may cut into the floor.
    double least_gap() const { return least_gap_; }

private:
    FloorPath laid(const std::vector<Edge>& plan, const FloorPathSettings& laying);
    // cut: the pass as it is to be cut.
    void enter(const ClearingPass& pass,
               const FloorPath& cut,
               const CutSettings& settings,
               FloorPathSettings laying);

    const Operation& operation_;
    const TipFloor& floor_;
    PocketMoves& moves_;
    double least_gap_{0.0};
};

}  // namespace cusp::host
