// Places to drill and lines to engrave: what a drawing holds beside closed loops.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/job/job/prismatic_keys.hpp"

namespace cusp::import {

// mm, both included.
struct DiameterRange {
    double least;
    double greatest;
};

// POINTs, and circles whose diameters lie in the range, in the order of the drawing; a place drawn
// twice counts once.
//
// name         of a drawing; may end in #layer
// only_circles points are left out
// notes        gets sentences on curves that are no circles, and those of the reader
//
// Errors: InputError where there is none, with the diameters that there are; as read_dxf_paths().
std::vector<job::Hole> read_holes(const std::string& name,
                                  double millimetres,
                                  DiameterRange range,
                                  bool only_circles,
                                  std::vector<std::string>& notes);

// The circle that the curves of a closed loop make; nothing where they make none.
std::optional<job::Hole> circle_of_loop(const job::Chain& loop);

// The curves of a drawing, or of a JSON file.
//
// name   of a drawing; may end in #layer
// notes  as of read_dxf_paths()
//
// Errors: InputError as read_dxf_paths().
std::vector<nurbs::Curve> read_curves(const std::string& name,
                                      double millimetres,
                                      std::vector<std::string>* notes);

// Curves in chains, as read_chains() makes them.
//
// name  of their drawing, for the note
std::vector<job::Chain> chains_of(const std::string& name,
                                  const std::vector<nurbs::Curve>& curves,
                                  std::vector<std::string>& notes);

// The curves of a drawing, or of a JSON file, in chains: ends no farther apart than 1e-3 mm meet.
//
// notes  gets a sentence on curves that are drawn twice, and those of the reader
//
// Errors: InputError as read_dxf_paths().
std::vector<job::Chain> read_chains(const std::string& name,
                                    double millimetres,
                                    std::vector<std::string>& notes);

}  // namespace cusp::import
