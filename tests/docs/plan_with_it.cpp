// Plans a job and writes its program, by the files that docs/add_a_strategy.md makes and changes.
#include <cstdio>
#include <exception>
#include <fstream>

#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/geometry/toolpath/gcode_writer.hpp"
#include "host_tools/job/import/import.hpp"

int main(int count, char** arguments)
{
    if (count != 3) {
        std::fputs("usage: plan_with_it JOB.toml PROGRAM.ngc\n", stderr);
        return 2;
    }
    try {
        const cusp::job::Job job = cusp::import::read_job(arguments[1], cusp::strategies::all());
        std::vector<cusp::toolpath::PlannedOperation> planned;
        for (const cusp::job::Operation& operation : job.operations) {
            for (const auto& result : cusp::strategies::plan_operation(job, operation)) {
                std::printf("%s: gouge at most %.4f mm, %d points\n", result.stats.strategy.c_str(),
                            result.stats.gouge_bound_mm, result.stats.cl_points);
                planned.push_back(result);
            }
        }
        cusp::toolpath::ProgramForm form;
        form.title = "planned with a strategy of the page";
        form.clearance_z = job.stock_top + job.clearance;
        std::ofstream program{arguments[2]};
        cusp::toolpath::write_program(program, form, planned);
        return program.good() ? 0 : 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
}
