// The records of planes, levels, and both.
#include "host_tools/cam/steep_shallow/parallel_planes.hpp"
#include "host_tools/cam/steep_shallow/steep_shallow.hpp"
#include "host_tools/job/job/finish_keys.hpp"
#include "host_tools/job/job/operation_check.hpp"

namespace cusp::steep_shallow {

using job::Key;
using job::KeyValues;
using job::Operation;
using job::Refuse;
using job::Traits;
using Kind = job::KeyKind;

namespace {

constexpr double kSteepEnough = 30;  // degrees: levels of flatter ground lie far apart in plan

std::any read_planes(const KeyValues& values, const Operation& /*operation*/, const Refuse& refuse)
{
    job::FinishKeys keys;
    keys.direction = values.get<std::string>("direction").front();
    keys.plane_angle = values.get<double>("plane_angle");
    keys.range = read_range(values, refuse);
    return keys;
}

std::any read_levels(const KeyValues& values, const Operation& /*operation*/, const Refuse& refuse)
{
    job::FinishKeys keys;
    keys.spiral = values.get<bool>("spiral");
    keys.range = read_range(values, refuse);
    if (!values.find<std::vector<double>>("slopes")) {
        keys.range.least_slope = kSteepEnough;
    }
    return keys;
}

std::any read_both(const KeyValues& values, const Operation& operation, const Refuse& refuse)
{
    auto keys = std::any_cast<job::FinishKeys>(read_planes(values, operation, refuse));
    keys.spiral = values.get<bool>("spiral");
    keys.steep_from = values.get<double>("steep_from");
    return keys;
}

void check_planes(const Operation& operation, const Refuse& refuse)
{
    check_finishing_end(operation, refuse);
    need(operation.passes.step_over || operation.tolerance.scallop, "step_over", "it or scallop",
         operation, refuse);
}

void check_levels(const Operation& operation, const Refuse& refuse)
{
    check_finishing_end(operation, refuse);
    need(operation.tolerance.scallop.has_value(), "scallop",
         "the height of the scallops that may remain", operation, refuse);
}

const Key kStepOver{"step_over", Kind::kLength, "this or `scallop`", "between planes",
                    job::kPositive};
const Key kPlaneAngle{"plane_angle",
                      Kind::kAngle,
                      "0",
                      "planes are turned by that from x or y, counter-clockwise",
                      {-180, 180}};
const Key kSpiral{"spiral", Kind::kFlag, "false",
                  "level loops above each other become one way down"};
const Key kSteepFrom{"steep_from",
                     Kind::kAngle,
                     "45",
                     "levels over ground from that slope on, planes over the rest",
                     {5, 85}};

Traits section_traits()
{
    Traits traits;
    traits.one_line = true;
    traits.takes_mesh = true;
    traits.only_finishes = true;
    return traits;
}

}  // namespace

const job::Strategy kParallelPlanes{
    "parallel_planes",     "finishes a part along parallel planes",
    job::finishing_keys(), job::with_ranges({kStepOver, job::direction_key(), kPlaneAngle}),
    section_traits(),      read_planes,
    check_planes,          plan_parallel_planes};

const job::Strategy kWaterline{
    "waterline",           "finishes steep ground of a part along level loops or a spiral",
    job::finishing_keys(), job::with_ranges({kSpiral}),
    section_traits(),      read_levels,
    check_levels,          plan_waterline};

const job::Strategy kSteepShallow{
    "steep_shallow",
    "finishes a part along levels where it is steep, along planes elsewhere",
    job::finishing_keys(),
    job::with_ranges({job::direction_key(), kPlaneAngle, kSpiral, kSteepFrom}),
    section_traits(),
    read_both,
    check_levels,
    plan_steep_shallow};

}  // namespace cusp::steep_shallow
