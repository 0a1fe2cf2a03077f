// What one cutter does in one layer: zigzag over the free part, then along the outlines of the
// islands.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "host_tools/clearing/layer_toolpath_writer.hpp"
#include "host_tools/hull_rough/layer_coverage.hpp"
#include "host_tools/hull_rough/zigzag.hpp"
#include "host_tools/offset/offset.hpp"

namespace cusp::hull_rough {

struct LayerSettings {
    double step{};       // mm between lines, > 0, at most twice `clears`
    double clears{};     // mm to either side that the cutter clears flat enough; at most its radius
    double tolerance{};  // mm, > 0: what chords on rounded corners may take from the distance kept
    double side_allowance{};
    bool one_way{};
    bool contour{};  // loops parallel to the outlines instead of lines
    job::CutDirection direction{};
};

// Every point of the layer that a cutter of this radius can reach without touching a box is
// cleared: it lies within the radius of a line, or of an outline, whatever the islands are. Proof
// in docs/papers.md, "Chuang & Pan". Loops parallel to the outlines have no such proof: what
// uncovered_spots() finds that they leave is cleared by the parts of lines and outlines around it.
struct LayerClearing {
    std::shared_ptr<ClearZone> zone;
    std::shared_ptr<offset::RegionOffset> centres;  // the region where the axis may stand
    std::vector<clearing::LayerRun> runs;
    bool by_contours{};     // as asked for; else by zigzag
    double length{};        // mm of cut
    UncoveredSpots left;    // what could be cleared and is not
    double closed_area{};   // mm^2 that contours left and parts of lines and outlines cleared
    double cleared_area{};  // mm^2 of the stock's plan view
    int islands{};
};

LayerClearing clear_layer(const std::vector<Rectangle>& boxes,
                          const Rectangle& stock,
                          double radius,
                          const LayerSettings& settings);

// A cutter that has cleared a layer, and how far others may stand from its places:
// rest_offset_between_tools().
struct ClearedBy {
    const LayerClearing* clearing{};
    double rest_offset{};
};

// The parts of the runs where the cutter takes metal that none of the cutters before has taken.
// radius: of the cutter, mm.
std::vector<clearing::LayerRun> uncut_runs(const LayerClearing& clearing,
                                           double radius,
                                           const std::vector<ClearedBy>& before);

}  // namespace cusp::hull_rough
