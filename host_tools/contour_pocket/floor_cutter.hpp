// Cuts the passes of a cleared region on a floor: lays each, enters, links and retracts.
#pragma once

#include <functional>
#include <optional>

#include "host_tools/clearing/clearing.hpp"
#include "host_tools/contour_pocket/cut_depth.hpp"
#include "host_tools/contour_pocket/floor_path.hpp"
#include "host_tools/contour_pocket/pocket_moves.hpp"
#include "host_tools/import/job.hpp"

namespace cusp::host {

// What roughing left beside some passes stands to the top of the stock, thinner than the metal may
// be known for.
struct StandingBeside {
    std::vector<bool> passes;  // which; empty: none
    double top{};              // z of the stock
    // z, downward: such passes are cut at these first, as far as they lie deeper; those that are
    // linked to each other together.
    std::vector<double> heights;
};

struct CutSettings {
    FloorPathSettings laying;
    EntryKind entry{EntryKind::kAuto};
    double first{};  // mm: least distance of the tool's centre from the walls
    // Passes that nowhere go deeper than this are left out (cut by the layer above).
    double skip_above{1e300};
    // Which passes have paths that are cut at several heights (flattened()); empty: none.
    std::vector<bool> repeated;
    StandingBeside standing;
    // Of the depth allowed: what a pass may cut as far as the metal is known.
    double depth_share{1.0};
    // How often the tool may have gone up at the end, the last time included; no fewer than there
    // are entries. So that these have theirs others are reached above the metal, however far.
    int retracts{};
    // Where entries start, from the height of the pass there.
    std::function<EntryHeights(double)> entry_heights;
    // Where given, called with the share of the passes that is laid.
    std::function<void(double)> progress;
};

// Where the tool's axis may be that keeps `first` mm off the walls but for rounding.
Region2d reach_of(const RegionOffset& walls, double first);

class FloorCutter {
public:
    // walls  of the pocket
    // depth  where given, passes that would cut too deep are cut at levels over them first, and
    //        entries start over the metal that stands; passes that have no link are reached by
    //        short ways above it
    FloorCutter(const Operation& operation,
                const TipFloor& floor,
                const RegionOffset& walls,
                PocketMoves& moves,
                CutDepth* depth)
        : operation_{operation}, floor_{floor}, walls_{walls}, moves_{moves}, depth_{depth}
    {
    }

    // Throws InputError where a pass leaves the floor. The tool stays where the last pass ends.
    void cut(const ClearedRegion& cleared, const CutSettings& settings);

    // Takes the tool up from its last pass.
    void end();

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
    bool step_over(const Laid& laid, const CutSettings& settings);
    bool go_round(const Laid& laid, const CutSettings& settings);
    bool is_worth_it(const std::vector<Edge>& way) const;
    void follow_over(const std::vector<Edge>& way, double above, const CutSettings& settings);
    void begin(const Laid& laid, const CutSettings& settings);
    void go_back(const std::vector<ClearingPass>& passes,
                 std::size_t from,
                 std::size_t to,
                 const CutSettings& settings);
    void cut_standing(std::vector<ClearingPass>& passes, const CutSettings& settings);
    void cut_last(ClearingPass& pass, const CutSettings& settings, bool repeated);
    void cut_pass(ClearingPass& pass, const CutSettings& settings, bool repeated);
    Laid cut_above(const Laid& deep, const CutSettings& settings, bool repeated);
    FloorPath laid(const std::vector<Edge>& plan, const FloorPathSettings& laying);
    void enter(const Laid& cut, const CutSettings& settings);
    void feel();
    double metal_around(Vec2d start, double radius) const;

    const Operation& operation_;
    const TipFloor& floor_;
    const RegionOffset& walls_;
    PocketMoves& moves_;
    CutDepth* depth_;
    double least_gap_{0.0};
    int may_retract_{0};  // until now
    std::optional<Region2d> reach_;
};

}  // namespace cusp::host
