// The closed loops of a file as a job takes them, and the pockets that they bound.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/job.hpp"

namespace cusp::import {

// A closed loop, simple and counter-clockwise.
struct FileLoop {
    job::Loop loop;
    std::string name;  // the file; with the loop's number and place where the file holds several
    int parent{-1};    // the smallest loop around it, by its place in the list
    int depth{};       // loops around it
};

// All loops of a drawing, the largest first; one loop of a JSON file.
//
// name         of a drawing may end in #layer
// millimetres  of one unit of a file that names none
// join         mm: ends of open chains up to so far apart are joined
// notes        gets sentences on what was joined or left out
//
// Errors: InputError with the ends and the gap of what is open; crossings; as the readers of curves.
std::vector<FileLoop> read_loops(const std::string& name,
                                 double millimetres,
                                 double join,
                                 std::vector<std::string>& notes);

// The operation once for each pocket: loops of even depth bound one, the loops right inside it are
// its islands. `more_islands` goes to the smallest pocket around each.
//
// Errors: InputError where one of several pockets has to hold an island and none does.
std::vector<job::Operation> pockets_of(const job::Operation& operation,
                                       const std::vector<FileLoop>& loops,
                                       const std::vector<FileLoop>& more_islands);

}  // namespace cusp::import
