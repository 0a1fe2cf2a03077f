// A vee that begins below standing stock is wider in it than on the edge that it is to cut.
#include <algorithm>
#include <utility>
#include <variant>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/plan/stages.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/path_rapids.hpp"

#include "fmt/format.h"

namespace cusp::plan {

using job::Job;
using job::Operation;
using toolpath::ArcTo;
using toolpath::LineTo;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::ToolMove;
using toolpath::Toolpath;
using verify::RapidInStock;

namespace {

constexpr double kSliver = 0.02;  // mm: what an operation before may leave above the level

bool cuts_by_flanks(const Operation& operation)
{
    return operation.cuts(job::Region::kEdges) || operation.cuts(job::Region::kValleys);
}

// The path with the tip at the operation's top at least, in rapid moves: they meet what stands above it.
Toolpath raised(const Toolpath& path, double level)
{
    Toolpath out = path;
    for (ToolMove& move : out.moves) {
        if (auto* const line = std::get_if<LineTo>(&move.shape)) {
            line->end.z = std::max(line->end.z, level);
        } else if (auto* const arc = std::get_if<ArcTo>(&move.shape)) {
            arc->end.z = std::max(arc->end.z, level);
        } else {
            for (Vec3d& point : std::get<toolpath::NurbsTo>(move.shape).curve.points) {
                point.z = std::max(point.z, level);
            }
        }
        move.kind = MoveKind::kRapid;
    }
    return out;
}

}  // namespace

void prove_edges(Planning& planning)
{
    const Job& job = planning.job;
    const std::vector<PlannedOperation>& operations = planning.program.operations;
    for (std::size_t k = 0; k < operations.size(); ++k) {
        const Operation& operation = operation_of(job, operations[k]);
        if (!cuts_by_flanks(operation) || operation.prismatic->top + kSliver >= job.stock_top) {
            continue;
        }
        planning.begin("checking edges");
        std::vector<const Toolpath*> paths = paths_of(planning.program);
        const Toolpath edge = raised(operations[k].path, operation.prismatic->top + kSliver);
        paths.resize(k);
        paths.push_back(&edge);
        const std::vector<RapidInStock> met = verify::rapids_in_stock(job, paths);
        const auto deepest = std::max_element(
            met.begin(), met.end(), [&](const RapidInStock& a, const RapidInStock& b) {
                return std::pair(a.path == k, a.depth) < std::pair(b.path == k, b.depth);
            });
        if (deepest != met.end() && deepest->path == k) {
            throw InputError(
                fmt::format("{}: operation {}, {}: begins at z {:.4g} mm, {:.4g} mm below stock "
                            "that stands by then at x {:.3f} y "
                            "{:.3f}: tool {} is wider there than the edge that it is to cut. Let "
                            "an operation before it cut that "
                            "stock away, or raise top",
                            job.file, operation.number, operation.name(), operation.prismatic->top,
                            deepest->depth, deepest->tip.x, deepest->tip.y, operation.tool.number));
        }
    }
}

}  // namespace cusp::plan
