// Paths of tools that can touch nothing are cut too, but those after the last that can are not.
#include "host_tools/judge/verify/path_contact.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "host_tools/judge/verify/earlier_programs.hpp"
#include "host_tools/judge/verify/path_positions.hpp"
#include "host_tools/judge/verify/stock_grid.hpp"
#include "host_tools/judge/verify/uncut_stock.hpp"

namespace cusp::verify {

using job::Job;
using toolpath::end_of;
using toolpath::MoveKind;
using toolpath::points_of;
using toolpath::ToolMove;
using toolpath::Toolpath;

namespace {

double lowest_tip(const Toolpath& path)
{
    double low = kUnbounded;
    Vec3d at;
    for (const ToolMove& move : path.moves) {
        if (std::holds_alternative<toolpath::LineTo>(move.shape)) {
            low = std::min(low, end_of(move).z);
        } else {
            for (const Vec3d p : points_of(move, at, kPathChord)) {
                low = std::min(low, p.z - kPathChord);
            }
        }
        at = end_of(move);
    }
    return low;
}

bool may_touch(const Job& job, const Toolpath& path)
{
    const std::vector<ToolDisc> discs = tool_discs(job, path.tool);
    const double low = discs.empty() ? kUnbounded : lowest_tip(path);
    return std::any_of(discs.begin(), discs.end(),
                       [&](const ToolDisc& disc) { return low + disc.above < job.stock_top; });
}

// The deepest of each part: a holder has several discs.
void add_worst(const Job& job,
               const Toolpath& path,
               std::size_t place,
               const ToolPositions& positions,
               const std::vector<BodyContact>& found,
               std::vector<PathContact>& out)
{
    for (const BodyPart part : {BodyPart::kBeyondFlutes, BodyPart::kShank, BodyPart::kHolder}) {
        BodyContact worst{part, 0, 0};
        for (const BodyContact& contact : found) {
            if (contact.part == part && contact.depth > worst.depth) {
                worst = contact;
            }
        }
        if (worst.depth > 0) {
            out.push_back({part, worst.depth, place, positions.tips[worst.position],
                           path.moves[positions.lines[worst.position]].kind,
                           long_enough(job, path.tool, worst)});
        }
    }
}

}  // namespace

std::vector<PathContact> path_contacts(const Job& job,
                                       const std::vector<const Toolpath*>& paths,
                                       const Progress& progress)
{
    std::vector<bool> checked;
    std::transform(paths.begin(), paths.end(), std::back_inserter(checked),
                   [&](const Toolpath* path) { return may_touch(job, *path); });
    std::size_t count = paths.size();
    while (count > 0 && !checked[count - 1]) {
        --count;
    }
    std::vector<PathContact> out;
    if (count == 0) {
        return out;
    }
    const double spacing = position_spacing(job);
    const HeightGrid grid = stock_grid(job, floors_box(job), std::nullopt);
    const StockExtent around = stock_around(job, grid);
    MachinedStock stock = UncutStock{job}.on(grid);
    cut_earlier_programs(job, spacing, stock);
    for (std::size_t k = 0; k < count; ++k) {
        const ToolPositions positions = positions_on(*paths[k], spacing);
        ContactTrace contact{grid, positions, tool_discs(job, paths[k]->tool), around};
        stock.cut(
            positions, spacing,
            [&](double share) {
                progress((static_cast<double>(k) + share) / static_cast<double>(count));
            },
            nullptr, checked[k] ? &contact : nullptr);
        add_worst(job, *paths[k], k, positions, contact.finish(), out);
    }
    return out;
}

}  // namespace cusp::verify
