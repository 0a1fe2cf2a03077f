// Keys first, then the drawing; levels last, for they follow from the stock's top.
#include "host_tools/job/import/prismatic_reader.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/corner_relief.hpp"
#include "host_tools/job/import/drawn_shapes.hpp"
#include "host_tools/job/import/dxf_holes.hpp"
#include "host_tools/job/import/file_loops.hpp"
#include "host_tools/job/import/groove_sides.hpp"
#include "host_tools/job/import/job_key_tables.hpp"
#include "host_tools/job/import/part_edges.hpp"
#include "host_tools/job/import/part_extent.hpp"
#include "host_tools/job/import/path_ending.hpp"
#include "host_tools/job/job/hole_depth.hpp"
#include "host_tools/job/job/operation_check.hpp"
#include "host_tools/job/job/operation_keys.hpp"
#include "host_tools/job/job/thread.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::Hole;
using job::Job;
using job::NestedLoop;
using job::Operation;
using job::Prismatic;
using job::ProfileSide;
using job::Tabs;
using toolpath::Tool;

namespace {

Tabs read_tabs(JobTable& keys)
{
    Tabs tabs;
    tabs.count = keys.whole_number("count").value_or(0);
    const auto places = keys.numbers("places");
    if (places && places->size() % 2 != 0) {
        keys.refuse("places", "an even count of numbers is needed: [x, y, x, y]");
    }
    for (std::size_t i = 0; places && i < places->size(); i += 2) {
        tabs.places.push_back({(*places)[i], (*places)[i + 1]});
    }
    if (tabs.count == 0 && !places) {
        keys.refuse("count", "either count or places is needed, such as count = 4");
    }
    tabs.width = keys.number("width").value();
    tabs.height = keys.number("height").value();
    tabs.ramped = keys.choice_or_default("shape") == "ramp";
    keys.check_all_read();
    return tabs;
}

// A level floor costs nothing more where it is followed closely. The height of ridges says how far
// apart the loops of a round end are; with a flat end there are none.
void choose_pocket_tolerances(JobTable& table, Operation& operation)
{
    if (!table.has("floor_tolerance")) {
        operation.tolerance.default_floor = true;
    }
    if (!operation.tolerance.scallop) {
        operation.tolerance.default_scallop = true;
        operation.tolerance.scallop = operation.tool.corner_radius > 0
                                          ? table.number_or_default("scallop")
                                          : 2 * operation.tolerance.floor;
    }
}

// Loops of the drawing, with which of them are holes.
std::vector<NestedLoop> nested(const std::vector<FileLoop>& loops)
{
    std::vector<NestedLoop> out;
    for (const FileLoop& loop : loops) {
        out.push_back({loop.loop, loop.name, loop.depth % 2 == 1});
    }
    return out;
}

// A tool that moves sideways in a hole bores it; another one drills it.
bool is_bored(const Operation& operation)
{
    return find_key(keys_of(*operation.strategy), "direction_of_cut") != nullptr;
}

bool is_beside_lines(JobTable& table)
{
    const std::string side = table.choice_or_default("side");
    return side == "left" || side == "right";
}

// The circles that the choice takes, of the wanted diameters.
std::vector<Hole> chosen_holes(const JobTable& table,
                               const DrawingChoice& choice,
                               const FileShapes& shapes,
                               DiameterRange range)
{
    std::vector<Hole> holes = chosen_circles(choice, shapes);
    const auto is_other = [&](const Hole& hole) {
        return hole.diameter < range.least || hole.diameter > range.greatest;
    };
    holes.erase(std::remove_if(holes.begin(), holes.end(), is_other), holes.end());
    if (holes.empty()) {
        table.refuse("boundary", "no circle of the wanted diameter among the loops to drill");
    }
    return holes;
}

// Takes out the holes that the tool doesn't fit into, with room to move in a bore.
void check_holes(const JobTable& table, Operation& operation, PartFiles& parts)
{
    const Tool& tool = operation.tool;
    Prismatic& cut = *operation.prismatic;
    const auto fits = [&](const Hole& hole) {
        if (cut.countersink) {
            return hole.diameter < *cut.countersink - kSameDiameter;
        }
        const double least = 2 * tool.radius + (is_bored(operation) ? 1 : -1) * kSameDiameter;
        return !(hole.diameter > 0 && hole.diameter < least);
    };
    const auto narrower = std::stable_partition(cut.holes.begin(), cut.holes.end(), fits);
    cut.narrower_holes.assign(narrower, cut.holes.end());
    cut.holes.erase(narrower, cut.holes.end());
    if (cut.holes.empty()) {
        const Hole& hole = cut.narrower_holes.front();
        if (cut.countersink) {
            table.refuse("countersink",
                         fmt::format("is {:g} mm, all holes are as wide, such as that of {:g} mm "
                                     "at x {:.6g} y {:.6g} mm",
                                     *cut.countersink, hole.diameter, hole.at.x, hole.at.y));
        }
        table.refuse("boundary",
                     fmt::format("the hole of {:g} mm at x {:.6g} y {:.6g} mm is smaller than "
                                 "tool {} of {:g} mm{}, as are all; diameter chooses holes",
                                 hole.diameter, hole.at.x, hole.at.y, tool.number, 2 * tool.radius,
                                 is_bored(operation) ? " with room to move" : ""));
    }
    const auto larger = std::count_if(cut.holes.begin(), cut.holes.end(), [&](const Hole& hole) {
        return hole.diameter > 2 * tool.radius + kSameDiameter;
    });
    if (larger > 0 && !is_bored(operation)) {
        parts.note(fmt::format(
            "operation {}: drill: {} of {} {} wider than tool {} of {:g} mm: {} its diameter",
            operation.number, larger, counted(cut.holes.size(), "hole"), larger == 1 ? "is" : "are",
            tool.number, 2 * tool.radius, larger == 1 ? "it gets" : "they get"));
    }
}

// Threads are as wide as their grooves, whatever is drawn. Holes whose tool moves in them have a loop each.
void settle_widths(const JobTable& table, Operation& operation, PartFiles& parts)
{
    Prismatic& cut = *operation.prismatic;
    const job::Thread* const thread = thread_of(operation);
    for (Hole& hole : cut.holes) {
        hole.diameter = thread == nullptr ? hole.diameter : thread->wall();
    }
    if (thread == nullptr || !thread->outside) {
        check_holes(table, operation, parts);
    }
    if (!is_bored(operation)) {
        return;
    }
    cut.side = ProfileSide::kInside;
    for (const Hole& hole : cut.holes) {
        cut.loops.push_back({{arc_curve(hole.at, hole.diameter / 2, 0, 2 * kPi)}, cut.file, false});
    }
}

// The depth of the deepest one, where they are a model's.
void settle_holes(const Job& job, Operation& operation)
{
    Prismatic& cut = *operation.prismatic;
    if (!operation.cuts(job::Region::kHoles) || cut.given_depth) {
        return;
    }
    for (const Hole& hole : cut.holes) {
        const double depth = cut.top - job::tip_in_hole(cut, hole, operation.tool);
        if (!(depth > 0)) {
            throw InputError(fmt::format(
                "{}: operation {}: {}: the hole at x {:.6g} y {:.6g} mm ends {:.4g} mm above "
                "the top of z {:.6g} mm; raise top",
                job.file, operation.number, operation.name(), hole.at.x, hole.at.y, -depth,
                cut.top));
        }
        cut.depth = std::max(cut.depth, depth);
    }
}

struct DrawnUnit {
    double millimetres;
    EndDistance gaps;
};

// Beside loops, which are those of the grooves' walls.
void read_groove_sides(JobTable& table,
                       const std::vector<NestedLoop>& loops,
                       PartFiles& parts,
                       Operation& operation)
{
    Prismatic& cut = *operation.prismatic;
    if (loops.empty()) {
        table.refuse("loops", "the drawing has none of these");
    }
    const bool inside = cut.side == ProfileSide::kInside;
    BesideLoops beside = beside_loops(loops, operation.tool, cut.depth, inside);
    if (beside.chains.empty()) {
        table.refuse("side", fmt::format("the groove of tool {} fits nowhere {} the loops",
                                         operation.tool.number, inside ? "inside" : "outside"));
    }
    if (beside.place) {
        parts.note(
            fmt::format("operation {}: {}: the groove of tool {} does not reach {:.4g} mm of "
                        "the loops, such as at x {:.6g} y {:.6g} mm: others are too near",
                        operation.number, operation.name(), operation.tool.number, beside.unreached,
                        beside.place->x, beside.place->y));
    }
    cut.chains = std::move(beside.chains);
    cut.side = ProfileSide::kOn;
}

// The lines that a tool follows, on them or beside them.
void read_ways(JobTable& table,
               const DrawingChoice& choice,
               const FileShapes& shapes,
               const DrawnUnit& unit,
               PartFiles& parts,
               Operation& operation)
{
    Prismatic& cut = *operation.prismatic;
    const std::string& file = cut.file;
    const bool engraves = operation.cuts(job::Region::kGrooves);
    if (engraves && names_broken_edges(file)) {
        if (!cut.given_top) {
            table.refuse("top", "is missing: broken edges need the z of their upper side");
        }
        cut.chains = edge_ways(file, unit.millimetres,
                               parts.facets(file.substr(0, layer_mark(file)), unit.millimetres),
                               operation.tool, *cut.given_top - cut.depth);
    } else if (engraves && cut.side != ProfileSide::kOn &&
               find_key(keys_of(*operation.strategy), "side") != nullptr) {
        read_groove_sides(table,
                          nested(choice.takes_all() ? parts.loops(file, unit.millimetres, unit.gaps)
                                                    : chosen_loops(choice, shapes)),
                          parts, operation);
    } else {
        cut.chains = choice.takes_all() ? parts.chains(file, unit.millimetres)
                                        : chosen_chains(choice, shapes);
    }
    if (cut.chains.empty()) {
        table.refuse("loops", "the drawing has none of these");
    }
}

// A level rectangle around the boundary.
nurbs::Surface flat_floor(const job::Loop& boundary, double margin, double z)
{
    const PartExtent box = extent_of_curves(boundary);
    const double x0 = box.low.x - margin;
    const double y0 = box.low.y - margin;
    const double x1 = box.high.x + margin;
    const double y1 = box.high.y + margin;
    return {1,
            1,
            {0, 0, 1, 1},
            {0, 0, 1, 1},
            2,
            2,
            {{x0, y0, z}, {x0, y1, z}, {x1, y0, z}, {x1, y1, z}},
            {1, 1, 1, 1},
            {}};
}

}  // namespace

