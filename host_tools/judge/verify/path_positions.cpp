// The first move of a path starts over the stock.
#include "host_tools/judge/verify/path_positions.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

namespace cusp::verify {

using job::Job;
using job::Operation;
using toolpath::end_of;
using toolpath::MoveKind;
using toolpath::points_of;
using toolpath::ToolMove;
using toolpath::Toolpath;

ToolPositions positions_on(const Toolpath& path, double spacing)
{
    ToolPositions out{path.tool, {}, {}, {}};
    for (std::size_t k = 0; k < path.moves.size(); ++k) {
        const ToolMove& move = path.moves[k];
        if (k == 0) {  // where it comes from is over the stock
            out.tips.push_back(end_of(move));
        } else {
            Vec3d at = out.tips.back();
            for (const Vec3d p : points_of(move, at, kPathChord)) {
                const int steps = std::max(1, static_cast<int>(std::ceil(norm(p - at) / spacing)));
                for (int i = 1; i <= steps; ++i) {
                    out.tips.push_back(
                        i == steps ? p : at + (static_cast<double>(i) / steps) * (p - at));
                }
                at = p;
            }
        }
        out.rapid.resize(out.tips.size(), move.kind == MoveKind::kRapid);
        out.lines.resize(out.tips.size(), static_cast<std::uint32_t>(k));
    }
    return out;
}

PartBox floors_box(const Job& job)
{
    PartBox box = part_box({});
    for (const Operation& operation : job.operations) {
        const PartBox one = operation.prismatic
                                ? part_box({})
                                : part_box(operation.part.floor, operation.part.mesh);
        box = {std::min(box.x_low, one.x_low), std::max(box.x_high, one.x_high),
               std::min(box.y_low, one.y_low), std::max(box.y_high, one.y_high),
               std::min(box.z_low, one.z_low), std::max(box.z_high, one.z_high)};
    }
    return box;
}

}  // namespace cusp::verify
