// Offset the material, choose a start with room for the leads, and go around level by level.
#include <algorithm>
#include <cmath>
#include <optional>

#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/prismatic/common_edges.hpp"
#include "host_tools/cam/prismatic/contour_run.hpp"
#include "host_tools/cam/prismatic/cut_levels.hpp"
#include "host_tools/cam/prismatic/line_paths.hpp"
#include "host_tools/cam/prismatic/prismatic.hpp"
#include "host_tools/cam/prismatic/profile_contours.hpp"
#include "host_tools/cam/prismatic/profile_leads.hpp"
#include "host_tools/cam/prismatic/tab_places.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/geometry/toolpath/short_tour.hpp"

#include "fmt/format.h"

namespace cusp::prismatic {

using job::CutDirection;
using job::EntryKind;
using job::Job;
using job::Operation;
using job::OutputForm;
using job::Prismatic;
using job::ProfileSide;
using job::Tabs;
using offset::Contour;
using offset::distance;
using offset::Edge;
using offset::edges_of;
using offset::EdgeTree;
using offset::Region2d;
using offset::RegionOffset;
using toolpath::EntryRun;
using toolpath::inner_first_tour;
using toolpath::PlannedOperation;
using toolpath::ToolpathWriter;

namespace {

// Radius of leads over the tool's, where the job gives none.
constexpr double kLeadRadius = 1.0;

// The region in which the tool may be. Parts that touch are one to a tool outside them.
ContourGroup contours_beside(const Prismatic& cut)
{
    ContourGroup drawn{material_of(cut), {}, 0, {}};
    if (cut.side == ProfileSide::kOutside) {
        drawn = without_common_edges(drawn.region);
        drawn.region = opposite(drawn.region);
        return drawn;
    }
    for (std::size_t n = 0; n < drawn.region.contours.size(); ++n) {
        drawn.sources.push_back(n);
    }
    return drawn;
}

class ProfilePlanner {
public:
    ProfilePlanner(const Job& job, const Operation& operation)
        : job_{job},
          operation_{operation},
          cut_{*operation.prismatic},
          drawn_{contours_beside(cut_)},
          waste_{drawn_.region},
          walls_{edges_of(waste_)},
          levels_{cut_levels(job, operation, cut_.depth)},
          planned_{begun(job, operation, side_text())},
          writer_{
              planned_.path.moves,
              {job.stock_top + job.clearance,
               operation.passes.entry == EntryKind::kPlunge ? EntryKind::kPlunge : EntryKind::kRamp,
               operation.tool.radius}}
    {
        const bool climb = operation.passes.direction_of_cut == CutDirection::kClimb;
        form_ = {operation.output != OutputForm::kLines, operation.tolerance.plan / 2, climb,
                 cut_.side == ProfileSide::kOn};
    }

    PlannedOperation plan()
    {
        const double radius = on_line() ? 0.0 : operation_.tool.radius;
        const Region2d centres = centres_at(radius);
        check_reach(centres);
        if (operation_.passes.allowance > 0) {
            const double away = radius + operation_.passes.allowance;
            const Region2d rough = centres_at(away);
            share_tabs(centres, radius);
            cut_around(rough, away, {});
            cut_around(centres, radius, edges_of(rough));
        } else {
            cut_around(centres, radius, {});
        }
        writer_.retract();
        count_moves(writer_, passes_, static_cast<int>(levels_.size()), planned_);
        planned_.stats.gouge_bound_mm = on_line() ? 0.0 : kFit;
        planned_.stats.counts.emplace_back("contours", contours_);
        planned_.stats.counts.emplace_back("tabs", tabs_);
        planned_.stats.counts.emplace_back("leads", leads_);
        return planned_;
    }

private:
    bool on_line() const { return cut_.side == ProfileSide::kOn; }
    double bottom() const { return levels_.back(); }

    std::string side_text() const
    {
        const char* side = on_line()                            ? "on the line"
                           : cut_.side == ProfileSide::kOutside ? "outside"
                                                                : "inside";
        return fmt::format("{}, {}{}", side, counted(levels_.size(), "level"),
                           cut_.tabs ? fmt::format(", tabs {:g} mm wide", cut_.tabs->width) : "");
    }

    std::string text() const { return operation_text(job_, operation_); }

    Region2d centres_at(double away) const
    {
        return away > 0 ? RegionOffset{waste_}.at(away) : waste_;
    }