// Over 60 lines: one key after the other.
void read_prismatic_keys(JobTable& table, const job::Strategy& strategy, Operation& operation)
{
    Prismatic cut;
    const auto depth = table.number("depth");
    cut.given_top = table.number("top");
    const std::string side = table.choice_or_default("side");
    // as a loop that runs counter-clockwise has its inside on the left
    cut.side = side == "outside" || side == "right" ? ProfileSide::kOutside
               : side == "inside" || side == "left" ? ProfileSide::kInside
                                                    : ProfileSide::kOn;
    if (const toml::table* tabs = table.inline_table("tabs")) {
        JobTable keys = table.inner(*tabs, "tabs", job::tabs_table().keys);
        cut.tabs = read_tabs(keys);
    }
    cut.lead_in = table.number("lead_in");
    cut.lead_out = table.number("lead_out");
    cut.peck = table.number("peck");
    cut.countersink = table.number("countersink");
    cut.overhang = table.number("overhang");
    const auto width = table.number("width");
    cut.diameters = table.interval("diameter");
    if (!strategy.is_prismatic()) {
        return;
    }
    cut.width = width.value_or(0);
    cut.given_depth = depth.has_value();
    cut.depth = depth.value_or(0);
    const double slope = 1 / elementary::tan(operation.tool.tip_angle / 2);
    if (operation.cuts(job::Region::kEdges)) {
        cut.depth = cut.width * slope;
    } else if (operation.cuts(job::Region::kValleys)) {
        cut.depth = depth.value_or(job::flank_height(operation.tool));
        operation.tolerance.scallop = table.number_or_default("scallop");
    }
    operation.prismatic = cut;
    if (operation.cuts(job::Region::kLevelPocket)) {
        choose_pocket_tolerances(table, operation);
    }
}

