// Replaces the short lines of a program by arcs and lines within a tolerance, and keeps the rest of
// its text. The front door of `program_fit`.
//
//     const FittedProgram fitted = fit_program(files::text_of_file("part.ngc"), "part.ngc", 0.01);
//     files::write_text("part-arcs.ngc", fitted.text);
//     fitted.report.max_deviation_mm;  // measured, not estimated
//
// Runs of G1 lines with nothing but N, X, Y, Z and an unchanged F are fitted by firmware/segmenter;
// every other line is copied unchanged and ends the run. The controller's own interpreter reads the
// result again, and it is compared with the lines that it replaces.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace cusp::program_fit {

struct FitReport {
    std::uint64_t lines_read{};  // of text
    std::uint64_t moves_in{};    // feed moves of the program
    std::uint64_t moves_out{};
    std::uint64_t lines{};      // straight feed moves written
    std::uint64_t arcs{};       // arcs written
    std::uint64_t rapids{};     // both read and written
    double max_deviation_mm{};  // of vertices and middles of lines, from what replaces them
    double max_vertex_deviation_mm{};
};

struct FittedProgram {
    std::string text;
    FitReport report;
};

// Fits a program.
//
//   name       of the file, for messages
//   tolerance  of vertices, mm, > 0; between vertices a tenth more
//   progress   called now and then with the part done, 0 to 1; may be empty
//
// Errors: InputError with file and line where the controller would refuse the program.
FittedProgram fit_program(std::string_view program,
                          const std::string& name,
                          double tolerance,
                          const std::function<void(double)>& progress = {});

// The figures of a fit as JSON, docs/stats.md; with "seconds" where the time is known.
std::string statistics_json(const FitReport& report,
                            double tolerance,
                            std::optional<double> seconds = {});

}  // namespace cusp::program_fit
