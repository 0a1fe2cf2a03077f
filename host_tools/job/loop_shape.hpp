// Loops of curves: polylines of them, and how a file's loop becomes closed, simple and
// counter-clockwise.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/job/job.hpp"
#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::job {

// Chords of the curves of a loop, seen from above, each within `tolerance` mm of its curve. The
// last point is the first one again.
std::vector<Vec2d> loop_polyline(const Loop& loop, double tolerance);

// Areas covered twice count twice; positive where the polyline runs counter-clockwise.
double signed_area(const std::vector<Vec2d>& closed);

// A crossing of closed polylines with themselves or each other; no value where they only touch.
std::optional<Vec2d> crossing_of(const std::vector<std::vector<Vec2d>>& closed);

// Even-odd test against a closed polyline.
bool encloses(const std::vector<Vec2d>& closed, Vec2d point);

// The loop in order, each curve starting where the one before ends, and its end where it starts.
// Curves that run against the others are reversed; gaps up to `allowed_gap` are closed.
//
// Errors: a curve of no length, a gap. `place` starts the message.
Loop chained(Loop loop, double allowed_gap, const std::string& place);

Loop reversed(const Loop& loop);

// chained(), then turned counter-clockwise.
//
// Errors: as chained(); also a loop that encloses nothing or crosses itself.
Loop closed_loop(const Loop& loop, const std::string& place, double allowed_gap = 1e-3);

// True where no point of `inner` lies inside `outer` (both closed polylines).
bool lies_outside(const std::vector<Vec2d>& inner, const std::vector<Vec2d>& outer);

}  // namespace cusp::job
