// A sentence for each bound that does not hold: quantity, value, tool, place and line, limit.
#include "host_tools/judge/verify/verdict.hpp"

#include <algorithm>

#include "host_tools/geometry/toolpath/gcode_text.hpp"
#include "host_tools/judge/verify/tool_comment.hpp"

#include "fmt/format.h"

namespace cusp::verify {

using job::Job;

namespace {

std::string words_of(const FaultPlace& at)
{
    const std::string by = at.line > 0 ? fmt::format(" by tool {}", at.tool) : "";
    const std::string line = at.line > 0 ? fmt::format(", line {}", at.line) : "";
    return fmt::format("{} at x {:.3f} y {:.3f} z {:.3f}{}", by, at.place.x, at.place.y, at.place.z,
                       line);
}

// Amid a sentence.
std::string words_between(const std::optional<FaultPlace>& at)
{
    return at ? words_of(*at) + (at->line > 0 ? "," : "") : "";
}

// The move that cuts lowest over a place; the first of those alike.
// z of the place is that of the cut.
FaultPlace cut_at(const std::vector<ToolPositions>& runs, Vec3d place)
{
    FaultPlace at{place, 0, 0};
    double lowest = kUnbounded;
    constexpr double kAlike = 1e-6;    // mm
    constexpr double kBetween = 0.01;  // mm: positions' sweeps are wider than they
    for (const ToolPositions& run : runs) {
        for (std::size_t k = 0; k < run.tips.size(); ++k) {
            const double away = norm(in_plan(run.tips[k]) - in_plan(place));
            if (away > run.tool.radius + kBetween || run.tips[k].z >= lowest) {
                continue;
            }
            const double z =
                run.tips[k].z + profile_height(run.tool, std::min(away, run.tool.radius));
            if (z < lowest - kAlike) {
                lowest = z;
                at.place.z = z;
                at.line = run.lines[k];
                at.tool = run.tool.number;
            }
        }
    }
    return at;
}

void judge_contacts(Verification& result)
{
    for (const ContactFigures& f : result.figures.contacts) {
        if (f.depth > 0) {
            result.broken.push_back(fmt::format(
                "{} {:.4g} by tool {} at x {:.3f} y {:.3f} z {:.3f}, line {}: {} of {:.2f} mm "
                "would do",
                name_of_figure(f.part), f.depth, f.tool, f.tip.x, f.tip.y, f.tip.z, f.line,
                f.part == BodyPart::kHolder ? "a length" : "flutes", f.long_enough));
        }
    }
}

// A tool of the program that is not the job's: one of the two is not in the spindle.
void judge_tools(const Job& job, Verification& result)
{
    for (const ToolFigures& f : result.figures.tools) {
        const auto described = result.program.tools.find(f.tool.number);
        if (described != result.program.tools.end() &&
            !is_same_cutter(described->second.tool, f.tool)) {
            result.broken.push_back(
                fmt::format("{} by its comment in line {}, {} by {}: first cut{}",
                            tool_sizes(described->second.tool, 1, "mm"), described->second.line,
                            tool_sizes(f.tool, 1, "mm"), job.file, words_of(f.first_cut)));
        }
    }
}

}  // namespace

void judge(const Job& job, std::optional<double> scallop, Verification& result)
{
    const VerifyFigures& f = result.figures;
    const VerifyBounds& bounds = result.bounds;
    const auto bound = [&](const char* name, std::optional<double> value, double limit,
                           const std::optional<FaultPlace>& at = std::nullopt) {
        if (value && !(*value <= limit)) {
            result.broken.push_back(
                fmt::format("{} {:.4g}{} is over {:.4g}", name, *value, words_between(at), limit));
        }
    };
    bound("gouge_max_mm", f.gouge_max, bounds.floor_tolerance + kJudgement, f.gouge_at);
    bound("ball_gouge_max_mm", f.ball_gouge_max, bounds.floor_tolerance + kJudgement,
          f.ball_gouge_at);
    bound("wall_gouge_max_mm", f.wall_gouge_max, bounds.plan_tolerance + kJudgement,
          f.wall_gouge_at);
    bound("rapid_cut_max_mm", f.rapid_cut_max, bounds.rapid_cut, f.rapid_cut_at);
    // planned to the margin, so rounding and the height of rapid moves touch it
    constexpr double kFixtureAllowed = 0.005;
    if (f.fixture_hit_max && !(*f.fixture_hit_max <= kFixtureAllowed)) {
        result.broken.push_back(fmt::format("fixture_hit_max_mm {:.4g}, {}, is over {:.4g}",
                                            *f.fixture_hit_max, f.fixture_hit_at, kFixtureAllowed));
    }
    judge_contacts(result);
    judge_tools(job, result);
    if (f.between_sides && is_too_thin(job, *f.between_sides)) {
        result.broken.push_back(sentence_of(job, *f.between_sides));
    }
    if (f.level_left) {
        result.broken.push_back(
            fmt::format("left {:.4g} mm over the level of operation {} ({}) at x {:.3f} y {:.3f}",
                        f.level_left->height, f.level_left->operation, f.level_left->strategy,
                        f.level_left->place.x, f.level_left->place.y));
    }
    if (f.wall_stock) {
        bound("wall_stock_max_mm", f.wall_stock->thickness, bounds.plan_tolerance + kJudgement,
              f.wall_stock->at);
    }
    if (f.tabs_standing != f.tabs_wanted) {
        const std::string lost =
            f.lost_tab
                ? fmt::format(": one of operation {} ({}) is cut away{}", f.lost_tab->operation,
                              f.lost_tab->strategy, words_of(f.lost_tab->at))
                : "";
        result.broken.push_back(
            fmt::format("tabs: {} found, {} expected{}", f.tabs_standing, f.tabs_wanted, lost));
    }
    if (scallop) {
        bound("uncovered_share", f.uncovered_share, bounds.uncovered_share, f.uncovered_at);
        if (f.thickest_left) {
            const auto [thickness, at] = *f.thickest_left;
            result.broken.push_back(
                fmt::format("left_thickness_mm {:.4g} at x {:.3f} y {:.3f} z {:.3f} is over {:.4g} "
                            "(scallop and "
                            "floor_tolerance)",
                            thickness, at.x, at.y, at.z, *scallop + bounds.floor_tolerance));
        }
    }
}

void find_fault_places(const std::vector<ToolPositions>& runs, Verification& result)
{
    VerifyFigures& f = result.figures;
    const auto deepest = std::max_element(result.gouge.begin(), result.gouge.end());
    if (f.gouge_max > result.bounds.floor_tolerance + kJudgement && deepest != result.gouge.end()) {
        const auto k = static_cast<std::size_t>(deepest - result.gouge.begin());
        const HeightGrid& grid = result.grid;
        f.gouge_at = cut_at(runs, {grid.x(k / grid.ny, k % grid.ny),
                                   grid.y(k / grid.ny, k % grid.ny), result.part[k] - *deepest});
    }
    if (f.wall_gouge_at && f.wall_gouge_at->line == 0) {
        f.wall_gouge_at = cut_at(runs, f.wall_gouge_at->place);
    }
    if (f.lost_tab) {
        f.lost_tab->at = cut_at(runs, f.lost_tab->at.place);
    }
}

}  // namespace cusp::verify
