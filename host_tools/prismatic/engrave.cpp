// Chains in the order of a short tour; open ones start at the nearer end.
#include <algorithm>
#include <cmath>

#include "host_tools/input_error/counted.hpp"
#include "host_tools/input_error/input_error.hpp"
#include "host_tools/offset/contour_fit.hpp"
#include "host_tools/prismatic/contour_run.hpp"
#include "host_tools/prismatic/cut_levels.hpp"
#include "host_tools/prismatic/engrave_floor.hpp"
#include "host_tools/prismatic/prismatic.hpp"
#include "host_tools/prismatic/profile_contours.hpp"

#include "fmt/format.h"

namespace cusp::prismatic {

using job::Chain;
using job::Job;
using job::Operation;
using job::OutputForm;
using offset::Edge;
using offset::fit_edges;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::ToolpathWriter;

namespace {

std::vector<Edge> edges_along(const Chain& chain)
{
    std::vector<Edge> edges;
    for (const nurbs::Curve& curve : chain) {
        for (const Edge& edge : fit_edges(curve, kFit)) {
            edges.push_back(edge);
        }
    }
    return edges;
}

std::vector<Edge> turned_around(std::vector<Edge> edges)
{
    std::reverse(edges.begin(), edges.end());
    for (Edge& edge : edges) {
        edge = reversed(edge);
    }
    return edges;
}

// Nearest end next.
std::vector<std::vector<Edge>> in_order(std::vector<std::vector<Edge>> chains)
{
    Vec2d at{0, 0};
    for (std::size_t n = 0; n < chains.size(); ++n) {
        std::size_t best = n;
        bool turn = false;
        double least = kUnbounded;
        for (std::size_t k = n; k < chains.size(); ++k) {
            for (const bool from_end : {false, true}) {
                const double d =
                    norm((from_end ? chains[k].back().end : chains[k].front().start) - at);
                if (d < least) {
                    least = d;
                    best = k;
                    turn = from_end;
                }
            }
        }
        std::swap(chains[n], chains[best]);
        if (turn) {
            chains[n] = turned_around(std::move(chains[n]));
        }
        at = chains[n].back().end;
    }
    return chains;
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
    if (!operation.floor.empty()) {
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
    for (const std::vector<Edge>& edges : in_order(std::move(chains))) {
        double above = operation.prismatic->top;
        for (const double z : levels) {
            const Vec2d start = edges.front().start;
            const Vec3d down{start.x, start.y, z};
            // a closed curve continues from where it ended
            if (above == operation.prismatic->top || norm(in_plan(writer.at()) - start) > kFit) {
                writer.approach(start, rapid_end(job, above));
            }
            writer.line(MoveKind::kPlunge, down);
            write_edges(edges, z, z, form, writer);
            above = z;
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
