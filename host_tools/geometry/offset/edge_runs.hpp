// Pieces of contours between their crossings, and how those that are kept become contours again.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::offset {

inline constexpr double kShortestPiece = 1e-8;  // mm: pieces below are dropped
inline constexpr double kSameVertex = 1e-6;     // mm: run ends that meet

// The pieces between two crossings: all are kept or none. A run with an open end is never kept: raw
// pieces are disconnected only at inner corners and where an arc has vanished, and these ends are
// nearer to the next edge than the distance.
struct Run {
    std::vector<Edge> edges;
    std::vector<std::uint32_t> origins;  // of its pieces
    bool closed{};
    bool open_end{};
};

// Place of a point along the edge: 0 at the start, 1 at the end, in between in order.
double share_of_chord(const Edge& edge, Vec2d point);

// Joins runs at common ends. If several start at a vertex, the sharpest left turn separates parts
// that only touch. None where an end has no partner.
std::optional<Region2d> joined(std::vector<Run>& runs);

}  // namespace cusp::offset
