// Clears a plane region by passes of bounded engagement.
//
//     AdaptiveSettings settings;
//     settings.tool_radius = settings.wall_clearance = 3.0;       // mm
//     settings.max_engagement = 60.0 / 180.0 * kPi;
//     const AdaptivePath path = clear_adaptively(region, settings);
//     path.runs[0].helix->centre;      // down there first
//     path.runs[0].path;               // lines and arcs, tangent to each other
//     path.engagement_bound;           // radians: nowhere more outside entries and `over`
//
// Steered passes widen a hole until only narrow corners and necks are left of the part of the region
// that a tight turn reaches; passes along the contours of the region opened by shrinking radii cut
// into these. Trochoids open necks and slots that have hardly room for a turn. Each move is measured,
// before it is made, against what is swept until then.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host_tools/cam/adaptive_clearing/keep_down_links.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::adaptive_clearing {

struct AdaptiveSettings {
    double tool_radius{};     // mm
    double wall_clearance{};  // mm: of the tool's centre from the contours, > 0
    double max_engagement{};  // radians, above 0, below half a turn
    double tolerance{};       // mm: of chords in place of arcs
    double sliver{};  // mm: no pass goes for thinner stock beside walls; 0: what chords leave
    double corner{};  // mm: most that rounding leaves in a square corner
    job::CutDirection direction{job::CutDirection::kClimb};
    // Regions of the tool's centre where it meets no stock, such as beside the stock or where another
    // tool has been; they count as swept, and passes start there. Empty: stock is everywhere.
    std::vector<offset::Region2d> open;
    // If given, called after passes with about the share of the way that is done.
    std::function<void(double)> progress;
};

// An entry from above: turns about the centre down to the depth, the last half turn into the centre.
struct EntryHelix {
    Vec2d centre;
    double radius;  // mm; 0: no room, straight down
};

struct AdaptiveRun {
    // Then the path is an entry_spiral() from its centre, or empty.
    std::optional<EntryHelix> helix;
    std::vector<offset::Edge> path;
    std::vector<LinkLeg> link;     // from the end of the run before; empty: the tool lifts
    double tolerance{kUnbounded};  // mm, most: of chords in place of arcs
};

// A place at which the bound could not be kept.
struct OverEngagement {
    Vec2d at;           // of the greatest angle
    double engagement;  // radians
    double length;      // mm of way over the limit
    // mm: of a slot too narrow for trochoids; else it is a corner.
    std::optional<double> slot_width{};
};

struct AdaptivePath {
    std::vector<AdaptiveRun> runs;
    double engagement_bound{};         // radians, outside `over`
    std::vector<OverEngagement> over;  // in order of the path
    std::vector<Vec2d> left;           // slivers that no straight move reaches
    double length{};                   // mm of all runs
};

// mm: of the circle that the tool clears to the scallop height (mm, of a round corner at most its radius).
double cleared_radius(const toolpath::Tool& tool, double scallop_height);

// Empty where the tool fits nowhere.
AdaptivePath clear_adaptively(const offset::Region2d& region, const AdaptiveSettings& settings);

}  // namespace cusp::adaptive_clearing