void read_reliefs(JobTable& table, PartFiles& parts, Operation& operation)
{
    const std::string kind = table.choice_or_default("relief");
    const bool has_walls = operation.outline.boundary || operation.cuts(job::Region::kOutline);
    if (kind == "none" || !has_walls) {
        return;
    }
    if (operation.cuts(job::Region::kOutline) &&
        (operation.prismatic->side == ProfileSide::kOn || !operation.prismatic->chains.empty())) {
        table.refuse("relief", "belongs to a profile outside or inside closed loops");
    }
    const std::size_t left_out = add_reliefs(
        {kind == "dogbone" ? ReliefKind::kDogbone : ReliefKind::kTBone, operation.tool.radius},
        operation);
    if (left_out > 0) {
        parts.note(fmt::format("operation {}: {}: {} too short for a relief", operation.number,
                               operation.name(),
                               left_out == 1 ? "1 corner has a side"
                                             : fmt::format("{} corners have sides", left_out)));
    }
}

void read_drawing(JobTable& table,
                  const DrawingChoice& choice,
                  PartFiles& parts,
                  Operation& operation)
{
    const double unit = table.unit();
    Prismatic& cut = *operation.prismatic;
    const std::string& file = cut.file;
    const EndDistance gaps{operation.tolerance.plan, operation.tolerance.join_gaps};
    if (!choice.layers.empty() && layer_mark(file) != std::string::npos) {
        table.refuse("drawing_layers", "goes with a drawing without #layer in boundary");
    }
    FileShapes shapes;
    if (!choice.takes_all()) {
        shapes = parts.shapes(file, choice.layers, unit, gaps);
    }
    if (operation.cuts(job::Region::kHoles)) {
        const auto [least, greatest] = cut.diameters.value_or(std::array{0.0, job::kLargest});
        const DiameterRange range{least - kSameDiameter, greatest + kSameDiameter};
        cut.holes =
            choice.takes_all()
                ? parts.holes(file, unit, range, cut.diameters.has_value() || is_bored(operation))
                : chosen_holes(table, choice, shapes, range);
        if (cut.countersink) {
            cut.depth = profile_height(operation.tool, *cut.countersink / 2);
            cut.given_depth = true;
        }
        settle_widths(table, operation, parts);
        if (!cut.given_depth && !cut.holes.front().span) {
            table.refuse("depth", fmt::format("is missing: {} needs how deep it cuts where the "
                                              "holes are those of a drawing",
                                              operation.name()));
        }
    } else if (operation.cuts(job::Region::kGrooves) || is_beside_lines(table)) {
        read_ways(table, choice, shapes, {unit, gaps}, parts, operation);
    } else if (!choice.takes_all()) {
        cut.loops = nested(chosen_loops(choice, shapes));
        if (cut.loops.empty()) {
            table.refuse("loops", "the drawing has none of these");
        }
    } else if (!file.empty()) {
        try {
            cut.loops = nested(parts.loops(file, unit, gaps));
        } catch (const InputError&) {
            if (!operation.cuts(job::Region::kOutline) || cut.side != ProfileSide::kOn) {
                throw;
            }
            cut.chains = parts.chains(file, unit);  // on lines that may be open
        }
    }
    if (operation.cuts(job::Region::kOutline)) {
        read_reliefs(table, parts, operation);
    }
}

