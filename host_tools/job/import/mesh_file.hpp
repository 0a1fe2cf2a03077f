// Triangles from mesh files of any format.
#pragma once

#include <optional>
#include <string>

#include "host_tools/job/import/facets.hpp"
#include "host_tools/job/import/relief_size.hpp"
#include "host_tools/job/import/similarity.hpp"

namespace cusp::import {

// By its ending: .stl, .obj, .3mf, and .png, a relief.
bool is_mesh_file(const std::string& file);
// True if files of this ending name no unit: STL, OBJ, JSON.
bool lacks_unit(const std::string& file);

// millimetres  of one unit of the file, where it names none
// placed       where the file's part lies
// relief       of a picture: needed; of another file: none
//
// Errors: InputError with file, place, value and limit, as the readers of the formats throw it; no
// facet with an area; no width in x or y.
Facets read_facets(const std::string& file,
                   double millimetres,
                   const Similarity& placed = {},
                   const std::optional<ReliefSize>& relief = std::nullopt);

}  // namespace cusp::import
