// The order of the paths: tools first, then short ways.
#include <algorithm>
#include <numeric>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/plan/stages.hpp"
#include "host_tools/geometry/toolpath/short_tour.hpp"
#include "host_tools/geometry/toolpath/tool_order.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::plan {

using job::Job;
using toolpath::end_of;
using toolpath::PlannedOperation;
using toolpath::short_tour;

namespace {

// The operations of one table that follow each other with one tool, pockets of a drawing, lie beside each
// other: they get a short tour.
//
// pockets  of each operation the one that it belongs to: roughing and finish of a pocket stay in order
void shorten_ways(const std::vector<PlannedOperation>& operations,
                  const std::vector<std::size_t>& pockets,
                  std::vector<std::size_t>& order)
{
    Vec2d here{0, 0};
    for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
        std::vector<std::vector<std::size_t>> stops;
        std::vector<Vec2d> starts;
        for (end = first; end < order.size(); ++end) {
            const PlannedOperation& a = operations[order[first]];
            const PlannedOperation& b = operations[order[end]];
            if (a.operation != b.operation || a.path.tool.number != b.path.tool.number ||
                b.path.moves.empty()) {
                break;
            }
            if (stops.empty() || pockets[stops.back().back()] != pockets[order[end]]) {
                stops.emplace_back();
                starts.push_back(in_plan(end_of(b.path.moves.front())));
            }
            stops.back().push_back(order[end]);
        }
        std::size_t place = first;
        for (const std::size_t k : short_tour(starts, here)) {
            for (const std::size_t operation : stops[k]) {
                order[place++] = operation;
            }
        }
        end = std::max(end, first + 1);
        if (!operations[order[end - 1]].path.moves.empty()) {
            here = in_plan(end_of(operations[order[end - 1]].path.moves.back()));
        }
    }
}

// All paths but empty ones, whose warnings stay. An operation that found nothing left to cut keeps its figures.
//
// pockets  receives the place of each in job.operations
std::vector<PlannedOperation> paths_to_cut(Planning& planning, std::vector<std::size_t>& pockets)
{
    std::vector<PlannedOperation> paths;
    std::vector<std::string>& warnings = planning.program.warnings;
    for (Planned& planned : planning.planned) {
        for (PlannedOperation& path : planned.paths) {
            if (path.path.moves.empty() && !path.stats.rest) {
                warnings.insert(warnings.end(), path.stats.warnings.begin(),
                                path.stats.warnings.end());
                continue;
            }
            paths.push_back(std::move(path));
            pockets.push_back(planned.place);
        }
    }
    planning.planned.clear();
    return paths;
}

}  // namespace

void put_in_order(Planning& planning)
{
    const Job& job = planning.job;
    PlannedProgram& program = planning.program;
    std::vector<std::size_t> pockets;
    std::vector<PlannedOperation> paths = paths_to_cut(planning, pockets);
    if (paths.empty()) {
        throw InputError(fmt::format("{}: there is nothing to cut: {}", job.file,
                                     fmt::join(program.warnings, "; ")));
    }
    std::vector<std::size_t> order(paths.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (job.group_by_tool) {
        order = tool_order(paths, job.stock_top + job.clearance);
    }
    shorten_ways(paths, pockets, order);
    for (const std::size_t place : order) {
        program.operations.push_back(std::move(paths[place]));
    }
}

void measure_paths(Planning& planning)
{
    PlannedProgram& program = planning.program;
    program.measures.clear();
    // the position of the tool is unknown before the first rapid move
    Vec3d at{0, 0, planning.job.stock_top + planning.job.clearance};
    for (const PlannedOperation& operation : program.operations) {
        program.measures.push_back(measure(operation.path, at, planning.rates));
        at = program.measures.back().end;
    }
}

}  // namespace cusp::plan