void check_sheet(const Job& job)
{
    if (job.stock_x && job.stock_y) {
        return;
    }
    const auto is_open = [](const Operation& o) {
        return !o.prismatic && !o.outline.boundary;
    };
    const auto is_beside = [](const Operation& o) {
        return o.cuts(job::Region::kOutline) && o.prismatic->side != ProfileSide::kInside;
    };
    const auto& all = job.operations;
    const auto open = std::find_if(all.begin(), all.end(), is_open);
    const auto beside = std::find_if(all.begin(), all.end(), is_beside);
    if (open != all.end() && beside != all.end()) {
        throw InputError(
            fmt::format("{}: operation {}: profile: there is stock around the part, but operation "
                        "{} ({}) takes the "
                        "part's box for the stock and would move in rapids through it: give x and "
                        "y, or margin, in [stock]",
                        job.file, beside->number, open->number, open->name()));
    }
}

void settle_levels(Job& job)
{
    double level = job.stock_top;
    for (Operation& operation : job.operations) {
        if (!operation.prismatic) {
            continue;
        }
        Prismatic& cut = *operation.prismatic;
        cut.top = cut.given_top.value_or(level);
        settle_holes(job, operation);
        if (operation.cuts(job::Region::kTop) && cut.loops.empty()) {
            level = cut.top - cut.depth;
        }
        if (operation.cuts(job::Region::kLevelPocket)) {
            operation.part.floor = {flat_floor(*operation.outline.boundary,
                                               2 * operation.tool.radius, cut.top - cut.depth)};
            operation.part.floor_files = {fmt::format(
                "{}: level at {:.9g}", operation.outline.boundary_file, cut.top - cut.depth)};
        }
    }
}

}  // namespace cusp::import
