// The lowest tip of each tool against its lengths.
#include "host_tools/cli/tool_reach.hpp"

#include <algorithm>
#include <map>

#include "host_tools/toolpath/toolpath_measure.hpp"

#include "fmt/format.h"

namespace cusp::cli {

using job::Job;
using job::ToolFacts;
using toolpath::PlannedOperation;
using toolpath::ToolMove;

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
        const bool too_long = facts.length && depth > *facts.length;
        if (too_long || (facts.flute_length && depth > *facts.flute_length)) {
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
