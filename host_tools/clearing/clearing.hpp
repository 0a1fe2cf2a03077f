// A plane region to closed passes of the tool's centre: offset loops, their order, and how one is
// reached from the one before. What all planners share for pockets and layers.
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

#include "host_tools/job/job.hpp"
#include "host_tools/offset/offset.hpp"

namespace cusp::clearing {

// What lies between two neighbouring levels of loops.
struct LoopStrip {
    const offset::Region2d& outer;
    const offset::Region2d& inner;  // empty where the outer one is the last
    double from;                    // mm: distance of the outer one from the contours
    double to;                      // mm: of the inner one
    const offset::RegionOffset& walls;
};

// A part of a loop between two levels, or all of one.
struct PartialLoop {
    offset::Contour path;  // runs as loops do: the region inward lies on its left
    int ring{};            // of the loop outside it, which it refines
    double depth{};        // mm inward from that one
    bool whole{};          // the path is closed
};

struct ClearingSettings {
    // mm: distance of the outermost pass from the contours (tool radius, allowance)
    double wall_clearance{};
    double stepover{};  // mm: largest distance between passes
    // Where given, the largest distance inward from a level of loops; `stepover` bounds it.
    std::function<double(const offset::Region2d& level)> stepover_from;
    // Where given, the scallop between two rings over the height allowed: they are moved nearer
    // together until it is at most 1, or apart, up to half of `stepover`, where it is less.
    std::function<double(const LoopStrip& strip)> scallop_share_between;
    // Where given: how far inward the next level may lie if partial loops are made where that is
    // too far, mm; 0 where whole loops, `stepover` mm apart, are no longer. And these partial
    // loops; no value where they do not suffice or add more than `max_length` mm of path.
    std::function<double(const offset::Region2d& level, double step)> partial_stepover;
    std::function<std::optional<std::vector<PartialLoop>>(const LoopStrip& strip,
                                                          double max_length)>
        partial_loops;
    job::CutDirection direction{job::CutDirection::kClimb};
    // Draws loops nearer together where corners, necks or the middle would else lie farther than
    // half a step from every pass.
    bool cover_corners{true};
};

enum class PassStart : std::uint8_t {
    kPlungeEntry,     // in uncut stock: needs a helix, a ramp or a plunge
    kRetractAndDrop,  // beside stock already cut, after a retract
    kContinue,        // where the pass before ends
    kLink,  // by `link` from the end of the pass before, through stock it has cut or is to cut
};

struct ClearingPass {
    offset::Contour path;  // closed; starts and ends at path.front().start
    // Where not empty: cut in place of the path once that has been cut at all heights over it; the
    // same start.
    offset::Contour final_path;
    int ring{};       // 0: next to the contours
    double offset{};  // of the level from the contours, mm
    PassStart start{};
    // Tangent arcs where there is room, else a straight line; else along the pass before and over.
    std::vector<offset::Edge> link;
    bool around_island{};
    bool is_pencil{};
    double wall_distance{};  // mm: from the start of the path to the nearest contour
    // mm: to the next ring inward; material may be left between, as wide as this.
    double stepover{};
};

struct ClearedRegion {
    std::vector<ClearingPass> passes;  // in the order to cut
    int rings{};
    int leaves{};                      // passes without one further inside
    double widest_gap{};               // largest step between two levels, mm
    std::vector<PartialLoop> partial;  // for put_in_partial_loops()
    double saved{};                    // mm of path that partial loops save over whole ones, about
    job::CutDirection direction{};
};

// More levels than these are not made.
inline constexpr int kMaxRings = 20000;

// Passes for the region that is left of its contours. Empty where the tool does not fit anywhere.
ClearedRegion clear_region(const offset::Region2d& region, const ClearingSettings& settings);

}  // namespace cusp::clearing
