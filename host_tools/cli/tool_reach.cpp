// The lowest tip of each tool against its lengths; contacts of what is no cutter.
#include "host_tools/cli/tool_reach.hpp"

#include <algorithm>
#include <map>

#include "host_tools/base/cancellation/cancellation.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cli/share_progress.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "host_tools/judge/verify/path_contact.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::cli {

using job::Job;
using job::ToolFacts;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::ToolMove;
using verify::BodyPart;
using verify::path_contacts;
using verify::PathContact;

namespace {

// Such a shank is judged by its contacts.
bool has_wide_shank(const Job& job, int number)
{
    const ToolFacts& facts = job.tool_facts.at(number);
    return std::any_of(job.tools.begin(), job.tools.end(), [&](const toolpath::Tool& tool) {
        return tool.number == number && facts.shank_diameter &&
               *facts.shank_diameter / 2 > tool.radius;
    });
}

const char* noun_of(MoveKind kind)
{
    return kind == MoveKind::kRapid    ? "a rapid move"
           : kind == MoveKind::kPlunge ? "a plunge"
           : kind == MoveKind::kLink   ? "a link"
                                       : "a cut";
}

std::string sentence_on(const Job& job, const PlannedOperation& operation, const PathContact& c)
{
    const int number = operation.path.tool.number;
    const ToolFacts& facts = job.tool_facts.at(number);
    const std::string name = facts.name.empty() ? "" : " (" + facts.name + ")";
    const std::string place = fmt::format(
        "operation {}, {}: {} of tool {}{} at x {:.3f} y {:.3f} z {:.3f} mm", operation.operation,
        operation.stats.strategy, noun_of(c.move), number, name, c.tip.x, c.tip.y, c.tip.z);
    if (c.part == BodyPart::kBeyondFlutes) {
        return fmt::format(
            "{}: the axial depth of cut is {:.4g} mm, the flutes (flute_length) are {:g} mm long",
            place, *facts.flute_length + c.depth, *facts.flute_length);
    }
    const bool holder = c.part == BodyPart::kHolder;
    return fmt::format(
        "{}: the {} would be {:.4g} mm too deep in stock, {:g} mm of clearance "
        "(holder_clearance) included: {} of {:.2f} mm in place of {:g} would do",
        place, holder ? "holder" : "shank", c.depth, facts.holder_clearance,
        holder ? "a tool length (length)" : "flutes (flute_length)", c.long_enough,
        holder ? *facts.length : *facts.flute_length);
}

}  // namespace

void refuse_contacts(const Job& job, const Plan& plan)
{
    constexpr double kQuiet = 1.0;  // s
    cancellation::set_work("checking shanks and holders");
    const ShareProgress progress{"shanks and holders", kQuiet};
    std::map<std::pair<int, BodyPart>, PathContact> worst;  // by the number of the tool
    for (const PathContact& contact : path_contacts(job, paths_of(plan), progress)) {
        const int tool = plan.operations[contact.path].path.tool.number;
        const auto [known, is_new] = worst.try_emplace({tool, contact.part}, contact);
        if (!is_new && contact.depth > known->second.depth) {
            known->second = contact;
        }
    }
    if (worst.empty()) {
        return;
    }
    std::vector<std::string> sentences;
    for (const auto& [key, contact] : worst) {
        sentences.push_back(sentence_on(job, plan.operations[contact.path], contact));
    }
    throw InputError(fmt::format("{}: {}", job.file, fmt::join(sentences, "; ")));
}

std::vector<std::string> reach_warnings(const Job& job, const Plan& plan)
{
    std::map<int, double> lowest;  // z of the tip, by the number of the tool
    for (const PlannedOperation& operation : plan.operations) {
        double& z = lowest.try_emplace(operation.path.tool.number, job.stock_top).first->second;
        for (const ToolMove& move : operation.path.moves) {
            z = std::min(z, end_of(move).z);
        }
    }
    std::vector<std::string> warnings;
    for (const auto& [number, z] : lowest) {
        const auto found = job.tool_facts.find(number);
        if (found == job.tool_facts.end()) {
            continue;
        }
        const ToolFacts& facts = found->second;
        const double depth = job.stock_top - z;
        const bool too_long = facts.holder.empty() && facts.length && depth > *facts.length;
        if (too_long ||
            (!has_wide_shank(job, number) && facts.flute_length && depth > *facts.flute_length)) {
            warnings.push_back(
                fmt::format("tool {}{} goes {:.3g} mm below the stock's top, {} {:.3g} mm long: {}",
                            number, facts.name.empty() ? "" : " (" + facts.name + ")", depth,
                            too_long ? "it is" : "its flutes are",
                            too_long ? *facts.length : *facts.flute_length,
                            too_long ? "its holder may touch" : "its shank may rub"));
        }
    }
    return warnings;
}

}  // namespace cusp::cli
