// How near to the places of one cutter another may stand on the same level without meeting metal.
#pragma once

#include <optional>

#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::clearing {

// How far outside the places where the axis of `before` may stand (negative: how deep among them)
// that of `after` may stand on the same level and meet nothing that stands more than
// `scallop_height` (mm, >= 0) over its own underside. Holds for all pairs of cutters, whichever is
// the larger. Returns no value where it meets more everywhere, as a flat end does under a ball.
std::optional<double> rest_offset_between_tools(const toolpath::Tool& before,
                                                const toolpath::Tool& after,
                                                double scallop_height);

// True where `after` meets nothing more than that in any of the places where it fits itself.
bool leaves_no_rest(const toolpath::Tool& before,
                    const toolpath::Tool& after,
                    double scallop_height);

}  // namespace cusp::clearing
