// The records of the 2.5-D strategies.
#include "host_tools/cam/prismatic/prismatic.hpp"
#include "host_tools/job/job/operation_keys.hpp"

namespace cusp::prismatic {

using job::kNotNegative;
using job::kPositive;
using job::Region;
using job::shared_keys;
using job::Strategy;
using Kind = job::KeyKind;

const Strategy kProfile{
    "profile",
    "around the loops of a drawing, or on them, down to a level",
    shared_keys({"output", "join_gaps", "direction_of_cut", "entry", "allowance", "max_depth",
                 "chip_load", "feed_min", "feed_max", "depth", "top"}),
    {{"side",
      Kind::kChoice,
      "outside",
      "of the loops, or on them. A loop within a loop is a hole: outside the part is inside its "
      "holes",
      {},
      {"outside", "inside", "on"}},
     {"tabs",
      Kind::kTable,
      "none",
      "bridges that hold the part: `{ count = 4, width = 6.0, height = 1.5, shape = \"ramp\" }`",
      {},
      {},
      job::tabs_table},
     {"lead_in", Kind::kLength, "the tool's radius",
      "radius of the arc onto the path; 0: none. Halved where it has no room; on the line 0",
      kNotNegative},
     {"lead_out", Kind::kLength, "`lead_in`", "likewise off the path", kNotNegative}},
    {Region::kOutline},
    nullptr,
    plan_profile};

const Strategy kDrill{
    "drill",
    "the points and circles of a drawing, or the holes of a model",
    shared_keys({"top", "may_open"}),
    {{"depth", Kind::kLength, "needed; of a model that of each hole",
      "below `top`: of the tool's tip", kPositive},
     {"diameter", Kind::kInterval, "all",
      "only circles or holes of this diameter, or `[least, greatest]`; points are left out then",
      kPositive},
     {"peck", Kind::kLength, "none",
      "the deepest step; the drill comes out after each to clear chips", kPositive}},
    {Region::kHoles},
    nullptr,
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
    plan_face};

const Strategy kEngrave{
    "engrave",
    "along lines and curves of a drawing, open or closed, at a level or following a floor",
    shared_keys({"output", "max_depth", "depth", "top", "may_open"}),
    {{"floor", Kind::kFiles, "none", "files of surfaces that it follows"}},
    {Region::kGrooves},
    nullptr,
    plan_engrave};

const Strategy kVCarve{
    "v_carve",
    "between the loops of a drawing, with slanted walls down to where they meet: letters, inlays",
    shared_keys(
        {"output", "join_gaps", "direction_of_cut", "max_depth", "step_over", "top", "may_open"}),
    {{"depth", Kind::kLength, "the height of the flank", "below `top`: the most", kPositive},
     {"scallop", Kind::kLength, "0.05 mm", "the ridges on a level floor", job::kTolerance}},
    {Region::kValleys},
    nullptr,
    plan_v_carve};

const Strategy kChamfer{"chamfer",
                        "the upper edge of the loops' material",
                        shared_keys({"output", "join_gaps", "direction_of_cut", "top"}),
                        {{"width", Kind::kLength, "needed",
                          "seen from above; the vee's angle makes the depth", kPositive}},
                        {Region::kEdges},
                        nullptr,
                        plan_chamfer};

}  // namespace cusp::prismatic
