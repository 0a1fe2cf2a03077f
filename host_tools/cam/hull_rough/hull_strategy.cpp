// The record of hull_rough.
#include "host_tools/cam/hull_rough/hull_rough.hpp"
#include "host_tools/job/job/operation_check.hpp"
#include "host_tools/job/job/operation_keys.hpp"

namespace cusp::hull_rough {

using job::choice;
using job::KeyValues;
using job::Operation;
using job::Refuse;
using Kind = job::KeyKind;

namespace {

std::any read(const KeyValues& values, const Operation& /*operation*/, const Refuse& /*refuse*/)
{
    HullKeys keys;
    keys.overlap = values.get<double>("overlap");
    keys.extra_subdivision = static_cast<int>(values.get<double>("extra_subdivision"));
    keys.contour_clearing = values.get<std::string>("clearing") == "contour";
    return keys;
}

void check(const Operation& operation, const Refuse& refuse)
{
    check_end(operation, refuse);
    need(operation.levels.max_depth.has_value(), "max_depth", "the depth of cut of a layer",
         operation, refuse);
    if (operation.passes.max_engagement && hull_keys(operation).overlap > 0) {
        refuse("overlap", "does not go with clearing = \"adaptive\", which has no lines");
    }
}

}  // namespace

const job::Strategy kHullRough{
    "hull_rough",
    "rough layers around the hulls of the surfaces' control points",
    job::surface_keys({"tools"}, {"scallop"}),  // hulls bound what is cut, not what is left
    {{"max_depth", Kind::kLength, "needed", "deepest cut of a layer", job::kPositive},
     {"overlap", Kind::kLength, "0", "of neighbouring passes", job::kNotNegative},
     {"extra_subdivision",
      Kind::kCount,
      "0",
      "more halvings of patches before they are boxed",
      {0, 8}},
     choice("clearing",
            {"zigzag", "contour", "adaptive"},
            "or `\"contour\"`, or `\"adaptive\"`: passes of bounded engagement "
            "(`docs/strategies.md`)")},
    {},
    read,
    check,
    plan_hull_rough};

}  // namespace cusp::hull_rough