    void check_reach(const Region2d& centres)
    {
        const double radius = operation_.tool.radius;
        if (on_line()) {
            return;
        }
        if (drawn_.common > 0) {
            planned_.stats.warnings.push_back(
                fmt::format("{}: loops have edges in common, {:.4g} mm of them, such as at x "
                            "{:.6g} y {:.6g} mm: not cut",
                            cut_.file, drawn_.common, drawn_.place.x, drawn_.place.y));
        }
        const Unreached left = unreached(waste_, centres, radius);
        if (centres.contours.empty()) {
            throw InputError(fmt::format(
                "{}{}: tool {} of {:g} mm fits nowhere {}, such as at x {:.6g} y {:.6g} mm", text(),
                cut_.file, operation_.tool.number, 2 * radius,
                cut_.side == ProfileSide::kOutside ? "between the loops" : "inside the loops",
                left.place.x, left.place.y));
        }
        for (const std::size_t n : left.loops) {
            const Vec2d p = waste_.contours[n].front().start;
            planned_.stats.warnings.push_back(fmt::format(
                "{}: tool {} of {:g} mm fits nowhere along the loop at x {:.6g} y "
                "{:.6g} mm: not cut",
                cut_.loops[drawn_.sources[n]].name, operation_.tool.number, 2 * radius, p.x, p.y));
        }
        constexpr double kCorner = 4.0;  // radii: what a corner of 53 degrees leaves
        if (left.longest > kCorner * radius) {
            planned_.stats.warnings.push_back(fmt::format(
                "tool {} of {:g} mm does not reach {:.4g} mm of the loops, the longest stretch is "
                "{:.4g} mm, at x {:.6g} y {:.6g} mm",
                operation_.tool.number, 2 * radius, left.length, left.longest, left.place.x,
                left.place.y));
        }
        planned_.stats.counts.emplace_back("unreached_mm", left.length);
    }

    // rough  where the tool has left the allowance; there only the bottom is left to cut
    void cut_around(const Region2d& centres, double away, const std::vector<Edge>& rough)
    {
        const std::vector<double> bottom{levels_.back()};
        const EdgeTree roughed{rough};
        const auto places = places_by_contour(centres);
        std::vector<LeadContour> led;
        for (std::size_t n = 0; n < centres.contours.size(); ++n) {
            led.push_back(led_contour(centres.contours[n], away, places[n], {}));
        }
        for (const std::size_t n : short_order(centres, away, places, led)) {
            cut_contour(led[n], away, places[n],
                        is_roughed(centres.contours[n], roughed) ? bottom : levels_);
        }
    }

    // The order of the contours. Those of several begin anew where the ways between them are short.
    std::vector<std::size_t> short_order(const Region2d& centres,
                                         double away,
                                         const std::vector<std::vector<Vec2d>>& places,
                                         std::vector<LeadContour>& led) const
    {
        constexpr int kRounds = 2;
        const auto around = contours_around(centres.contours);
        const Vec2d begin = writer_.started() ? in_plan(writer_.at()) : Vec2d{0, 0};
        const auto tour = [&] {
            std::vector<Vec2d> starts;
            for (const LeadContour& one : led) {
                starts.push_back(start_of(one));
            }
            return inner_first_tour(starts, around, begin);
        };
        std::vector<std::size_t> order = tour();
        for (int round = 0; round < kRounds && led.size() > 1; ++round) {
            Vec2d here = begin;
            for (std::size_t k = 0; k < order.size(); ++k) {
                const std::size_t n = order[k];
                const Vec2d next = k + 1 < order.size() ? start_of(led[order[k + 1]]) : here;
                led[n] = led_contour(centres.contours[n], away, places[n], [&](Vec2d p) {
                    return distance(here, p) + distance(p, next);
                });
                here = start_of(led[n]);
            }
            order = tour();
        }
        return order;
    }

    static Vec2d start_of(const LeadContour& led)
    {
        return led.leads.in ? led.leads.in->start : led.run.point(0);
    }

    // True if the pass with the allowance came everywhere along the contour, but for corners.
    bool is_roughed(const Contour& contour, const EdgeTree& roughed) const
    {
        const double radius = operation_.tool.radius;
        const double reach = operation_.passes.allowance + 0.5 * radius;
        const auto near = [&](const Edge& edge) {
            const int pieces = 1 + static_cast<int>(2 * offset::length(edge) / radius);
            for (int i = 0; i < pieces; ++i) {
                if (!roughed.any_nearer(point_on(edge, (i + 0.5) / pieces), reach)) {
                    return false;
                }
            }
            return true;
        };
        return roughed.size() > 0 && std::all_of(contour.begin(), contour.end(), near);
    }

    // Counted tabs get their places from the last pass: that with the allowance leaves them at the same.
    void share_tabs(const Region2d& centres, double away)
    {
        if (!cut_.tabs || cut_.tabs->count == 0) {
            return;
        }
        std::vector<Vec2d> places;
        for (const Contour& contour : centres.contours) {
            const LeadContour led = led_contour(contour, away, {}, {});
            for (const double middle : tab_middles(led.run, {})) {
                places.push_back(led.run.point(middle));
            }
        }
        shared_tabs_ = places;
    }

