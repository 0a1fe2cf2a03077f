// Projection of a tool path in plan onto the floor: a chain of lines and arcs of the tip, within
// the tolerances and above the floor.
//
//     const DropCutter cutter{surfaces, tool, 0.001};
//     ClPathSettings settings;
//     settings.plan_tolerance = 0.01;
//     settings.height_tolerance = 0.02;
//     settings.clearance_reserve = 0.001;
//     settings.spacing = 0.5;
//     const ClPath path = drop_path({line_edge({0.0, 0.0}, {40.0, 0.0})}, cutter, settings);
//     // path.over_floor: a surface lies under all of it; path.least_clearance >= 0: no move gouges
//
// Three steps. Stations: the drop cutter gives heights along the plan, close enough for chords.
// Chain: the longest moves through the bands of the stations. Proof: DropCutter::move_clearance()
// bounds the clearance of each move, and moves that would gouge are raised.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/cam/cl_path/path_floor.hpp"
#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::cl_path {

struct ClPathSettings {
    double plan_tolerance{};    // mm: largest distance of a move from the plan path, to either side
    double height_tolerance{};  // mm: width of the band above the floor for moves
    // false: moves stay within `height_tolerance` above or below the floor
    bool one_sided{true};
    bool arcs{false};   // true: helical arcs in plan where they are longer than a line
    bool nurbs{false};  // true: cubic B-splines between corners, lines where none fits
    bool even{false};   // true: each edge in equal pieces (for links; see equal_pieces.hpp)
    // mm: reserve above the floor, so that certifying a move needs no finer floor bounds
    double clearance_reserve{};
    double allowance{};          // mm: stock left over the floor, measured along the axis
    double min_z{-kUnbounded};   // mm: the tip stays at or above this z
    bool level_at_min_z{false};  // true: moves over a floor below `min_z` run at it, without a band
    std::optional<double> start_z{};  // mm: where the tip is; none: in the middle of the band
    double spacing{};                 // mm: largest distance between stations
    // mm: up to this distance between stations, cubics between them are accurate; 0: not known
    double lookup_spacing{};
};

// One move; turn 0: straight. An arc climbs linearly with its angle and sweeps less than half a
// turn. If the curve has points, the curve is the move.
struct ClMove {
    Vec3d end;
    Vec2d centre{};
    int turn{};
    nurbs::Curve curve{};
};

struct ClPath {
    Vec3d start;
    std::vector<ClMove> moves;
    // mm: lower bound of the clearance between floor and tool, over all moves; may be < 0
    double least_clearance{};
    bool over_floor{true};  // false: part of the path has no floor below it
    Vec2d missing;          // a place without floor, unless over_floor
};

// Coordinates are multiples of this, mm, so the certified path is the written path.
constexpr double kWrittenStep = 1e-4;

// mm: how near a path cut at several heights keeps to its plan path at each of them.
double repeated_plan_tolerance(double plan_tolerance);

// The plan path as lines (and arcs) that may be cut at several heights, each within
// repeated_plan_tolerance() of the others and within `plan_tolerance` (mm) of the plan path. Thus
// no pass cuts, at full depth, a sliver that the pass above it left beside a wall.
std::vector<offset::Edge> flattened(const std::vector<offset::Edge>& plan,
                                    double plan_tolerance,
                                    double spacing,
                                    bool arcs);

// Projects a chain of edges onto the floor. A closed chain gives a closed path.
ClPath drop_path(const std::vector<offset::Edge>& plan,
                 const PathFloor& floor,
                 const ClPathSettings& settings);

}  // namespace cusp::cl_path
