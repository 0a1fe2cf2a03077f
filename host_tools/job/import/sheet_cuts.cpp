// Named layers first; all other shapes by their nesting.
#include "host_tools/job/import/sheet_cuts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "firmware/base/inch.hpp"
#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/drawing_choice.hpp"
#include "host_tools/job/import/loop_nesting.hpp"
#include "host_tools/job/import/one_line_text.hpp"
#include "host_tools/job/import/sheet_drawing.hpp"
#include "host_tools/job/import/sheet_tools.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

using job::Region;

namespace {

// Operations of a lower rank are cut first: what frees a piece comes last.
enum Rank { kPockets, kLines, kHoles, kInner, kOutlines };

// "2 outlines", "3 holes and 1 island": those in no other one, and the others.
std::string loop_words(const std::vector<FileLoop>& loops, const char* outer, const char* inner)
{
    const auto odd = static_cast<std::size_t>(std::count_if(
        loops.begin(), loops.end(), [](const FileLoop& loop) { return loop.depth % 2 == 1; }));
    return counted(loops.size() - odd, outer) + (odd > 0 ? " and " + counted(odd, inner) : "");
}

// The side of a hole that is waste where that of an outline is `side`.
std::string other_side(const std::string& side)
{
    return side == "outside" ? "inside" : side == "inside" ? "outside" : side;
}

class SheetSorter {
public:
    SheetSorter(const OneLineRequest& request,
                const OneLineChoice& choice,
                const job::Strategies& strategies,
                PartFiles& parts)
        : request_{request},
          choice_{choice},
          strategies_{strategies},
          tools_{request, choice},
          unit_{request.inch ? kMillimetresPerInch : 1.0},
          depth_{*request.depth},
          drawings_{sheet_drawings(request, strategies, unit_, parts)}
    {
        for (const SheetDrawing& drawing : drawings_) {
            for (const SheetLayer& layer : drawing.named) {
                if (layer.use.isolates && !isolating_) {
                    isolating_ = tools_.isolating_place(isolating_depth(layer.use));
                }
            }
        }
        if (isolating_ && !tools_.is_vee(*isolating_)) {
            tools_.keep_for_copper(*isolating_);
        }
    }

    std::vector<SheetCut> cuts()
    {
        for (const SheetDrawing& drawing : drawings_) {
            for (const SheetLayer& layer : drawing.named) {
                add_layer(layer);
            }
            if (drawing.sorted) {
                add_sorted(*drawing.sorted);
            }
        }
        std::stable_sort(cuts_.begin(), cuts_.end(),
                         [](const SheetCut& a, const SheetCut& b) { return a.rank < b.rank; });
        return std::move(cuts_);
    }

private:
    using Place = SheetShapes;

    void add_layer(const SheetLayer& layer);
    void add_sorted(const Place& place);
    void add_holes(const Place& place, const std::string& loops, const std::string& side);
    void add_pocket(const Place& place, std::optional<double> depth);
    void add_profile(Rank rank,
                     const Place& place,
                     const std::string& loops,
                     const std::string& side,
                     double depth,
                     const std::vector<double>& except);
    double isolating_depth(const LayerUse& use) const;
    void add_isolation(const Place& place, const LayerUse& use);
    void add_lines(const Place& place,
                   const std::string& loops,
                   const std::string& what,
                   std::optional<double> depth);
    void add_flank_cut(const Place& place, const LayerUse& use);
    void add_drill(const Place& place,
                   const std::string& loops,
                   std::size_t tool,
                   std::optional<double> diameter,
                   std::size_t count,
                   std::optional<double> depth);
    std::vector<double> drill_fitting(const Place& place,
                                      const std::string& loops,
                                      bool every,
                                      std::optional<double> depth);

    void add(Rank rank,
             Region region,
             const Place& place,
             const std::string& keys,
             const std::string& said)
    {
        std::string toml =
            fmt::format("\n[[operation]]\nstrategy = \"{}\"\nboundary = {}\n",
                        strategy_for(region, strategies_).name, quoted(place.boundary));
        if (!place.layers.empty()) {
            toml += fmt::format("drawing_layers = {}\n", quoted_list(place.layers));
        }
        cuts_.push_back({rank, toml + keys, fmt::format("{}: {}", place.words, said)});
    }