    // The tabs that the job places on each contour.
    std::vector<std::vector<Vec2d>> places_by_contour(const Region2d& centres) const
    {
        std::vector<std::vector<Vec2d>> out(centres.contours.size());
        if (!cut_.tabs || out.empty()) {
            return out;
        }
        for (const Vec2d place : shared_tabs_ ? *shared_tabs_ : cut_.tabs->places) {
            std::size_t best = 0;
            double nearest = kUnbounded;
            for (std::size_t n = 0; n < out.size(); ++n) {
                const double d = distance_to(Region2d{{centres.contours[n]}}, place);
                best = d < nearest ? n : best;
                nearest = std::min(nearest, d);
            }
            const double most = 2 * operation_.tool.radius + cut_.tabs->width;
            if (nearest > most && shared_tabs_) {
                continue;  // there the pass with the allowance has no room
            }
            if (nearest > most) {
                throw InputError(
                    fmt::format("{}the tab at x {:.6g} y {:.6g} mm is {:.4g} mm from "
                                "the path, at most {:.4g} mm are taken",
                                text(), place.x, place.y, nearest, most));
            }
            out[best].push_back(place);
        }
        return out;
    }

    // Middles of the tabs along a run that begins at the lead-in.
    std::vector<double> tab_middles(const ContourRun& run, const std::vector<Vec2d>& places) const
    {
        std::vector<double> middles;
        for (const Vec2d place : places) {
            middles.push_back(run.nearest_to(place));
        }
        const int count = shared_tabs_ ? 0 : cut_.tabs->count;
        for (int k = 0; k < count; ++k) {
            middles.push_back(run.length() * (k + 0.5) / count);
        }
        std::sort(middles.begin(), middles.end());
        const double half = half_of_tab(*cut_.tabs, operation_.tool.radius);
        double before = middles.empty() ? 0 : middles.back() - run.length();
        for (std::size_t k = 0; k < middles.size(); ++k) {
            const bool first_fits = middles[k] >= half && middles[k] + half <= run.length();
            if (!first_fits || middles[k] - before < 2 * half) {
                const Vec2d p = run.point(middles[k]);
                throw InputError(fmt::format(
                    "{}the tab at x {:.6g} y {:.6g} mm has no room: each takes {:.4g} mm of the "
                    "path of {:.4g} mm (its width, the tool's diameter, its slopes); {} are on "
                    "it",
                    text(), p.x, p.y, 2 * half, run.length(), middles.size()));
            }
            before = middles[k];
        }
        return middles;
    }

    LeadContour led_contour(const Contour& contour,
                            double away,
                            const std::vector<Vec2d>& places,
                            const std::function<double(Vec2d)>& way) const
    {
        const bool left = operation_.passes.direction_of_cut == CutDirection::kClimb;
        const ContourRun whole{left ? contour : reversed(contour)};
        const double radius = operation_.tool.radius;
        // Round a narrow contour the tool comes down along it.
        const bool narrow = toolpath::goes_round(whole.length(), radius);
        const double lead = cut_.lead_in.value_or(on_line() || narrow ? 0.0 : kLeadRadius * radius);
        std::vector<double> kept;
        for (const Vec2d place : places) {
            kept.push_back(whole.nearest_to(place));
        }
        const double free = cut_.tabs ? half_of_tab(*cut_.tabs, radius) : 0.0;
        return with_leads(whole, walls_, kept, free,
                          {lead, cut_.lead_out.value_or(lead), away, left}, way);
    }

    void cut_contour(const LeadContour& led,
                     double away,
                     const std::vector<Vec2d>& places,
                     const std::vector<double>& levels)
    {
        std::vector<TabStretch> tabs;
        if (cut_.tabs) {
            tabs = tab_stretches(*cut_.tabs, tab_middles(led.run, places), operation_.tool.radius);
        }
        double above = cut_.top;
        for (const double z : levels) {
            go_to_start(led, away, above);
            cut_level(led, tabs, above, z);
            above = z;
        }
        ++contours_;
        tabs_ += static_cast<int>(tabs.size());
        leads_ += led.leads.in ? 1 : 0;
    }

    // From the end of one level of a contour to the start of the next the tool stays at the level that it has
    // cut, where it has room for the straight way: between two leads it may cut waste.
    void go_to_start(const LeadContour& led, double away, double above)
    {
        const Vec2d start = start_of(led);
        if (above == cut_.top) {
            writer_.approach(start, rapid_end(job_, above));
            return;
        }
        const Edge way = offset::line_edge(in_plan(writer_.at()), start);
        if (keeps_clear(way, walls_, away)) {
            writer_.line(toolpath::MoveKind::kCut, {start.x, start.y, writer_.at().z});
        } else {
            writer_.approach(start, rapid_end(job_, above));
        }
    }

