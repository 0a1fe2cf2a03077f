// Broken edges of a part as drawings: FILE#edges:Z:Z:WIDTH of part_regions.hpp.
//
//   chamfer  goes along the loops that the ground rises beside all around
//   engrave  goes along the ways of a vee's tip beside the edges, wherever the tool can break them
#pragma once

#include <array>
#include <string>
#include <vector>

#include "host_tools/geometry/toolpath/tool.hpp"
#include "host_tools/job/import/file_loops.hpp"
#include "host_tools/job/job/prismatic_keys.hpp"

namespace cusp::import {

// True if the name is that of broken edges of a model or a mesh.
bool names_broken_edges(const std::string& name);

// Takes out the loops that the name does not want; their depths are those among all loops.
//
// facets  of the whole part, placed
//
// Errors: InputError: it wants none of them.
void keep_broken_edges(const std::string& name,
                       double millimetres,
                       const std::vector<std::array<Vec3d, 3>>& facets,
                       std::vector<FileLoop>& loops);

// The ways of the tip, as curves.
//
// tip  z, mm
//
// Errors: InputError: the tool is no vee or its flank is another one, the tip is at another height, it breaks none of the
// edges.
std::vector<job::Chain> edge_ways(const std::string& name,
                                  double millimetres,
                                  const std::vector<std::array<Vec3d, 3>>& facets,
                                  const toolpath::Tool& tool,
                                  double tip);

}  // namespace cusp::import
