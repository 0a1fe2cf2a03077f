// The closed loops of a file, and the pockets that they bound.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/job/import/drawing.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/job/job/part_geometry.hpp"

namespace cusp::import {

// A closed loop, simple and counter-clockwise.
struct FileLoop {
    job::Loop loop;
    std::string name;  // the file; with the loop's number and place where the file holds several
    int parent{-1};    // index of the smallest loop around it; -1: none
    int depth{};       // number of loops around it
};

// Largest gap between ends of open chains of a drawing that is closed.
struct EndDistance {
    double least{};               // mm: join_limit() of the drawing may be larger
    std::optional<double> given;  // mm: by join_gaps, takes the place of both
};

// The loops of a drawing, and what is open.
struct FileShapes {
    std::vector<FileLoop> loops;       // the largest first
    std::vector<job::OpenChain> open;  // gaps are not measured again where the drawing is placed
};

// Loops and open chains of a drawing, or of some of its layers together.
//
// layers  their names; empty: what `name` says
//
// Errors: as read_loops(), but for open chains; a layer that there is not, with those that there are.
FileShapes read_shapes(const std::string& name,
                       const std::vector<std::string>& layers,
                       double millimetres,
                       EndDistance gaps,
                       std::vector<std::string>& notes);

// As the two others, of curves that stand in no file.
//
// name  of the drawing, for messages
FileShapes shapes_of(const std::string& name,
                     const DrawnPaths& drawn,
                     EndDistance gaps,
                     std::vector<std::string>& notes);
std::vector<FileLoop> loops_of(const std::string& name,
                               const DrawnPaths& drawn,
                               EndDistance gaps,
                               std::vector<std::string>& notes);

// All loops of a drawing, the largest first; one loop of a JSON file.
//
// name         a file; of a drawing FILE#LAYER selects a layer
// millimetres  of one unit of a file that names none
// notes        receives sentences on what was joined or left out
//
// Errors: InputError with the ends and the gap of an open chain; crossing loops; those of the
// readers of curves.
std::vector<FileLoop> read_loops(const std::string& name,
                                 double millimetres,
                                 EndDistance gaps,
                                 std::vector<std::string>& notes);

// Copies the operation for each pocket. A loop of even depth bounds a pocket; its children are the
// islands. Each of `more_islands` is added to the smallest pocket around it.
//
// Errors: InputError where there are several pockets and an island is in none.
std::vector<job::Operation> pockets_of(const job::Operation& operation,
                                       const std::vector<FileLoop>& loops,
                                       const std::vector<FileLoop>& more_islands);

}  // namespace cusp::import
