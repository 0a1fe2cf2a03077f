// PartFiles: a cache of the parts of a job; each file is read once.
#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "host_tools/import/file_loops.hpp"
#include "host_tools/import/import.hpp"

namespace cusp::import {

using Triangles = std::vector<std::array<Vec3d, 3>>;

// Errors, here and below: InputError, as `read_surfaces`, `read_mesh` and `read_loops` throw it.
//
// millimetres  of one unit of a file that names no unit: 1 or 25.4; equal in all calls
class PartFiles {
public:
    // mesh_tolerance  mm: as in `read_surfaces`
    const std::vector<nurbs::Surface>& surfaces(const std::string& file,
                                                double millimetres,
                                                double mesh_tolerance);
    const Triangles& mesh(const std::string& file, double millimetres);
    // join  mm: as in `read_loops`
    const std::vector<FileLoop>& loops(const std::string& file, double millimetres, double join);

    // Sentences on what the readers left out or changed so far.
    const std::vector<std::string>& notes() const { return notes_; }

private:
    // keys: file, tolerance
    std::map<std::pair<std::string, double>, std::vector<nurbs::Surface>> surfaces_;
    std::map<std::string, Triangles> meshes_;
    std::map<std::pair<std::string, double>, std::vector<FileLoop>> loops_;  // keys: file, join
    std::vector<std::string> notes_;
};

}  // namespace cusp::import
