// Tool by tool, in the order of the program.
#include <algorithm>

#include "host_tools/judge/verify/deep_rapids.hpp"
#include "host_tools/judge/verify/earlier_programs.hpp"
#include "host_tools/judge/verify/engagement_trace.hpp"
#include "host_tools/judge/verify/stock_grid.hpp"
#include "host_tools/judge/verify/tool_contact.hpp"
#include "host_tools/judge/verify/uncut_stock.hpp"
#include "host_tools/judge/verify/verify_stages.hpp"

namespace cusp::verify {

using job::Job;

namespace {

void add_contacts(const Job& job,
                  const ToolPositions& run,
                  const std::vector<BodyContact>& found,
                  std::vector<ContactFigures>& figures)
{
    for (const BodyContact& contact : found) {
        const auto known = std::find_if(figures.begin(), figures.end(),
                                        [&](const auto& f) { return f.part == contact.part; });
        ContactFigures& worst =
            known != figures.end() ? *known : figures.emplace_back(ContactFigures{contact.part});
        if (contact.depth > worst.depth) {
            worst = {contact.part,
                     contact.depth,
                     run.tips[contact.position],
                     run.lines[contact.position],
                     run.tool.number,
                     long_enough(job, run.tool, contact)};
        }
    }
}

void look_at_rapids(Verifying& work)
{
    const PartBox box = stock_box(work.job, part_box(work.scene.surfaces, work.scene.mesh));
    VerifyFigures& figures = work.result.figures;
    for (const RapidOfRun& rapid :
         deep_rapids(work.job, work.runs, work.spacing, box, RapidCut::kAlong)) {
        if (rapid.depth > figures.rapid_cut_max) {
            figures.rapid_cut_max = rapid.depth;
            figures.rapid_cut_at = {rapid.tip, rapid.line, work.runs[rapid.run].tool.number};
        }
    }
}

}  // namespace

void cut_program(Verifying& work)
{
    const Job& job = work.job;
    Verification& result = work.result;
    MachinedStock& stock = work.stock.emplace(UncutStock{job}.on(result.grid));
    work.removed_before = cut_earlier_programs(job, work.spacing, stock);
    work.before.emplace(result.grid, stock.heights());
    VerifyFigures& figures = result.figures;
    for (const ToolPositions& run : work.runs) {
        figures.tool_positions += run.tips.size();
    }
    std::size_t done = 0;
    for (const ToolPositions& run : work.runs) {
        std::optional<EngagementTrace> trace;
        if (work.settings.engagement) {
            trace.emplace(result.grid, run);
        }
        ContactTrace contact{result.grid, run, tool_discs(job, run.tool, kProgramSlack),
                             stock_around(job, result.grid)};
        const double cut_depth = stock.cut(
            run, work.spacing,
            [&](double share) {
                work.progress(
                    (static_cast<double>(done) + share * static_cast<double>(run.tips.size())) /
                    static_cast<double>(figures.tool_positions));
            },
            trace ? &*trace : nullptr, contact.is_idle() ? nullptr : &contact);
        add_contacts(job, run, contact.finish(), figures.contacts);
        if (trace) {
            result.engagement.push_back(trace->finish());
        }
        done += run.tips.size();
        figures.cut_depth_max = std::max(figures.cut_depth_max, cut_depth);
        if (cut_depth > 0) {
            double& of_tool = figures_of(run.tool, figures).cut_depth_max;
            of_tool = std::max(of_tool, cut_depth);
        }
    }
    look_at_rapids(work);
}

}  // namespace cusp::verify
