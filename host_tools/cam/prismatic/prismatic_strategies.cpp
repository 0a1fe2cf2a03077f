// The records of the 2.5-D strategies.
#include <utility>

#include "host_tools/cam/prismatic/prismatic.hpp"
#include "host_tools/job/job/operation_check.hpp"
#include "host_tools/job/job/operation_keys.hpp"

#include "fmt/format.h"

namespace cusp::prismatic {

using job::choice;
using job::kNotNegative;
using job::kPositive;
using job::need;
using job::Operation;
using job::Refuse;
using job::Region;
using job::shared_keys;
using job::Strategy;
using job::table;
using Kind = job::KeyKind;

namespace {

void check_drawing(const Operation& operation, const Refuse& refuse)
{
    need(!operation.prismatic->file.empty(), "boundary", "a drawing, such as \"plate.dxf#layer\"",
         operation, refuse);
}

void check_profile(const Operation& operation, const Refuse& refuse)
{
    const job::Prismatic& cut = *operation.prismatic;
    check_level(operation, refuse);
    if (cut.side == job::ProfileSide::kOn && operation.passes.allowance > 0) {
        refuse("allowance",
               "belongs to a profile inside or outside: on the line there is no wall to finish");
    }
    for (const auto& [key, lead] :
         {std::pair{"lead_in", cut.lead_in}, std::pair{"lead_out", cut.lead_out}}) {
        if (cut.side == job::ProfileSide::kOn && lead.value_or(0) > 0) {
            refuse(key,
                   "belongs to a profile beside the line: on the line it would cut next to "
                   "what is drawn");
        }
    }
    if (cut.tabs && cut.tabs->height >= cut.depth) {
        refuse("tabs",
               fmt::format(
                   "height is {:g} mm, the cut is only {:g} mm deep: tabs are lower than the cut",
                   cut.tabs->height, cut.depth));
    }
    check_drawing(operation, refuse);
}

void check_engraving(const Operation& operation, const Refuse& refuse)
{
    need(operation.prismatic->given_depth, "depth", "how deep it cuts", operation, refuse);
    check_sideways(operation, refuse);
    if (!operation.part.floor.empty() && operation.prismatic->side != job::ProfileSide::kOn) {
        refuse("side", "does not go with floor: how wide a groove is follows from its depth alone");
    }
    if (!operation.part.floor.empty() && operation.prismatic->given_top) {
        refuse("top", "does not go with floor: an engraving begins at its surface");
    }
    check_drawing(operation, refuse);
}

// A cone that is sharp or flat at its tip.
void check_flank(const Operation& operation, const Refuse& refuse)
{
    const toolpath::Tool& tool = operation.tool;
    if (tool.shape != toolpath::ToolShape::kVee && tool.shape != toolpath::ToolShape::kTaper) {
        refuse("tool", fmt::format("{} needs a vee or a taper, tool {} is {}", operation.name(),
                                   tool.number, name_of(tool.shape)));
    }
    if (tool.corner_radius > 0) {
        refuse("tool", fmt::format("tool {} has a ball at its tip: {} needs a sharp or a flat one",
                                   tool.number, operation.name()));
    }
}

void check_drill(const Operation& operation, const Refuse& refuse)
{
    check_drawing(operation, refuse);
    const toolpath::Tool& tool = operation.tool;
    const std::optional<double> width = operation.prismatic->countersink;
    if (!width) {
        return;
    }
    if (!is_conical(tool) || tool.corner_radius > 0) {
        refuse("countersink", fmt::format("needs the cone of a drill or a vee, tool {} is {}",
                                          tool.number, name_of(tool.shape)));
    }
    if (*width > 2 * tool.radius || *width <= 2 * tool.tip_radius) {
        refuse("countersink",
               fmt::format("is {:g} mm, the cone of tool {} is {:g} to {:g} mm wide", *width,
                           tool.number, 2 * tool.tip_radius, 2 * tool.radius));
    }
    if (operation.prismatic->given_depth) {
        refuse("depth", "does not go with countersink, whose width makes it");
    }
}

void check_chamfer(const Operation& operation, const Refuse& refuse)
{
    need(operation.prismatic->width > 0, "width", "its width, seen from above", operation, refuse);
    check_flank(operation, refuse);
    check_drawing(operation, refuse);
}

void check_v_carve(const Operation& operation, const Refuse& refuse)
{
    check_flank(operation, refuse);
    const double flank = job::flank_height(operation.tool);
    if (operation.prismatic->depth > flank) {
        refuse("depth", fmt::format("is {:g} mm, the flank of tool {} is only {:.4g} mm high",
                                    operation.prismatic->depth, operation.tool.number, flank));
    }
    check_drawing(operation, refuse);
}

}  // namespace

const Strategy kProfile{
    "profile",
    "around the loops of a drawing, or on them, down to a level",
    shared_keys(job::with_text({"output", "join_gaps", "direction_of_cut", "entry", "allowance",
                                "max_depth", "chip_load", "feed_min", "feed_max", "depth", "top",
                                "relief", "drawing_layers", "loops", "except_diameters"})),
    {choice("side",
            {"outside", "inside", "on", "left", "right"},
            "of the loops, or on them. A loop within a loop is a hole: outside the part is inside "
            "its holes. Of open lines as they are drawn: on, left, right"),
     table("tabs",
           job::tabs_table,
           "none",
           "bridges that hold the part: `{ count = 4, width = 6.0, height = 1.5, shape = \"ramp\" "
           "}`"),
     {"lead_in", Kind::kLength, "the tool's radius",
      "radius of the arc onto the path; 0: none. Halved where it has no room; on the line only 0",
      kNotNegative},
     {"lead_out", Kind::kLength, "`lead_in`", "likewise off the path", kNotNegative}},
    {Region::kOutline},
    nullptr,
    check_profile,
    plan_profile};

const Strategy kDrill{
    "drill",
    "the points and circles of a drawing, or the holes of a model",
    shared_keys({"join_gaps", "top", "may_open", "drawing_layers", "loops"}),
    {{"depth", Kind::kLength, "needed; of a model that of each hole",
      "below `top`: of the tool's tip", kPositive},
     {"diameter", Kind::kInterval, "all",
      "only circles or holes of this diameter, or `[least, greatest]`; points are left out then",
      kPositive},
     {"peck", Kind::kLength, "none",
      "the deepest step; the drill comes out after each to clear chips", kPositive},
     {"countersink", Kind::kLength, "none",
      "in place of `depth`: how wide the cone of the drill's or the vee's tip cuts at `top`",
      kPositive}},
    {Region::kHoles},
    nullptr,
    check_drill,
    plan_drill};

const Strategy kFace{
    "face",
    "the stock's top, or what loops enclose, down to a level",
    shared_keys({"output", "join_gaps", "direction_of_cut", "traversal", "max_depth", "chip_load",
                 "feed_min", "feed_max", "step_over", "depth", "top", "may_open"}),
    {{"overhang", Kind::kLength, "1 mm", "how far the tool's edge runs over the stock's",
      kNotNegative}},
    {Region::kTop},
    nullptr,
    job::check_level,
    plan_face};

const Strategy kEngrave{
    "engrave",
    "along lines and curves of a drawing, open or closed, at a level or following a floor",
    shared_keys(job::with_text({"output", "join_gaps", "max_depth", "depth", "top", "may_open",
                                "drawing_layers", "loops"})),
    {{"floor", Kind::kFiles, "none", "files of surfaces that it follows"},
     choice("side",
            {"on", "outside", "inside"},
            "of closed loops: the groove's upper edge runs along them, as beside copper. A loop "
            "within a loop is a hole")},
    {Region::kGrooves},
    nullptr,
    check_engraving,
    plan_engrave};

const Strategy kVCarve{
    "v_carve",
    "between the loops of a drawing, with slanted walls down to where they meet: letters, inlays",
    shared_keys(job::with_text(
        {"output", "join_gaps", "direction_of_cut", "max_depth", "step_over", "top", "may_open"})),
    {{"depth", Kind::kLength, "the height of the flank", "below `top`: the most", kPositive},
     {"scallop", Kind::kLength, "0.05 mm", "the ridges on a level floor", job::kToleranceRange}},
    {Region::kValleys},
    nullptr,
    check_v_carve,
    plan_v_carve};

const Strategy kChamfer{
    "chamfer",
    "the upper edge of the loops' material",
    shared_keys(job::with_text({"output", "join_gaps", "direction_of_cut", "top"})),
    {{"width", Kind::kLength, "needed", "seen from above; the vee's angle makes the depth",
      kPositive}},
    {Region::kEdges},
    nullptr,
    check_chamfer,
    plan_chamfer};

}  // namespace cusp::prismatic
