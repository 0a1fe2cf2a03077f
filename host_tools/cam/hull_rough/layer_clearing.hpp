// Clearing of one layer by one cutter: a zigzag over the clear zone, then passes along the outlines
// of the islands.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "host_tools/cam/adaptive_clearing/adaptive_clearing.hpp"
#include "host_tools/cam/clearing/layer_toolpath_writer.hpp"
#include "host_tools/cam/hull_rough/layer_coverage.hpp"
#include "host_tools/cam/hull_rough/zigzag.hpp"
#include "host_tools/geometry/offset/offset.hpp"

namespace cusp::hull_rough {

struct LayerSettings {
    double step{};       // mm between lines, > 0, at most twice `clears`
    double clears{};     // mm: half the width cleared to the scallop height; at most the radius
    double tolerance{};  // mm, > 0: of chords on rounded corners
    double side_allowance{};  // mm
    bool one_way{};
    bool contour{};  // loops parallel to the outlines instead of lines
    job::CutDirection direction{};
    std::optional<double> max_engagement;  // radians: passes of bounded engagement
};

// Every point of the layer that a cutter of this radius can reach without touching a box is
// cleared: for any islands it lies within the radius of a line or of an outline. Proof in
// docs/papers.md, "Chuang & Pan". Loops parallel to the outlines have no such proof: the spots that
// uncovered_spots() finds are cleared by nearby parts of lines and outlines.
struct LayerClearing {
    std::shared_ptr<ClearZone> zone;
    std::shared_ptr<offset::RegionOffset> centres;  // the region of the axis
    std::vector<clearing::LayerRun> runs;  // of an adaptive path only to see what they clear
    std::optional<adaptive_clearing::AdaptivePath> adaptive;
    std::vector<Rectangle> boxes;  // with an adaptive path
    bool by_contours{};            // by contours as requested; else by zigzag
    double length{};               // mm of cut
    UncoveredSpots left;           // reachable spots that are not cleared
    double closed_area{};   // mm^2 left by contours, then cleared by parts of lines and outlines
    double cleared_area{};  // mm^2 of the stock in plan
    int islands{};
};

LayerClearing clear_layer(const std::vector<Rectangle>& boxes,
                          const Rectangle& stock,
                          double radius,
                          const LayerSettings& settings);

// A cutter that has cleared a layer, and how far outside its region another one finds no stock, by
// rest_offset_between_tools().
struct ClearedBy {
    const LayerClearing* clearing{};
    double rest_offset{};
};

// Passes of bounded engagement where the cutters before have left stock. The bound is that of the
// circle that the cutter clears to the scallop height: larger circles of the same cutter, higher
// up, have no more of their circumference in stock.
//
// radius  mm, of the cutter
adaptive_clearing::AdaptivePath adaptive_layer(const LayerClearing& clearing,
                                               const Rectangle& stock,
                                               double radius,
                                               const LayerSettings& settings,
                                               const std::vector<ClearedBy>& before);

// The parts of the runs where the cutter removes stock that the cutters before have left.
//
// radius  mm, of the cutter
std::vector<clearing::LayerRun> uncut_runs(const LayerClearing& clearing,
                                           double radius,
                                           const std::vector<ClearedBy>& before);

}  // namespace cusp::hull_rough