    void cut_level(const LeadContour& led,
                   const std::vector<TabStretch>& tabs,
                   double above,
                   double z)
    {
        const double full = bottom() + (cut_.tabs ? cut_.tabs->height : 0.0);
        writer_.enter(entry_run(led, tabs, z), above,
                      [](Vec2d, double) { return std::optional<double>{}; });
        if (led.leads.in) {
            write_edges({*led.leads.in}, z, z, form_, writer_);
        }
        for (const HeightStretch& s :
             heights_over_tabs(tabs, led.run.length(), z, bottom(), full)) {
            const Vec2d end = led.run.point(s.to);
            write_edges(led.run.part(s.from, s.to), s.z0, s.z1, form_, writer_);
            // vertical ends of tabs
            writer_.line(
                s.z1 < writer_.at().z ? toolpath::MoveKind::kPlunge : toolpath::MoveKind::kCut,
                {end.x, end.y, s.z1});
        }
        if (led.leads.out) {
            write_edges({*led.leads.out}, z, z, form_, writer_);
        }
        ++passes_;
    }

    // The lead-in and the contour up to its first tab: a ramp runs back and forth along it.
    EntryRun entry_run(const LeadContour& led, const std::vector<TabStretch>& tabs, double z) const
    {
        std::vector<Edge> edges =
            led.run.part(0, tabs.empty() ? led.run.length() : tabs.front().rise_begin);
        if (led.leads.in) {
            edges.insert(edges.begin(), *led.leads.in);
        }
        const Vec2d start = start_of(led);
        return run_along(edges, {start.x, start.y, z}, form_);
    }

    const Job& job_;
    const Operation& operation_;
    const Prismatic& cut_;
    ContourGroup drawn_;
    Region2d waste_;
    EdgeTree walls_;
    std::vector<double> levels_;
    PlannedOperation planned_;
    ToolpathWriter writer_;
    EdgeForm form_;
    std::optional<std::vector<Vec2d>> shared_tabs_;  // of both passes, where there is an allowance
    int passes_{0};
    int contours_{0};
    int tabs_{0};
    int leads_{0};
};

}  // namespace

namespace {

// Open lines: on them, or with the tool's edge along them.
PlannedOperation profile_of_lines(const Job& job, const Operation& operation)
{
    const Prismatic& cut = *operation.prismatic;
    if (cut.tabs || operation.passes.allowance > 0) {
        throw InputError(fmt::format("{}{}: tabs and allowance are of closed loops, this has lines",
                                     operation_text(job, operation), cut.file));
    }
    const bool on = cut.side == ProfileSide::kOn;
    const bool left = cut.side == ProfileSide::kInside;
    const bool climb = operation.passes.direction_of_cut == CutDirection::kClimb;
    std::vector<LineCut> cuts;
    std::vector<std::string> warnings;
    for (const job::Chain& chain : cut.chains) {
        const std::vector<Edge> line = edges_along(chain);
        if (on || line.empty()) {
            cuts.push_back({{line}});
            continue;
        }
        const auto paths = beside_line(line, operation.tool.radius, left);
        for (const std::vector<Edge>& path : paths) {
            cuts.push_back({{climb ? path : turned_around(path)}, true});
        }
        if (paths.empty()) {
            const Vec2d p = line.front().start;
            warnings.push_back(fmt::format(
                "{}: tool {} of {:g} mm fits nowhere beside the line at x {:.6g} y {:.6g} mm: not "
                "cut",
                cut.file, operation.tool.number, 2 * operation.tool.radius, p.x, p.y));
        }
    }
    cuts.erase(std::remove_if(cuts.begin(), cuts.end(),
                              [](const LineCut& one) { return one.paths.front().empty(); }),
               cuts.end());
    if (cuts.empty()) {
        throw InputError(operation_text(job, operation) + cut.file +
                         ": there is nothing to cut along");
    }
    const char* side = on ? "on" : left ? "left of" : "right of";
    const std::size_t many = cuts.size();
    PlannedOperation planned =
        cut_lines(job, operation, fmt::format("{} {}", side, counted(cut.chains.size(), "line")),
                  std::move(cuts));
    planned.stats.gouge_bound_mm = on ? 0.0 : kFit;
    planned.stats.warnings.insert(planned.stats.warnings.end(), warnings.begin(), warnings.end());
    planned.stats.counts.emplace_back("contours", static_cast<double>(many));
    return planned;
}

}  // namespace

std::vector<PlannedOperation> plan_profile(const Job& job, const Operation& operation)
{
    if (!operation.prismatic->chains.empty()) {
        return {profile_of_lines(job, operation)};
    }
    return {ProfilePlanner{job, operation}.plan()};
}

}  // namespace cusp::prismatic
