// cusp fit.
#include "host_tools/cam/engine/calls.hpp"
#include "host_tools/controller/program_fit/program_fit.hpp"

#include "fmt/format.h"

namespace cusp::engine {

Json fit_call(Call& call)
{
    constexpr double kLeast = 1e-4;  // mm
    constexpr double kMost = 10;
    const std::string program = call.arguments.text("program");
    const double tolerance = call.arguments.number("tolerance");
    call.arguments.check_all_read();
    if (tolerance < kLeast || tolerance > kMost) {
        throw InputError{fmt::format("fit: tolerance: is {:g}, it must be {:g} to {:g} mm",
                                     tolerance, kLeast, kMost),
                         {"", 0, "tolerance", fmt::format("{:g}", tolerance), "0.0001 to 10 mm"}};
    }
    program_fit::FittedProgram fitted =
        program_fit::fit_program(files::text_in_memory(program), program, tolerance,
                                 [&](double share) { call.report(share, "fitting"); });
    call.blocks.push_back({"gcode", std::move(fitted.text)});
    return {{"block", "gcode"}, {"stats", Json::parse(statistics_json(fitted.report, tolerance))}};
}

}  // namespace cusp::engine
