// Rest machining: how near to the places of one cutter another one, at the same height, cuts
// nothing.
#pragma once

#include <optional>

#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::clearing {

// How far outside the places of the axis of `before` (negative: how deep among them) the axis of
// `after` may be, at the same height, and meet no stock more than `scallop_height` (mm, >= 0) above
// its own lower side. Holds for all pairs of cutters, whichever is the larger. Returns no value
// where it meets more everywhere, as a flat end does under a ball.
std::optional<double> rest_offset_between_tools(const toolpath::Tool& before,
                                                const toolpath::Tool& after,
                                                double scallop_height);

// True where `after` meets nothing more than that in any of the places where it fits itself.
bool leaves_no_rest(const toolpath::Tool& before,
                    const toolpath::Tool& after,
                    double scallop_height);

}  // namespace cusp::clearing
