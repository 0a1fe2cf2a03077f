// The records of isocurves and planes.
#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/cam/adaptive_isocurve/parallel_planes.hpp"
#include "host_tools/job/job/operation_check.hpp"
#include "host_tools/job/job/operation_keys.hpp"

namespace cusp::adaptive_isocurve {

using job::choice;
using job::KeyValues;
using job::Operation;
using job::Refuse;
using job::surface_keys;
using job::Traits;
using Kind = job::KeyKind;

namespace {

// Planes have no distance along isocurves.
std::any read(const KeyValues& values, const Operation& /*operation*/, const Refuse& /*refuse*/)
{
    IsocurveKeys keys;
    keys.iso_distance = values.number("iso_distance");
    keys.even_steps = values.find<std::string>("iso_spacing") == "even";
    keys.direction = values.get<std::string>("direction").front();
    return keys;
}

void check_isocurves(const Operation& operation, const Refuse& refuse)
{
    check_end(operation, refuse);
    need(isocurve_keys(operation).iso_distance || operation.tolerance.scallop, "iso_distance",
         "it or scallop", operation, refuse);
    check_adaptive_roughing(operation, refuse);
}

void check_planes(const Operation& operation, const Refuse& refuse)
{
    check_end(operation, refuse);
    need(operation.passes.step_over || operation.tolerance.scallop, "step_over", "it or scallop",
         operation, refuse);
    check_adaptive_roughing(operation, refuse);
}

const job::Key kDistance{"iso_distance", Kind::kLength, "this or `scallop`",
                         "neighbours are at most this far apart (the paper's delta)",
                         job::kPositive};
const job::Key kSpacing = choice("iso_spacing",
                                 {"halving", "even"},
                                 "with `iso_distance`: the paper's rule, or `\"even\"`: full steps "
                                 "that follow their neighbours, shorter under the same test");
const job::Key kDirection =
    choice("direction", {"u", "v"}, "passes run along u or v; of planes along x or y");

Traits traits_of(bool takes_mesh, bool only_finishes)
{
    Traits traits;
    traits.one_line = takes_mesh;
    traits.takes_mesh = takes_mesh;
    traits.only_finishes = only_finishes;
    return traits;
}

}  // namespace

const job::Strategy kAdaptiveIsocurve{
    "adaptive_isocurve",
    "finishes a part along isocurves, denser where the scallop asks for it; roughs first if wanted",
    surface_keys({"roughing", "tools"}),
    {kDistance, kSpacing, kDirection},
    traits_of(true, false),
    read,
    check_isocurves,
    plan_adaptive_isocurve};

const job::Strategy kCompleteIsocurves{"complete_isocurves",
                                       "finishes a part along whole isocurves, to compare with",
                                       surface_keys({"roughing", "tools"}),
                                       {kDistance, kDirection},
                                       traits_of(false, false),
                                       read,
                                       check_isocurves,
                                       plan_complete_isocurves};

const job::Strategy kParallelPlanes{
    "parallel_planes",
    "finishes a part along parallel planes, to compare with",
    surface_keys({"roughing"}),
    {{"step_over", Kind::kLength, "this or `scallop`", "between planes", job::kPositive},
     kDirection},
    traits_of(true, true),
    read,
    check_planes,
    plan_parallel_planes};

}  // namespace cusp::adaptive_isocurve
