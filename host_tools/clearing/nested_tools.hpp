// How near to the places of one cutter another may stand on the same level without meeting metal.
#pragma once

#include <optional>

#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::host {

// How far outside the places where the axis of `before` may stand (negative: how deep among them)
// that of `after` may stand on the same level and meet nothing that stands more than `ridge` (mm,
// >= 0) over its own underside. Holds for all pairs of cutters, whichever is the larger.
// Returns no value where it meets more everywhere, as a flat end does under a ball.
std::optional<double> nested_reach(const Tool& before, const Tool& after, double ridge);

// True where `after` meets nothing more than that in any of the places where it fits itself.
bool leaves_nothing_for(const Tool& before, const Tool& after, double ridge);

}  // namespace cusp::host
