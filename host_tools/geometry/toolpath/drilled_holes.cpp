// Each place where the tool goes down.
#include "host_tools/geometry/toolpath/drilled_holes.hpp"

#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

namespace cusp::toolpath {

std::vector<DrilledHole> drilled_holes(const Toolpath& path)
{
    std::vector<DrilledHole> holes;
    Vec3d at{};
    for (const ToolMove& move : path.moves) {
        const Vec3d end = end_of(move);
        if (move.kind != MoveKind::kRapid) {
            const bool deeper =
                !holes.empty() && holes.back().bottom.x == end.x && holes.back().bottom.y == end.y;
            if (deeper) {
                holes.back().bottom = end;
            } else {
                holes.push_back({end, at.z, feed_of(path, move, at)});
            }
        }
        at = end;
    }
    return holes;
}

}  // namespace cusp::toolpath
