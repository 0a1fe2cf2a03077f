// Loops of curves: their polylines, and the normal form: closed, simple, counter-clockwise.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::job {

// Chords of the curves of a loop in plan, each within `tolerance` mm of its curve. The last point
// equals the first.
std::vector<Vec2d> loop_polyline(const Loop& loop, double tolerance);

// mm^2; positive where the polyline runs counter-clockwise. Areas enclosed twice count twice.
double signed_area(const std::vector<Vec2d>& closed);

// A crossing of closed polylines with themselves or each other; no value where they only touch.
//
// touching  mm: an end of a segment that is no farther from the line of another one touches it
std::optional<Vec2d> crossing_of(const std::vector<std::vector<Vec2d>>& closed,
                                 double touching = 0);

// Even-odd test against a closed polyline.
bool encloses(const std::vector<Vec2d>& closed, Vec2d point);

// The loop with each curve starting at the end of the previous one, and closed. Reverses curves of
// the opposite direction and closes gaps up to `allowed_gap`.
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