    std::string loops_key(const std::string& loops) const
    {
        return loops == "all" ? "" : fmt::format("loops = \"{}\"\n", loops);
    }
    std::string join_key() const
    {
        return request_.join_gaps ? fmt::format("join_gaps = {}\n", *request_.join_gaps) : "";
    }
    // "6 mm deep"; also in which steps
    std::string deep(double depth, double step) const
    {
        return fmt::format("{:.6g} {} deep{}", depth, choice_.unit,
                           step < depth ? fmt::format(" in cuts of at most {:.6g}", step) : "");
    }
    std::string tool_words(std::size_t tool) const
    {
        return words_of(choice_.tools[tool], request_.inch);
    }
    std::string side_of_request() const
    {
        return request_.side.empty() ? "outside" : request_.side;
    }

    const OneLineRequest& request_;
    const OneLineChoice& choice_;
    const job::Strategies& strategies_;
    SheetTools tools_;
    double unit_;   // mm
    double depth_;  // in it
    std::vector<SheetDrawing> drawings_;
    std::vector<SheetCut> cuts_;
    std::optional<std::size_t> isolating_;  // place of the tool that cuts around copper
};

void SheetSorter::add_layer(const SheetLayer& layer)
{
    const LayerUse& use = layer.use;
    const Place& place = layer.place;
    if (use.region == Region::kLevelPocket) {
        add_pocket(place, use.depth);
    } else if (use.region == Region::kHoles && use.only_fitting) {
        add_holes(place, "all", "inside");
    } else if (use.region == Region::kHoles) {
        drill_fitting(place, "all", true, use.depth);
    } else if (use.region == Region::kGrooves) {
        add_lines(place, "all", "lines", use.depth);
    } else if (use.isolates) {
        add_isolation(place, use);
    } else if (use.region == Region::kOutline) {
        const std::string side = use.side.empty() ? side_of_request() : use.side;
        add_profile(side == "outside" ? kOutlines : kInner, place, "all", side,
                    use.depth.value_or(depth_), {});
    } else {
        add_flank_cut(place, use);
    }
}

// Shapes of all layers that no option and no name says anything about.
void SheetSorter::add_sorted(const Place& place)
{
    const std::string side = side_of_request();
    if (place.swapped) {
        const DrawingChoice inner{{}, "inner", {}};
        if (!chosen_loops(inner, place.shapes).empty()) {
            add_profile(kInner, place, "inner", side, depth_, {});
        }
        add_holes(place, "outer", other_side(side));
    } else {
        add_holes(place, "inner", other_side(side));
        if (!place.shapes.loops.empty()) {
            add_profile(kOutlines, place, "outer", side, depth_, {});
        }
    }
    if (!place.shapes.open.empty()) {
        add_lines(place, "open", counted(place.shapes.open.size(), "open line"), std::nullopt);
    }
}

// Circles that fit a tool are drilled; others, and other loops, are cut along.
void SheetSorter::add_holes(const Place& place, const std::string& loops, const std::string& side)
{
    std::vector<double> except = drill_fitting(place, loops, false, std::nullopt);
    const DrawingChoice rest{{}, loops, except};
    if (chosen_loops(rest, place.shapes).empty()) {
        return;
    }
    const double across = tools_.last_mill().diameter;
    std::map<double, std::size_t> narrow;
    for (const job::Hole& hole : chosen_circles(rest, place.shapes)) {
        if (side != "on" && hole.diameter < across * unit_ - kSameDiameter) {
            ++narrow[std::round(hole.diameter * 1e4) / 1e4];
        }
    }
    for (const auto& [diameter, count] : narrow) {
        except.push_back(diameter);
        cuts_.push_back(
            {kHoles, "",
             fmt::format("{}: left out: {} of {:.6g} {}, narrower than {}; --tool drill:{:.6g} "
                         "drills {}",
                         place.words, counted(count, "hole"), diameter / unit_, choice_.unit,
                         tool_words(tools_.last_mill_place()), diameter / unit_,
                         count == 1 ? "it" : "them")});
    }
    if (!chosen_loops({{}, loops, except}, place.shapes).empty()) {
        add_profile(kInner, place, loops, side, depth_, except);
    }
}

void SheetSorter::add_pocket(const Place& place, std::optional<double> asked)
{
    const double depth = asked.value_or(depth_ / 2);
    const std::size_t tool = tools_.last_mill_place();
    const double step = tools_.step_of(tool);
    std::string keys = fmt::format("tool = {}\ndepth = {}\nmax_depth = {}\noutput = \"{}\"\n",
                                   tool + 1, depth, step, request_.output);
    const std::vector<std::size_t> roughing = tools_.roughing_mills();
    if (!roughing.empty()) {
        keys += fmt::format("tools = [{}]  # these rough\n", fmt::join(roughing, ", "));
    }
    add(kPockets, Region::kLevelPocket, place, keys + join_key(),
        fmt::format("pocket, {}, {}{}", tool_words(tool), deep(depth, step),
                    asked ? "" : " (half the depth; --layer NAME=pocket:DEPTH)"));
}

void SheetSorter::add_profile(Rank rank,
                              const Place& place,
                              const std::string& loops,
                              const std::string& side,
                              double depth,
                              const std::vector<double>& except)
{
    const std::size_t tool =
        rank == kOutlines ? tools_.first_mill_place() : tools_.last_mill_place();
    const double step = tools_.step_of(tool);
    std::string keys = loops_key(loops) + fmt::format("side = \"{}\"\n", side);
    if (!except.empty()) {
        std::vector<double> diameters;
        for (const double diameter : except) {
            diameters.push_back(std::round(diameter / unit_ * 1e6) / 1e6);
        }
        keys += fmt::format("except_diameters = [{}]\n", fmt::join(diameters, ", "));
    }
    keys += fmt::format("tool = {}\ndepth = {}\nmax_depth = {}\n", tool + 1, depth, step);
    if (request_.allowance) {
        keys += fmt::format("allowance = {}\n", *request_.allowance);
    }
    const bool is_part = rank == kOutlines || (place.swapped && loops == "inner");
    std::string tabs;
    if (rank == kOutlines && !request_.tabs.empty()) {
        const SheetTabs wanted = tabs_of_text(request_.tabs, depth, choice_.tools[tool].diameter);
        keys += fmt::format("tabs = {{ count = {}, width = {}, height = {} }}\n", wanted.count,
                            wanted.width, wanted.height);
        tabs = fmt::format(", {} of {:.6g} x {:.6g} on each", counted(wanted.count, "tab"),
                           wanted.width, wanted.height);
    }
    add(rank, Region::kOutline, place,
        keys + fmt::format("output = \"{}\"\n", request_.output) + join_key(),
        fmt::format("{}: profile {}, {}, {}{}",
                    loop_words(chosen_loops({{}, loops, except}, place.shapes),
                               is_part ? "outline" : "hole", is_part ? "hole" : "island"),
                    side == "on" ? "on the line" : side, tool_words(tool), deep(depth, step),
                    tabs));
}

double SheetSorter::isolating_depth(const LayerUse& use) const
{
    const double shallow = request_.inch ? 0.004 : 0.1;
    return use.depth.value_or(std::min(shallow, depth_ / 2));
}

// Once around copper, with the mill or the vee whose cut is narrowest.
void SheetSorter::add_isolation(const Place& place, const LayerUse& use)
{
    const double depth = isolating_depth(use);
    const std::size_t tool = *isolating_;
    const Region region = tools_.is_vee(tool) ? Region::kGrooves : Region::kOutline;
    add(kLines, region, place,
        fmt::format("side = \"outside\"\ntool = {}\ndepth = {}\noutput = \"{}\"\n", tool + 1, depth,
                    request_.output) +
            join_key(),
        fmt::format("{}: {} outside, {}, {}{}",
                    loop_words(place.shapes.loops, "copper island", "opening"),
                    strategy_for(region, strategies_).name, tool_words(tool), deep(depth, depth),
                    use.depth ? "" : " (--layer NAME=outside:DEPTH)"));
}

void SheetSorter::add_lines(const Place& place,
                            const std::string& loops,
                            const std::string& what,
                            std::optional<double> asked)
{
    const double shallow = request_.inch ? 0.02 : 0.5;
    const double depth = asked.value_or(std::min(shallow, depth_ / 2));
    const std::size_t tool = tools_.engraver_place();
    const double step = tools_.step_of(tool);
    std::string keys = loops_key(loops) + fmt::format("tool = {}\ndepth = {}\n", tool + 1, depth);
    keys += step < depth ? fmt::format("max_depth = {}\n", step) : "";
    keys += loops == "all" ? "" : join_key();
    add(kLines, Region::kGrooves, place, keys + fmt::format("output = \"{}\"\n", request_.output),
        fmt::format("{}: engrave, {}, {}{}", what, tool_words(tool), deep(depth, step),
                    asked ? "" : " (--layer NAME=engrave:DEPTH)"));
}

// By the flanks of a vee: v_carve, chamfer.
void SheetSorter::add_flank_cut(const Place& place, const LayerUse& use)
{
    const std::size_t tool = tools_.vee_place(use);
    std::string keys = fmt::format("tool = {}\n", tool + 1);
    if (use.depth) {
        keys +=
            fmt::format("{} = {}\n", use.region == Region::kEdges ? "width" : "depth", *use.depth);
    }
    add(kLines, *use.region, place,
        keys + fmt::format("output = \"{}\"\n", request_.output) + join_key(),
        fmt::format("{}, {}", use.word, tool_words(tool)));
}

// diameter  mm; none: all circles and points
void SheetSorter::add_drill(const Place& place,
                            const std::string& loops,
                            std::size_t tool,
                            std::optional<double> diameter,
                            std::size_t count,
                            std::optional<double> asked)
{
    constexpr double kPeckFrom = 3;  // diameters
    const double depth = asked.value_or(depth_ + tools_.tip_of(tool));
    const double across = choice_.tools[tool].diameter;
    std::string keys = loops_key(loops) + fmt::format("tool = {}\ndepth = {}\n", tool + 1, depth);
    std::string what = "points and circles";
    if (diameter) {
        const double wanted = std::round(*diameter / unit_ * 1e6) / 1e6;
        keys += fmt::format("diameter = {}\n", wanted);
        what = fmt::format("{} of {:.6g} {}", counted(count, "hole"), wanted, choice_.unit);
    }
    keys += loops == "all" ? "" : join_key();
    keys += depth > kPeckFrom * across ? fmt::format("peck = {}\n", across) : "";
    add(kHoles, Region::kHoles, place, keys,
        fmt::format("{}: drill, {}, its tip {:.6g} {} deep", what, tool_words(tool), depth,
                    choice_.unit));
}

// Drills the circles that have a tool of their size; `every`: all circles, each by the largest drill that is
// no wider. Returns their diameters, mm.
std::vector<double> SheetSorter::drill_fitting(const Place& place,
                                               const std::string& loops,
                                               bool every,
                                               std::optional<double> depth)
{
    if (every && tools_.has_one_drill()) {
        add_drill(place, loops, tools_.only_drill_place(), std::nullopt, 0, depth);
        return {};
    }
    std::vector<double> all;
    for (const job::Hole& hole : chosen_circles({{}, loops, {}}, place.shapes)) {
        all.push_back(hole.diameter);
    }
    if (every && all.empty()) {
        throw InputError(fmt::format(
            "{}: has no circle, and points have no diameter: give one drill, such as --tool "
            "flat:3 drill:5",
            place.words));
    }
    std::sort(all.begin(), all.end());
    std::vector<double> drilled;
    for (std::size_t k = 0; k < all.size();) {
        std::size_t end = k;
        while (end < all.size() && all[end] - all[k] <= kSameDiameter) {
            ++end;
        }
        const auto tool = tools_.drill_for(all[k] / unit_, kSameDiameter / unit_, every);
        if (tool) {
            add_drill(place, loops, *tool, all[k], end - k, depth);
            drilled.push_back(all[k]);
        } else if (every) {
            throw InputError(
                fmt::format("{}: the hole of {:.6g} {} is narrower than every drill: "
                            "--tool drill:{:.6g}",
                            place.words, all[k] / unit_, choice_.unit, all[k] / unit_));
        }
        k = end;
    }
    return drilled;
}

}  // namespace

std::vector<SheetCut> sheet_cuts(const OneLineRequest& request,
                                 const OneLineChoice& choice,
                                 const job::Strategies& strategies,
                                 PartFiles& parts)
{
    return SheetSorter{request, choice, strategies, parts}.cuts();
}

}  // namespace cusp::import
