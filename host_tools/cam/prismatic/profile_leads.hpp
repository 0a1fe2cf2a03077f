// Arcs by which the tool comes onto a contour and leaves it, on the side of the waste.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host_tools/cam/prismatic/contour_run.hpp"
#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::prismatic {

// A quarter of a circle each; no edge where there is none.
struct Leads {
    std::optional<offset::Edge> in;
    std::optional<offset::Edge> out;
};

struct LeadSettings {
    double in{};           // mm: radius; 0: none
    double out{};          // mm
    double clearance{};    // mm: least distance of the tool's centre from the walls
    bool waste_on_left{};  // of the contour
};

struct LeadContour {
    ContourRun run;  // from where the leads are
    Leads leads;
};

// True if a way keeps the tool's centre so far from the walls, mm.
bool keeps_clear(const offset::Edge& way, const offset::EdgeTree& walls, double clearance);

// The contour from a place where the leads have room: on a long side, away from `kept` (mm along the contour) by
// `free`. Radii are halved where nowhere has room for them, and left out below a sixteenth.
//
// walls  the edges that the tool keeps its clearance from
// way    mm of rapid moves that a place costs: the least counts, else the middle of the longest side. May be empty
LeadContour with_leads(const ContourRun& contour,
                       const offset::EdgeTree& walls,
                       const std::vector<double>& kept,
                       double free,
                       const LeadSettings& settings,
                       const std::function<double(Vec2d)>& way);

}  // namespace cusp::prismatic
