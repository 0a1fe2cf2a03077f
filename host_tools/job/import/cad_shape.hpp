// A CAD file as Open CASCADE reads it. Only libcusp_cad.so includes this header.
#pragma once

#include <cstdint>
#include <string>

#include "opencascade/TopoDS_Shape.hxx"

namespace cusp::import {

// kGentle: the default repairs of Open CASCADE, but wires are not reversed.
enum class Repairs : std::uint8_t { kGentle, kAll };

struct ReadShape {
    TopoDS_Shape shape;
    std::string unit;  // of length, as the file names it
};

// Errors: InputError with the file: it can't be read, is no STEP, IGES or BREP, holds no shape, or has
// faults that crash Open CASCADE.
ReadShape read_shape(const std::string& file, Repairs repairs);

}  // namespace cusp::import
