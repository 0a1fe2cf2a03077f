// A run of lines and arcs that a slope follows down into stock: its length in plan, its first part, the way back.
#pragma once

#include <vector>

#include "host_tools/geometry/nurbs/plan_vector.hpp"

namespace cusp::toolpath {

// A line or, with turn 1 (counter-clockwise) or -1, an arc in plan; the height changes evenly along it.
// An arc that ends where it starts is a whole circle.
struct RunPiece {
    Vec3d end;
    Vec2d centre{};
    int turn{};
};

struct EntryRun {
    Vec3d start;
    std::vector<RunPiece> pieces;

    Vec3d end() const { return pieces.empty() ? start : pieces.back().end; }
};

EntryRun run_along(const std::vector<Vec3d>& points);

// mm in plan, of one piece and of all.
double plan_length(Vec3d from, const RunPiece& piece);
double plan_length(const EntryRun& run);

// The first `length` mm of it, in plan; all of it where it is shorter.
EntryRun beginning(const EntryRun& run, double length);

EntryRun reversed(const EntryRun& run);

// The first part, in plan half of `way` long, and back to the start.
EntryRun there_and_back(const EntryRun& run, double way);

}  // namespace cusp::toolpath
