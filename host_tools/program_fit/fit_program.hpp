// A program of short lines becomes one of arcs and lines within a tolerance; all else stays as it
// is.
//
// Runs of G1 lines with nothing but N, X, Y, Z and an unchanged F are fitted by firmware/segmenter;
// every other line is copied as it stands and ends the run. The program that results is read again
// by the controller's own interpreter and compared with the lines it replaces.
#pragma once

#include <cstdint>
#include <functional>
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

}  // namespace cusp::program_fit
