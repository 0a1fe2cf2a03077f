// Tabs are read off the path that leaves them: a rise to their height, a level stretch, a fall.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "host_tools/cam/plan/stages.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

#include "fmt/format.h"

namespace cusp::plan {

using job::Job;
using job::Operation;
using toolpath::PlannedOperation;
using toolpath::Tool;
using toolpath::ToolMove;

namespace {

constexpr double kChord = 0.01;  // mm
constexpr double kLow = 0.01;    // mm: a cut less deep leaves the tab

struct Tab {
    const PlannedOperation* by;
    double top;
    std::vector<Vec2d> places;  // where the path goes over its width
};

struct CutTab {
    const Tab* tab;
    Vec3d at;
};

// The middle of a polyline, as long as `width`, in steps.
std::vector<Vec2d> middle_of(const std::vector<Vec2d>& line, double width)
{
    constexpr int kSteps = 8;
    std::vector<double> ends{0};
    for (std::size_t k = 1; k < line.size(); ++k) {
        ends.push_back(ends.back() + norm(line[k] - line[k - 1]));
    }
    std::vector<Vec2d> places;
    for (int step = 0; step <= kSteps; ++step) {
        const double at = ends.back() / 2 + width * (static_cast<double>(step) / kSteps - 0.5);
        const auto above = std::upper_bound(ends.begin(), ends.end(), at);
        const auto next = static_cast<std::size_t>(above - ends.begin());
        if (above == ends.begin() || above == ends.end()) {
            continue;
        }
        const double share = (at - ends[next - 1]) / (ends[next] - ends[next - 1]);
        places.push_back(line[next - 1] + share * (line[next] - line[next - 1]));
    }
    return places;
}

void add_tabs(const Operation& operation, const PlannedOperation& planned, std::vector<Tab>& tabs)
{
    const job::Prismatic& cut = *operation.prismatic;
    const double top = cut.top - cut.depth + cut.tabs->height;
    const auto is_on_top = [&](double z) {
        return std::abs(z - top) < kLow / 2;
    };
    std::vector<Vec2d> line;  // over a tab; empty beside
    Vec3d at{0, 0, kUnbounded};
    for (const ToolMove& move : planned.path.moves) {
        const Vec3d end = end_of(move);
        if (!line.empty() && is_on_top(end.z)) {
            for (const Vec3d p : points_of(move, at, kChord)) {
                line.push_back(in_plan(p));
            }
        } else if (!line.empty()) {
            tabs.push_back({&planned, top, middle_of(line, cut.tabs->width)});
            line.clear();
        } else if (is_on_top(end.z) && at.z < top - kLow) {
            line.push_back(in_plan(end));
        }
        at = end;
    }
}

// The place of the tab that a straight move cuts away, as deep as its lower end goes.
std::optional<Vec3d> cut_of(const Tab& tab, const Tool& tool, Vec3d from, Vec3d to)
{
    const double low = std::min(from.z, to.z);
    if (low >= tab.top - kLow) {
        return std::nullopt;
    }
    for (const Vec2d p : tab.places) {
        const double away = distance_to_segment(p, in_plan(from), in_plan(to));
        if (away < tool.radius - kLow && low + profile_height(tool, away) < tab.top - kLow) {
            return Vec3d{p.x, p.y, low + profile_height(tool, away)};
        }
    }
    return std::nullopt;
}

// The first tab of another operation that the path cuts.
std::optional<CutTab> first_cut(const PlannedOperation& planned, const std::vector<Tab>& tabs)
{
    constexpr double kPiece = 0.5;  // mm: of a move that rises or falls
    const Tool& tool = planned.path.tool;
    std::optional<Vec3d> at;
    for (const ToolMove& move : planned.path.moves) {
        const std::vector<Vec3d> points =
            at ? points_of(move, *at, kChord) : std::vector<Vec3d>{end_of(move)};
        for (const Vec3d to : points) {
            const Vec3d from = at.value_or(to);
            const double length = norm(to - from);
            const int pieces = from.z == to.z ? 1 : 1 + static_cast<int>(length / kPiece);
            for (const Tab& tab : tabs) {
                const bool is_near = !tab.places.empty() &&
                                     tab.by->operation != planned.operation &&
                                     distance_to_segment(tab.places[tab.places.size() / 2],
                                                         in_plan(from), in_plan(to)) <
                                         tool.radius + norm(tab.places.front() - tab.places.back());
                for (int k = 0; is_near && k < pieces; ++k) {
                    const auto place = [&](int n) {
                        return from + static_cast<double>(n) / pieces * (to - from);
                    };
                    if (const auto cut = cut_of(tab, tool, place(k), place(k + 1))) {
                        return CutTab{&tab, *cut};
                    }
                }
            }
            at = to;
        }
    }
    return std::nullopt;
}

}  // namespace

void warn_of_cut_tabs(Planning& planning)
{
    PlannedProgram& program = planning.program;
    std::vector<Tab> tabs;
    for (const PlannedOperation& planned : program.operations) {
        const Operation& operation = operation_of(planning.job, planned);
        if (operation.prismatic && operation.prismatic->tabs) {
            add_tabs(operation, planned, tabs);
        }
    }
    if (tabs.empty()) {
        return;
    }
    for (const PlannedOperation& planned : program.operations) {
        if (const auto cut = first_cut(planned, tabs)) {
            const PlannedOperation& other = *cut->tab->by;
            program.warnings.push_back(
                fmt::format("{}: cuts a tab of {}, at x {:.3f} y {:.3f}: its top is at z {:.4g} "
                            "mm, the cut at {:.4g}",
                            words_of(planned), words_of(other), cut->at.x, cut->at.y, cut->tab->top,
                            cut->at.z));
        }
    }
}

}  // namespace cusp::plan
