// Feeds and speeds of a tool in a job.
#include "host_tools/job/job/job.hpp"

namespace cusp::job {

using toolpath::CuttingRates;
using toolpath::Tool;
using toolpath::Toolpath;

CuttingRates rates_of(const Job& job, const Tool& tool)
{
    return {tool.rates.feed > 0 ? tool.rates.feed : job.feed,
            tool.rates.plunge_feed > 0 ? tool.rates.plunge_feed : job.plunge_feed,
            tool.rates.spindle.value_or(job.spindle)};
}

void set_tool(Toolpath& path, const Job& job, const Tool& tool)
{
    const CuttingRates rates = rates_of(job, tool);
    path.tool = tool;
    path.feed = rates.feed;
    path.plunge_feed = rates.plunge_feed;
    path.spindle = *rates.spindle;
    if (const auto facts = job.tool_facts.find(tool.number); facts != job.tool_facts.end()) {
        path.tool_name = facts->second.name;
    }
}

}  // namespace cusp::job
