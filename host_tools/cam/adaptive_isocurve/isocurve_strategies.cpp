// The records of isocurves.
#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/job/job/finish_keys.hpp"
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

std::any read(const KeyValues& values, const Operation& /*operation*/, const Refuse& refuse)
{
    job::FinishKeys keys;
    keys.iso_distance = values.number("iso_distance");
    keys.even_steps = values.find<std::string>("iso_spacing") == "even";
    keys.direction = values.get<std::string>("direction").front();
    keys.range = read_range(values, refuse);
    return keys;
}

void check_isocurves(const Operation& operation, const Refuse& refuse)
{
    check_finishing_end(operation, refuse);
    need(finish_keys(operation).iso_distance || operation.tolerance.scallop, "iso_distance",
         "it or scallop", operation, refuse);
    check_adaptive_roughing(operation, refuse);
}

const job::Key kDistance{"iso_distance", Kind::kLength, "this or `scallop`",
                         "neighbours are at most this far apart (the paper's delta)",
                         job::kPositive};
const job::Key kSpacing = choice("iso_spacing",
                                 {"halving", "even"},
                                 "with `iso_distance`: the paper's rule, or `\"even\"`: full steps "
                                 "that follow their neighbours, shorter under the same test");
const job::Key kDirection = job::direction_key();

Traits traits_of(bool takes_mesh)
{
    Traits traits;
    traits.one_line = takes_mesh;
    traits.takes_mesh = takes_mesh;
    return traits;
}

}  // namespace

const job::Strategy kAdaptiveIsocurve{
    "adaptive_isocurve",
    "finishes a part along isocurves, denser where the scallop asks for it; roughs first if wanted",
    surface_keys({"roughing", "tools"}),
    job::with_ranges({kDistance, kSpacing, kDirection}),
    traits_of(true),
    read,
    check_isocurves,
    plan_adaptive_isocurve};

const job::Strategy kCompleteIsocurves{"complete_isocurves",
                                       "finishes a part along whole isocurves, to compare with",
                                       surface_keys({"roughing", "tools"}),
                                       job::with_ranges({kDistance, kDirection}),
                                       traits_of(false),
                                       read,
                                       check_isocurves,
                                       plan_complete_isocurves};

}  // namespace cusp::adaptive_isocurve
