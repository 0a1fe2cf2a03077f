// Each peck goes a step deeper, then rapid moves up and down clear the chips.
#include "host_tools/geometry/toolpath/peck_moves.hpp"

#include <algorithm>

namespace cusp::toolpath {

void write_pecks(const HoleHeights& hole, double peck, ToolpathWriter& writer)
{
    // mm: as the controller's own G83, rapid moves back into the hole end above the last depth.
    constexpr double kPeckClearance = 0.254;
    const Vec3d at = writer.at();
    for (double z = hole.top; z > hole.bottom;) {
        // a last peck thinner than a thousandth of the others is none
        z = z - peck - peck / 1000 > hole.bottom ? z - peck : hole.bottom;
        writer.line(MoveKind::kPlunge, {at.x, at.y, z});
        if (z > hole.bottom) {
            writer.line(MoveKind::kRapid, {at.x, at.y, hole.above});
            writer.line(MoveKind::kRapid, {at.x, at.y, std::min(z + kPeckClearance, hole.above)});
        }
    }
}

}  // namespace cusp::toolpath
