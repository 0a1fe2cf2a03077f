// The common result of all planners: passes of the tool tip, and how they are linked and written.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "firmware/base/vec.hpp"
#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::host {

enum class ToolShape : std::uint8_t { kBall, kFlat, kBull };

// "ball", "flat" or "bull".
const char* name_of(ToolShape shape);

struct Tool {
    int number{1};
    ToolShape shape{ToolShape::kBall};
    double radius{};         // mm
    double corner_radius{};  // mm: radius for a ball, 0 for a flat end mill
};

// Height of the tool's lower side over its tip at distance `d` from its axis; infinity beyond the
// radius.
double profile_height(const Tool& tool, double d);

// One move of the tool tip; it starts where the one before ended.
enum class MoveKind : std::uint8_t {
    kRapid,
    kPlunge,   // at the plunge feed
    kCut,      // at the feed
    kLink,     // at the feed
    kDescent,  // a cut or a link down into metal: nowhere faster downward than the plunge feed
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
    Curve curve;  // starts where the tool is; degree 1 to 4
};

struct ToolMove {
    MoveKind kind{MoveKind::kCut};
    std::variant<LineTo, ArcTo, NurbsTo> shape;
};

// The moves of one operation with one tool, millimetres, from the clearance height and back to it.
// The first move is a rapid; `start` is where it comes from in x and y (unknown for the first
// operation).
struct Toolpath {
    Tool tool;
    double feed{};         // mm/min, cuts and links; descents at most
    double plunge_feed{};  // mm/min
    double spindle{};      // rpm
    std::vector<ToolMove> moves;
    std::vector<std::string> comments;  // header lines: strategy and bounds
};

// What every planner reports; planners add their own counts (PRODUCT.md, "What cusp plan reports").
struct OperationStats {
    std::string strategy;
    bool roughing{
        false};  // what it leaves is for another operation: its scallop bound is no promise
    int passes{};
    int levels{};
    int cl_points{};
    int retracts{};
    double gouge_bound_mm{};
    double scallop_bound_mm{};
    double planning_s{};
    std::vector<std::pair<std::string, double>>
        counts;                         // loops, isocurves, layers, cells, backtracks...
    std::vector<std::string> warnings;  // rest material, slots: for people
};

// A planned operation.
struct PlannedOperation {
    Toolpath path;
    OperationStats stats;
};

}  // namespace cusp::host
