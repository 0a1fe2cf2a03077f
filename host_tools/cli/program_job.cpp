// A program says by its work offset which set-up it is for.
#include "host_tools/cli/program_job.hpp"

#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/job/import/import.hpp"
#include "host_tools/judge/verify/program_setup.hpp"

#include "CLI/CLI.hpp"
#include "fmt/format.h"

namespace cusp::cli {

using job::Job;

void add_after_option(CLI::App& command, std::vector<std::string>& after)
{
    command
        .add_option(
            "--after", after,
            "programs that were cut before, in other set-ups of the job: the stock is what they "
            "leave")
        ->type_name("PROGRAM");
}

Job job_for(const std::string& job_file,
            const std::string& program,
            const std::vector<std::string>& after)
{
    std::vector<Job> setups = import::read_setups(job_file, strategies::all());
    const auto first = setups.front().setup;
    Job job = verify::job_of_program(std::move(setups), program, after);
    if (job.setup) {
        fmt::print("{}\n", description_of(*job.setup));
        if (job.setup->name != first->name && after.empty()) {
            fmt::print("the stock is uncut: --after PROGRAM names what earlier set-ups have cut\n");
        }
    }
    return job;
}

}  // namespace cusp::cli
