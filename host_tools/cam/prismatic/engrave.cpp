// Chains in the order of a short tour; open ones start at the nearer end.
#include <algorithm>
#include <cmath>

#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/prismatic/contour_run.hpp"
#include "host_tools/cam/prismatic/cut_levels.hpp"
#include "host_tools/cam/prismatic/engrave_floor.hpp"
#include "host_tools/cam/prismatic/line_paths.hpp"
#include "host_tools/cam/prismatic/prismatic.hpp"
#include "host_tools/geometry/toolpath/short_tour.hpp"

#include "fmt/format.h"

namespace cusp::prismatic {

using job::Chain;
using job::Job;
using job::Operation;
using job::OutputForm;
using offset::Edge;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::short_tour;
using toolpath::ToolpathWriter;
using toolpath::TourStep;
using toolpath::TourStop;

namespace {

std::vector<std::vector<Edge>> in_order(std::vector<std::vector<Edge>> chains)
{
    std::vector<TourStop> stops;
    for (const std::vector<Edge>& chain : chains) {
        stops.push_back({chain.front().start, chain.back().end});
    }
    std::vector<std::vector<Edge>> ordered;
    for (const TourStep& step : short_tour(stops, {0, 0})) {
        std::vector<Edge>& chain = chains[step.stop];
        ordered.push_back(step.turned ? turned_around(std::move(chain)) : std::move(chain));
    }
    return ordered;
}

}  // namespace

std::vector<PlannedOperation> plan_engrave(const Job& job, const Operation& operation)
{
    std::vector<std::vector<Edge>> chains;
    for (const Chain& chain : operation.prismatic->chains) {
        chains.push_back(edges_along(chain));
    }
    chains.erase(std::remove_if(chains.begin(), chains.end(),
                                [](const std::vector<Edge>& edges) { return edges.empty(); }),
                 chains.end());
    if (chains.empty()) {
        throw InputError(operation_text(job, operation) + operation.prismatic->file +
                         ": no curve to engrave");
    }
    if (!operation.part.floor.empty()) {
        return engraved_on_floor(job, operation, in_order(std::move(chains)));
    }
    const std::vector<double> levels = cut_levels(job, operation, operation.prismatic->depth);
    PlannedOperation planned =
        begun(job, operation,
              fmt::format("{}, {:g} mm deep", counted(chains.size(), "curve"),
                          operation.prismatic->depth));
    ToolpathWriter writer{planned.path.moves, {job.stock_top + job.clearance}};
    const EdgeForm form{operation.output != OutputForm::kLines, chord_tolerance(operation), true,
                        true};
    for (std::vector<Edge>& edges : in_order(std::move(chains))) {
        writer.approach(edges.front().start, rapid_end(job, operation.prismatic->top));
        const bool closed = is_closed(edges);
        for (const double z : levels) {
            // the next level begins where this one ends: an open curve goes back and forth
            const Vec2d start = edges.front().start;
            writer.line(MoveKind::kPlunge, {start.x, start.y, z});
            write_edges(edges, z, z, form, writer);
            edges = closed ? std::move(edges) : turned_around(std::move(edges));
        }
    }
    writer.retract();
    const auto passes = operation.prismatic->chains.size() * levels.size();
    count_moves(writer, static_cast<int>(passes), static_cast<int>(levels.size()), planned);
    planned.stats.counts.emplace_back("curves",
                                      static_cast<double>(operation.prismatic->chains.size()));
    return {planned};
}

}  // namespace cusp::prismatic
