// The lowest tip of each tool against its lengths; contacts of what is no cutter.
#include <algorithm>
#include <map>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/plan/stages.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "host_tools/judge/verify/path_contact.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::plan {

using job::Job;
using job::ToolFacts;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using verify::BodyPart;
using verify::path_contacts;
using verify::PathContact;

namespace {

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

void prove_reach(Planning& planning)
{
    const Job& job = planning.job;
    const PlannedProgram& program = planning.program;
    planning.begin("checking shanks and holders");
    std::map<std::pair<int, BodyPart>, PathContact> worst;  // by the number of the tool
    for (const PathContact& contact :
         path_contacts(job, paths_of(program), planning.reports("shanks and holders"))) {
        const int tool = program.operations[contact.path].path.tool.number;
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
        sentences.push_back(sentence_on(job, program.operations[contact.path], contact));
    }
    throw InputError(fmt::format("{}: {}", job.file, fmt::join(sentences, "; ")));
}

}  // namespace cusp::plan
