// One key a figure.
#include "host_tools/base/json_text/json_text.hpp"
#include "host_tools/controller/program_fit/program_fit.hpp"

#include "nlohmann/json.hpp"

namespace cusp::program_fit {

std::string statistics_json(const FitReport& report,
                            double tolerance,
                            std::optional<double> seconds)
{
    nlohmann::ordered_json stats{{"lines_read", report.lines_read},
                                 {"tolerance_mm", tolerance},
                                 {"moves_in", report.moves_in},
                                 {"moves_out", report.moves_out},
                                 {"lines", report.lines},
                                 {"arcs", report.arcs},
                                 {"rapids", report.rapids},
                                 {"max_deviation_mm", report.max_deviation_mm},
                                 {"max_vertex_deviation_mm", report.max_vertex_deviation_mm}};
    if (seconds) {
        stats["seconds"] = *seconds;
    }
    return json_text::written(stats, 1) + "\n";
}

}  // namespace cusp::program_fit
