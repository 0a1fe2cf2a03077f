// Converts a plane region to closed passes of the tool's centre: offset loops, their order, and the
// link from each to the next. Shared by all planners for pockets and layers.
//
//     ClearingSettings settings;
//     settings.wall_clearance = tool.radius;
//     settings.stepover = 0.5 * tool.radius;
//     for (const ClearingPass& pass : clear_region(region, settings).passes) {
//         if (pass.start == PassStart::kLink) { ... pass.link ... }
//         ... pass.path ...  // a closed loop
//     }
//
// Loops lie at growing distances from the contours. They form trees (a loop's child is the next one
// inside it), which are cut deepest first, so that the tool works from the inside towards the walls
// and each loop but the deepest of a branch starts beside stock already cut. Rings around islands
// that have not met the boundary yet are cut first (Suh & Lee 1990, "Determination of cutting
// order").
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::clearing {

// The strip between two neighbouring rings of loops.
struct LoopStrip {
    const offset::Region2d& outer;
    const offset::Region2d& inner;  // empty if the outer one is the last
    double from;                    // mm: distance of the outer ring from the contours
    double to;                      // mm: of the inner ring
    const offset::RegionOffset& walls;
};

// A part of a loop between two rings, or a whole loop.
struct PartialLoop {
    offset::Contour path;  // as for loops, the inward region is on its left
    int ring{};            // of the loop outside it
    double depth{};        // mm inward from that loop
    bool whole{};          // the path is closed
};

struct ClearingSettings {
    // mm: distance of the outermost pass from the contours (tool radius, allowance)
    double wall_clearance{};
    double stepover{};  // mm: largest distance between passes
    // If given, the largest distance inward from a ring of loops; limited by `stepover`.
    std::function<double(const offset::Region2d& ring)> stepover_from;
    // If given, the scallop between two rings as a share of the allowed height. Rings are moved
    // together until it is at most 1, or apart, up to half of `stepover`, if it is less.
    std::function<double(const LoopStrip& strip)> scallop_share_between;
    // If given: how far inward (mm) the next ring may lie if partial loops fill the strip; 0 if
    // whole loops `stepover` mm apart are no longer. And these partial loops; none if they do not
    // suffice or add more than `max_length` mm of path.
    std::function<double(const offset::Region2d& ring, double step)> partial_stepover;
    std::function<std::optional<std::vector<PartialLoop>>(const LoopStrip& strip,
                                                          double max_length)>
        partial_loops;
    job::CutDirection direction{job::CutDirection::kClimb};
    // Reduces the distance of loops where corners, necks or the middle would be farther than half a
    // step from every pass.
    bool cover_corners{true};
};

enum class PassStart : std::uint8_t {
    kPlungeEntry,     // in uncut stock: needs a helix, a ramp or a plunge
    kRetractAndDrop,  // beside stock already cut, after a retract
    kContinue,        // at the end of the pass before
    kLink,  // by `link` from the end of the pass before, through stock it has cut or is to cut
};

struct ClearingPass {
    offset::Contour path;  // closed; starts and ends at path.front().start
    // If not empty: cut instead of the path once that has been cut at all heights above it; with
    // equal start.
    offset::Contour final_path;
    int ring{};       // 0: next to the contours
    double offset{};  // of the ring from the contours, mm
    PassStart start{};
    // Tangent arcs if there is room, else a straight line, else along the pass before and across.
    std::vector<offset::Edge> link;
    bool around_island{};
    bool is_pencil{};
    double wall_distance{};  // mm: from the start of the path to the nearest contour
    // mm: to the next ring inward; the largest width of stock left between.
    double stepover{};
};

struct ClearedRegion {
    std::vector<ClearingPass> passes;  // in the order to cut
    int rings{};
    int leaves{};                      // passes with no other inside
    double widest_gap{};               // largest step between two rings, mm
    std::vector<PartialLoop> partial;  // for put_in_partial_loops()
    double saved{};                    // mm of path saved by partial loops, approximately
    job::CutDirection direction{};
};

// Limit of the number of rings.
inline constexpr int kMaxRings = 20000;

// Passes for the region enclosed by its contours. Empty if the tool fits nowhere.
ClearedRegion clear_region(const offset::Region2d& region, const ClearingSettings& settings);

}  // namespace cusp::clearing
