// Which shapes of a drawing a 2.5-D operation takes: those of some layers, outlines, holes, or open lines.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/import/job_table.hpp"
#include "host_tools/job/import/part_files.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::import {

// mm: circles and tools whose diameters differ by no more are of one size.
inline constexpr double kSameDiameter = 0.01;

// The keys `drawing_layers`, `loops` and `except_diameters` of an operation.
struct DrawingChoice {
    std::vector<std::string> layers;       // empty: as `boundary` says
    std::string loops;                     // "all", "outer", "inner", "open"
    std::vector<double> except_diameters;  // mm

    // True if none of the keys narrows what is drawn.
    bool takes_all() const
    {
        return layers.empty() && (loops.empty() || loops == "all") && except_diameters.empty();
    }
};

// Reads the three keys. Errors: InputError: open lines for another strategy than engrave.
DrawingChoice read_drawing_choice(JobTable& table, const job::Operation& operation);

// The loops without circles of these diameters (mm), nested anew.
std::vector<FileLoop> without_circles(const std::vector<FileLoop>& loops,
                                      const std::vector<double>& diameters);

// The loops of the drawing that the choice takes. `shapes` has those of its layers.
// A loop is outer if it is in no other one, else inner. Depths are counted among the loops taken, so the
// outermost of inner ones, the holes of parts, have depth 0; parents are those of the drawing.
std::vector<FileLoop> chosen_loops(const DrawingChoice& choice, const FileShapes& shapes);

// The circles among the chosen loops. Of inner loops those count that are holes of parts.
std::vector<job::Hole> chosen_circles(const DrawingChoice& choice, const FileShapes& shapes);

// The chains that a tool follows: all, or open ones. Ends in a chain are no farther apart than 1e-3 mm.
std::vector<job::Chain> chosen_chains(const DrawingChoice& choice, const FileShapes& shapes);

}  // namespace cusp::import
