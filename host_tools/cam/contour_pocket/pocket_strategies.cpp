// The records of contour pockets.
#include "host_tools/cam/contour_pocket/contour_pocket.hpp"
#include "host_tools/job/job/operation_check.hpp"
#include "host_tools/job/job/operation_keys.hpp"

namespace cusp::contour_pocket {

using job::Job;
using job::Operation;
using job::Region;
using job::Strategy;
using job::Traits;
using Kind = job::KeyKind;

namespace {

constexpr Traits traits_of(Region region)
{
    Traits traits;
    traits.region = region;
    traits.pocket = true;
    traits.one_line = region == Region::kSurfaces;
    return traits;
}

// The contour pocket of a level floor, from its own top down.
std::vector<toolpath::PlannedOperation> plan_pocket(const Job& job, const Operation& operation)
{
    Job from_top = job;
    from_top.operations.clear();
    from_top.stock_top = operation.prismatic->top;
    from_top.clearance = job.stock_top + job.clearance - from_top.stock_top;
    return plan_contour_pocket(from_top, operation);
}

void check_level_pocket(const Operation& operation, const job::Refuse& refuse)
{
    check_level(operation, refuse);
    check_pocket(operation, refuse);
}

}  // namespace

const Strategy kContourPocket{
    "contour_pocket",
    "what a boundary encloses, in loops, down to a floor of surfaces",
    job::surface_keys({"tools"}),
    {{"scallop", Kind::kLength, "needed",
      "most that may be left where the tool reaches, square to the surface, tolerance included",
      job::kToleranceRange}},
    traits_of(Region::kSurfaces),
    nullptr,
    job::check_pocket,
    plan_contour_pocket};

const Strategy kPocket{
    "pocket",
    "the loops of a drawing down to a level floor: all that `contour_pocket` does",
    job::shared_keys(
        job::with_text({"islands",          "output",          "join_gaps", "tolerance_side",
                        "direction_of_cut", "entry",           "allowance", "max_depth",
                        "min_depth",        "layers",          "clearing",  "max_engagement",
                        "chip_load",        "feed_min",        "feed_max",  "tools",
                        "step_over",        "depth",           "top",       "may_open",
                        "relief",           "except_diameters"})),
    {{"scallop", Kind::kLength, "0.04 mm for round ends", "the ridges on the floor",
      job::kToleranceRange},
     {"floor_tolerance", Kind::kLength, "0.002 mm", "of the path against the floor",
      job::kToleranceRange}},
    traits_of(Region::kLevelPocket),
    nullptr,
    check_level_pocket,
    plan_pocket};

}  // namespace cusp::contour_pocket
