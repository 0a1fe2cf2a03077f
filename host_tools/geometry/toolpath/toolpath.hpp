// The common result of all planners: moves of the tool tip, with what is known about them.
//
//     Toolpath path;
//     path.tool = {1, ToolShape::kBall, 3.0, 3.0};
//     path.feed = 1200;
//     path.moves = {{MoveKind::kRapid, LineTo{{0, 0, 5}}}, {MoveKind::kPlunge, LineTo{{0, 0, -1}}},
//                   {MoveKind::kCut, LineTo{{40, 0, -1}}}, {MoveKind::kRapid, LineTo{{40, 0, 5}}}};
//     write_program(out, form, {{path, stats}});         // gcode_writer.hpp
//     measure(path, start).cut_length_mm;          // toolpath_measure.hpp
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "firmware/base/vec.hpp"
#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/toolpath/tool.hpp"

namespace cusp::toolpath {

// One move of the tool tip; it starts where the one before ended.
enum class MoveKind : std::uint8_t {
    kRapid,
    kPlunge,       // at the plunge feed
    kCut,          // at the feed
    kLink,         // at the feed
    kPlungingCut,  // a cut or a link down into stock: nowhere faster downward than the plunge feed
};

struct LineTo {
    Vec3d end;
};
// An arc in a coordinate plane; the rest of the travel is linear (helix). Centre: the two
// coordinates of the plane are used.
enum class ArcPlane : std::uint8_t { kXY, kZX, kYZ };
struct ArcTo {
    Vec3d end;
    Vec3d centre;
    ArcPlane plane;
    bool clockwise;
};
struct NurbsTo {
    nurbs::Curve curve;  // starts where the tool is; degree 1 to 4
};

struct ToolMove {
    MoveKind kind{MoveKind::kCut};
    std::variant<LineTo, ArcTo, NurbsTo> shape;
    double feed{};  // mm/min, of cuts and links; 0: the path's
};

// The canned cycle of a path that only drills holes.
struct DrillCycle {
    double above;  // z: rapid moves end here
    double peck;   // mm: of a step, 0: in one go
};

// The moves of one operation with one tool, millimetres, from the clearance height and back to it.
// The first move is a rapid.
struct Toolpath {
    Tool tool;
    double feed{};         // mm/min, cuts and links; descents at most
    double plunge_feed{};  // mm/min
    double spindle{};      // rpm
    std::vector<ToolMove> moves;
    std::vector<std::string> comments;  // header lines: strategy and bounds
    std::string tool_name;              // may be empty
    // Only for paths that do nothing else; `moves` are the cycle's moves.
    std::optional<DrillCycle> cycle{};
};

// The part of an operation that rest machining left (rest_machining).
struct RestFigures {
    std::vector<std::string> programs;  // that were cut before
    double removed_mm{};                // of the feed moves as planned: left out
    double kept_mm{};
    double tolerance_mm{};  // stock thinner than this stays
};

// Statistics of every planner; planners add their own counts.
struct OperationStats {
    std::string strategy;
    // Stock left is for another operation: the scallop bound is no promise.
    bool roughing{false};
    int passes{};
    int levels{};
    int cl_points{};
    int retracts{};
    double gouge_bound_mm{};
    double scallop_bound_mm{};
    // Most stock over ground that the tool can't touch, where it is measured and the bound not proved.
    std::optional<double> left_measured_mm{};
    double planning_s{};
    // loops, isocurves, layers, cells, backtracks...
    std::vector<std::pair<std::string, double>> counts;
    std::vector<std::string> warnings;  // rest material, slots: for people
    std::optional<RestFigures> rest{};
};

// A planned operation. If nothing is to be cut it has no moves, but stats.warnings say why.
struct PlannedOperation {
    Toolpath path;
    OperationStats stats;
    int operation{0};  // its number in the job
};

}  // namespace cusp::toolpath
