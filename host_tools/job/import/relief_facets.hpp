// A picture as a relief: its greys are heights.
#pragma once

#include <string>

#include "host_tools/job/import/facets.hpp"
#include "host_tools/job/import/relief_size.hpp"

namespace cusp::import {

// By its ending: .png.
bool is_picture_file(const std::string& file);

// Two triangles between each four pixels: x to the right, y up, from 0. Greys of 8 and of 16 bits; colours by their
// brightness; transparent pixels as they are. A picture of over a million pixels is averaged in squares until it has no more,
// which `Facets::note` says.
//
// Errors: InputError with the file: no PNG, over 25 million pixels, less than two in a row or a column.
Facets read_relief(const std::string& file, const ReliefSize& size);

}  // namespace cusp::import
