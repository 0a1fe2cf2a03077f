// The program's text and its times on the controller.
#include <memory>
#include <sstream>

#include "firmware/base/inch.hpp"
#include "host_tools/cam/plan/stages.hpp"
#include "host_tools/controller/simulate/simulated_times.hpp"
#include "host_tools/geometry/toolpath/gcode_writer.hpp"
#include "host_tools/geometry/toolpath/post.hpp"
#include "host_tools/judge/verify/between_sides.hpp"
#include "host_tools/judge/verify/path_air.hpp"

namespace cusp::plan {

using job::Job;
using toolpath::PathMeasure;
using toolpath::ProgramForm;

void write_gcode(Planning& planning)
{
    if (planning.is_written) {
        return;
    }
    Job& job = planning.job;
    const PlanOptions& options = planning.options;
    ProgramForm form{"cusp " CUSP_VERSION ", " + options.title,
                     job.inch,
                     job.stock_top + job.clearance,
                     {},
                     job.post};
    if (job.setup) {
        form.work_offset = job.setup->offset;
    }
    if (options.blend > 0) {
        form.blend_tolerance = options.blend * (job.inch ? kMillimetresPerInch : 1.0);
    }
    std::ostringstream lines;
    planning.begins = write_program(lines, form, planning.program.operations);
    planning.program.gcode = lines.str();
    planning.is_written = true;
    planning.is_timed = false;
}

// A day of machine time takes a minute to simulate: very long programs keep the estimates.
void put_times(Planning& planning)
{
    constexpr double kLongest = 12 * 3600;  // s
    if (planning.is_timed) {
        return;
    }
    planning.is_timed = true;
    PlannedProgram& program = planning.program;
    double measured = 0;
    for (const PathMeasure& measure : program.measures) {
        measured += measure.estimated_s;
    }
    if (measured > kLongest || !planning.options.runs_program) {
        return;
    }
    planning.begin("timing the program");
    program.shares.clear();
    if (const auto times =
            simulate::simulated_times(program.gcode, planning.begins, planning.reports("timing"),
                                      simulate::kUsualPart, planning.settings)) {
        for (std::size_t i = 0; i < program.measures.size(); ++i) {
            const auto& [seconds, rapid] = (*times)[i];
            const double air = planning.air[i] * (seconds - rapid);
            program.measures[i].estimated_s = seconds;
            program.shares.push_back({seconds - rapid - air, air, rapid});
        }
    }
}

void find_air(Planning& planning)
{
    planning.begin("looking for moves in air");
    planning.air = verify::air_shares(planning.job, paths_of(planning.program));
}

void warn_of_thin_floors(Planning& planning)
{
    Job& job = planning.job;
    if (!job.setup) {
        return;
    }
    const std::string& name = planning.options.name;
    job.programs[name] = std::make_shared<const std::string>(planning.program.gcode);
    planning.begin("looking for breaks into the other side in " + name);
    const auto floor = verify::floor_between_sides(job, name);
    if (floor && verify::is_too_thin(job, *floor)) {
        planning.program.warnings.push_back(verify::sentence_of(job, *floor));
    }
}

}  // namespace cusp::plan
