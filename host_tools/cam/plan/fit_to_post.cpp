// Words first, then decimals.
#include <algorithm>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/plan/stages.hpp"
#include "host_tools/geometry/toolpath/post.hpp"

#include "fmt/format.h"

namespace cusp::plan {

using job::Job;
using job::Operation;
using job::OutputForm;
using toolpath::added_rounding;
using toolpath::Coolant;
using toolpath::last_decimal_of;
using toolpath::Post;
using toolpath::Tool;

namespace {

constexpr int kFirstOffset = 54;  // G54, which a post without the field may write

void check_coolant(const Job& job, const Operation& operation, const Tool& tool)
{
    const bool mist = tool.coolant == Coolant::kMist;
    const bool asked = tool.coolant != Coolant::kOff;
    if (asked && (mist ? job.post.mist : job.post.flood).empty()) {
        throw InputError(fmt::format(
            "{}: operation {}: coolant = \"{}\" of tool {}, but the post \"{}\" has no word for it",
            job.file, operation.number, mist ? "mist" : "flood", tool.number, job.post.name));
    }
}

// Throws InputError if the post has no words for what the job asks: NURBS, coolant, `blend`.
void check_words(const Job& job, double blend)
{
    const Post& post = job.post;
    if (blend > 0 && post.blend.empty()) {
        throw InputError(
            fmt::format("--blend {:g}: the post \"{}\" has no word for the tolerance of corners",
                        blend, post.name));
    }
    for (const Operation& operation : job.operations) {
        if (operation.output == OutputForm::kNurbs && !post.nurbs) {
            throw InputError(fmt::format(
                "{}: operation {}: output = \"nurbs\", but the post \"{}\" has no G6.2: say "
                "\"arcs\" or \"lines\"",
                job.file, operation.number, post.name));
        }
        if (operation.output == OutputForm::kArcs && post.arcs == toolpath::ArcForm::kNone) {
            throw InputError(
                fmt::format("{}: operation {}: output = \"arcs\", but the post \"{}\" has no G2 "
                            "and G3: say \"lines\"",
                            job.file, operation.number, post.name));
        }
        check_coolant(job, operation, operation.tool);
        for (const Tool& tool : operation.tools) {
            check_coolant(job, operation, tool);
        }
    }
}

// mm: paths over a level floor lie half of this above it, and half of the last decimal higher at most: both together
// are the tolerance that verify() holds them to, however few the decimals.
double level_floor_tolerance(const Job& job, const Operation& operation)
{
    constexpr double kLeast = 5e-4;  // mm
    const double floor = operation.tolerance.floor;
    return std::clamp(2 * floor - last_decimal_of(job.post, job.inch), kLeast, floor);
}

// Takes what the post's rounding adds off the tolerances, so that the written path holds them. Throws InputError if
// a tolerance is too small for that.
void leave_room_for_rounding(Job& job)
{
    const double added = added_rounding(job.post, job.inch);
    if (!(added > 0)) {
        return;
    }
    const auto reduce = [&](const Operation& operation, const char* key, double& value, double by) {
        const double least = by + added;
        if (!(value >= least)) {
            throw InputError(fmt::format(
                "{}: operation {}: {} is {:g} mm, but the post \"{}\" rounds to {} decimals and "
                "needs {:.4f} mm at least",
                job.file, operation.number, key, value, job.post.name, job.post.decimals(job.inch),
                least));
        }
        value -= by;
    };
    for (Operation& operation : job.operations) {
        const bool is_level = operation.tolerance.default_floor;
        if (is_level) {
            operation.tolerance.floor = level_floor_tolerance(job, operation);
        }
        if (operation.tolerance.default_scallop) {
            operation.tolerance.scallop =
                std::max(*operation.tolerance.scallop, 2 * (operation.tolerance.floor + added));
        }
        if (!is_level) {
            // twice: half of a floor tolerance has been spent on the height field of a mesh
            reduce(operation, "floor_tolerance", operation.tolerance.floor, 2 * added);
        }
        reduce(operation, "plan_tolerance", operation.tolerance.plan, added);
        if (operation.tolerance.scallop) {
            reduce(operation, "scallop", *operation.tolerance.scallop, added);
        }
    }
}

}  // namespace

// A post of one's own may have no field for it.
void check_offset(const Job& job)
{
    const auto has_field = [](const std::string& line) {
        return line.find("{offset}") != std::string::npos;
    };
    if (job.setup && job.setup->offset != kFirstOffset &&
        std::none_of(job.post.modes.begin(), job.post.modes.end(), has_field)) {
        throw InputError(
            fmt::format("{}: the set-up \"{}\" has the offset G{}, but the post \"{}\" has no "
                        "{{offset}} in its modes",
                        job.file, job.setup->name, job.setup->offset, job.post.name));
    }
}

void fit_to_post(Planning& planning)
{
    check_words(planning.job, planning.options.blend);
    leave_room_for_rounding(planning.job);
}

}  // namespace cusp::plan
