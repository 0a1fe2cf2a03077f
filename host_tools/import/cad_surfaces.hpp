// Faces of STEP and IGES models as trimmed NURBS surfaces, by Open CASCADE.
//
// Open CASCADE is loaded when the first such file is read: linking it would add 25 ms to the start
// of every command. The module that knows it, libcusp_cad.so, is built where it is installed.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::import {

// The unit is the file's own; the result is in mm. Analytic faces become rational B-splines,
// exactly; their edges' curves in (u, v) are Open CASCADE's. Faces of solids that look nowhere up
// are left out: no tool from above reaches them, and what covers them is in the model. Loose faces
// that close a volume count as a solid.
//
// Errors: InputError with the file and the reason: no such file, no STEP or IGES, no face that
// looks up, trims that contradict each other, no libcusp_cad.so.
std::vector<nurbs::Surface> read_cad_surfaces(const std::string& file);

// A model's faces, with what the file says of them.
struct CadModel {
    std::string unit;      // of the file, as it names it
    std::size_t solids{};  // volumes that faces close
    std::size_t unread{};  // faces of solids that look nowhere up and have broken edges
    std::vector<nurbs::Surface> faces;  // all others, in mm
    std::vector<double> outwards;  // of each: +1 where du x dv points out of its solid, -1 where
                                   // in; 0: it belongs to none
};

// As read_cad_surfaces(), but faces of solids that look nowhere up are kept.
CadModel read_cad_model(const std::string& file);

}  // namespace cusp::import

// The door of libcusp_cad.so. Its other calls are answered by the program that loads it.
//
// all_faces  those of solids that look nowhere up, too
extern "C" void cusp_read_cad_model(const std::string& file,
                                    bool all_faces,
                                    cusp::import::CadModel& model);
