// One cache for each kind of geometry.
#include "host_tools/import/part_files.hpp"

#include "host_tools/import/path_ending.hpp"

namespace cusp::import {

using nurbs::Surface;

const std::vector<Surface>& PartFiles::surfaces(const std::string& file,
                                                double millimetres,
                                                double mesh_tolerance)
{
    // Only a mesh depends on the tolerance.
    const double tolerance = path_ending(file) == ".stl" ? mesh_tolerance : 0;
    const auto [found, is_new] = surfaces_.try_emplace({file, tolerance});
    if (is_new) {
        found->second = read_surfaces(file, millimetres, tolerance, &notes_);
    }
    return found->second;
}

const Triangles& PartFiles::mesh(const std::string& file, double millimetres)
{
    const auto [found, is_new] = meshes_.try_emplace(file);
    if (is_new) {
        found->second = read_mesh(file, millimetres, &notes_);
    }
    return found->second;
}

const std::vector<FileLoop>& PartFiles::loops(const std::string& file,
                                              double millimetres,
                                              double join)
{
    const auto [found, is_new] = loops_.try_emplace({file, join});
    if (is_new) {
        found->second = read_loops(file, millimetres, join, notes_);
    }
    return found->second;
}

}  // namespace cusp::import
