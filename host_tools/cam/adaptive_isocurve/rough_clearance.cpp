// Threads take 64 moves each.
#include "host_tools/cam/adaptive_isocurve/rough_clearance.hpp"

#include <algorithm>

#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

namespace cusp::adaptive_isocurve {

using toolpath::LineTo;
using toolpath::Tool;
using toolpath::ToolMove;

namespace {

constexpr std::size_t kMovesAtOnce = 64;   // proved by one thread
constexpr std::size_t kProofsAtOnce = 64;  // of these, before cells of the model are forgotten

// mm: the least clearance of the moves [first, last).
double least_of(const RoughWork& work,
                const Tool& tool,
                const std::vector<ToolMove>& moves,
                std::size_t first,
                std::size_t last)
{
    double least = kInfinite;
    for (std::size_t k = std::max<std::size_t>(1, first); k < last; ++k) {
        const ToolMove& move = moves[k];
        const Vec3d at = end_of(moves[k - 1]);
        if (std::min(at.z, end_of(move).z) >=
            work.model.box_high().z + work.operation.passes.allowance) {
            continue;
        }
        const double sufficient = std::min(least, work.operation.passes.allowance + 1.0);
        const double bow = std::holds_alternative<LineTo>(move.shape) ? 0 : kRoughChord;
        Vec3d from = at;
        for (const Vec3d& to : points_of(move, at, kRoughChord)) {
            least = std::min(least, work.model.move_clearance(tool, from, to, sufficient + bow,
                                                              kClearanceResolution) -
                                        bow);
            from = to;
        }
    }
    return least;
}

}  // namespace

double least_clearance(const RoughWork& work,
                       const Tool& tool,
                       const std::vector<ToolMove>& moves,
                       std::size_t count)
{
    std::vector<double> least((count + kMovesAtOnce - 1) / kMovesAtOnce, kInfinite);
    for (std::size_t begin = 0; begin < least.size(); begin += kProofsAtOnce) {
        const part_model::PartModel::SharedQueries shared{work.model};
        parallel::for_each(std::min(kProofsAtOnce, least.size() - begin), [&](std::size_t k) {
            const part_model::PartModel::SharedQueries::Part queries{work.model};
            const std::size_t first = (begin + k) * kMovesAtOnce;
            least[begin + k] =
                least_of(work, tool, moves, first, std::min(count, first + kMovesAtOnce));
        });
    }
    return least.empty() ? kInfinite : *std::min_element(least.begin(), least.end());
}

}  // namespace cusp::adaptive_isocurve
