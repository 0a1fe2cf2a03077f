// The records of isocurves and planes.
#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/cam/adaptive_isocurve/parallel_planes.hpp"
#include "host_tools/job/job/operation_check.hpp"
#include "host_tools/job/job/operation_keys.hpp"

namespace cusp::adaptive_isocurve {

using job::Operation;
using job::Refuse;
using job::surface_keys;
using job::Traits;
using Kind = job::KeyKind;

namespace {

void check_isocurves(const Operation& operation, const Refuse& refuse)
{
    check_end(operation, refuse);
    need(operation.iso_distance || operation.scallop, "iso_distance", "it or scallop", operation,
         refuse);
    check_adaptive_roughing(operation, refuse);
}

void check_planes(const Operation& operation, const Refuse& refuse)
{
    check_end(operation, refuse);
    need(operation.step_over || operation.scallop, "step_over", "it or scallop", operation, refuse);
    check_adaptive_roughing(operation, refuse);
}

Traits traits_of(bool takes_mesh, bool only_finishes)
{
    Traits traits;
    traits.takes_mesh = takes_mesh;
    traits.only_finishes = only_finishes;
    return traits;
}

}  // namespace

const job::Strategy kAdaptiveIsocurve{
    "adaptive_isocurve",
    "finishes a part along isocurves, denser where the scallop asks for it; roughs first if wanted",
    surface_keys({"iso_distance", "direction", "roughing", "tools"}),
    {{"iso_spacing",
      Kind::kChoice,
      "halving",
      "with `iso_distance`: the paper's rule, or `\"even\"`: full steps that follow their "
      "neighbours, shorter under the same test",
      {},
      {"halving", "even"}}},
    traits_of(true, false),
    check_isocurves,
    plan_adaptive_isocurve};

const job::Strategy kCompleteIsocurves{
    "complete_isocurves",
    "finishes a part along whole isocurves, to compare with",
    surface_keys({"iso_distance", "direction", "roughing", "tools"}),
    {},
    traits_of(false, false),
    check_isocurves,
    plan_complete_isocurves};

const job::Strategy kParallelPlanes{
    "parallel_planes",
    "finishes a part along parallel planes, to compare with",
    surface_keys({"direction", "roughing"}),
    {{"step_over", Kind::kLength, "this or `scallop`", "between planes", job::kPositive}},
    traits_of(true, true),
    check_planes,
    plan_parallel_planes};

}  // namespace cusp::adaptive_isocurve
