// Rest machining: how near to the places of one cutter another one, at equal height, cuts nothing.
#pragma once

#include <optional>

#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::clearing {

// Returns the distance by which the axis of `after` may lie outside the places of the axis of
// `before` (negative: inside them), at equal height, without meeting stock more than
// `scallop_height` (mm, >= 0) above its own lower side. Holds for all pairs of cutters, whichever
// is larger. None if it meets more everywhere, as a flat end does below a ball.
std::optional<double> rest_offset_between_tools(const toolpath::Tool& before,
                                                const toolpath::Tool& after,
                                                double scallop_height);

// True if `after` meets no more than that anywhere it fits itself.
bool leaves_no_rest(const toolpath::Tool& before,
                    const toolpath::Tool& after,
                    double scallop_height);

}  // namespace cusp::clearing
