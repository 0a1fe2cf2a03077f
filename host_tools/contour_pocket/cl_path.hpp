// A path of the tool in plan, dropped onto the floor: a chain of straight moves and arcs of the tip
// that stay within the tolerances and above the floor.
#pragma once

#include <variant>
#include <vector>

#include "host_tools/drop_cutter/drop_cutter.hpp"
#include "host_tools/offset/contour.hpp"

namespace cusp::contour_pocket {

struct ClPathSettings {
    double plan_tolerance{};    // mm: how far a move may lie beside the plan path, either way
    double height_tolerance{};  // mm: width of the band above the floor that moves stay in
    // false: moves stay within `height_tolerance` on either side of the floor
    bool one_sided{true};
    bool arcs{false};   // true: helical arcs in plan where they reach farther than a line
    bool nurbs{false};  // true: cubic B-splines between corners, lines where none fits
    bool even{false};   // true: each edge in equal pieces (links; see equal_pieces.hpp)
    // mm: kept off the floor, so that certifying a move needs no finer floor
    double clearance_reserve{};
    double allowance{};         // mm: metal left over the floor, measured along the axis
    double min_z{-kUnbounded};  // mm: the tip stays at or above this z
    double spacing{};           // mm between the floor heights that moves are made for
    // mm: cubics between lookups no farther apart are good enough; 0: not known
    double lookup_spacing{};
};

// One move; turn 0: straight. An arc rises evenly with its angle and sweeps less than half a turn.
// Where the curve has points, it is the move.
struct ClMove {
    Vec3d end;
    Vec2d centre{};
    int turn{};
    nurbs::Curve curve{};
};

struct ClPath {
    Vec3d start;
    std::vector<ClMove> moves;
    // mm: lower bound of the gap between floor and tool, over all moves; may be < 0
    double least_clearance{};
    bool over_floor{true};
    Vec2d missing;  // a place without floor, where not over_floor
};

// Coordinates are multiples of this, mm: what is certified is what is written.
constexpr double kWrittenStep = 1e-4;

// How near to a path that is cut more than once its moves stay, mm.
double repeated_plan_tolerance(double plan_tolerance);

// The plan path as lines (and arcs) that may then be cut at several heights, each within
// repeated_plan_tolerance() of the others, and all within `plan_tolerance` (mm) of the plan path:
// no pass meets a sliver that the one above it left beside a wall at full depth.
std::vector<offset::Edge> flattened(const std::vector<offset::Edge>& plan,
                                    double plan_tolerance,
                                    double spacing,
                                    bool arcs);

// Drops a chain of edges onto the floor. Where its end is its start, so are the path's.
ClPath drop_path(const std::vector<offset::Edge>& plan,
                 const drop_cutter::DropCutter& floor,
                 const ClPathSettings& settings);

}  // namespace cusp::contour_pocket
