// Plans a job and prints its program: plan_example JOB.toml > part.ngc
#include <cstdio>
#include <exception>
#include <string>

#include "host_tools/cam/plan/plan.hpp"
#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/job/import/import.hpp"

namespace {

class Shares : public cusp::plan::Watcher {
    void progress(const char* work, double share) override
    {
        std::fprintf(stderr, "%s %.0f %%\n", work, 100 * share);
    }
};

}  // namespace

int main(int argc, char** argv)
try {
    if (argc != 2) {
        return 2;
    }
    cusp::job::Job job = cusp::import::read_job(argv[1], cusp::strategies::all());
    Shares watcher;
    cusp::plan::PlanOptions options;
    options.title = argv[1];
    const cusp::plan::PlannedProgram program = cusp::plan::plan_job(job, options, watcher);
    std::fputs(program.gcode.c_str(), stdout);
    std::fputs(summary_text(program).c_str(), stderr);
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
