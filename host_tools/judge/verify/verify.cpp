// A row of stages: each adds its figures to those of the stages before it.
#include "host_tools/judge/verify/verify.hpp"

#include "host_tools/judge/verify/between_sides.hpp"
#include "host_tools/judge/verify/cut_stock.hpp"
#include "host_tools/judge/verify/earlier_programs.hpp"
#include "host_tools/judge/verify/uncut_stock.hpp"
#include "host_tools/judge/verify/verdict.hpp"
#include "host_tools/judge/verify/verify_stages.hpp"

namespace cusp::verify {

namespace {

// Share of the floor that may be above the scallop bound: the corners between loops.
constexpr double kUncoveredAllowed = 0.01;

// The heights at which the stock is judged: all of it is cut.
void end_cutting(Verifying& work)
{
    work.progress(1.0);
    work.heights = heights_to_judge(work.job, *work.stock);
}

void judge_sides(Verifying& work)
{
    work.result.figures.between_sides =
        floor_between_sides(work.job, work.result.grid, work.stock->heights(), work.spacing);
}

void judge_bounds(Verifying& work)
{
    work.result.bounds = {work.scene.floor_tolerance, work.scene.plan_tolerance, kRapidCutAllowed,
                          kUncoveredAllowed};
    find_fault_places(work.runs, work.result);
    judge(work.job, work.scene.scallop, work.result);
}

constexpr void (*kStages[])(Verifying&){
    read_positions,         cut_program,   measure_engagement, end_cutting, judge_surfaces,
    judge_level_operations, judge_threads, judge_fixtures,     judge_sides, judge_bounds,
};

}  // namespace

Verification verify(const job::Job& job,
                    const std::string& program_file,
                    const VerifySettings& settings,
                    const Progress& progress)
{
    Verifying work{job, program_file, settings, progress};
    for (const auto stage : kStages) {
        stage(work);
    }
    if (settings.engagement) {
        work.result.positions = std::move(work.runs);
    }
    return std::move(work.result);
}

}  // namespace cusp::verify
