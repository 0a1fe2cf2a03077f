// Selects the reader by the ending of the file.
#include "host_tools/job/import/mesh_file.hpp"

#include "host_tools/job/import/obj_facets.hpp"
#include "host_tools/job/import/path_ending.hpp"
#include "host_tools/job/import/stl_facets.hpp"
#include "host_tools/job/import/threemf_facets.hpp"

namespace cusp::import {

bool is_mesh_file(const std::string& file)
{
    const std::string ending = path_ending(file);
    return ending == ".stl" || ending == ".obj" || ending == ".3mf";
}

bool lacks_unit(const std::string& file)
{
    const std::string ending = path_ending(file);
    return ending == ".stl" || ending == ".obj" || ending == ".json";
}

Facets read_facets(const std::string& file, double millimetres, const Similarity& placed)
{
    const std::string ending = path_ending(file);
    Facets facets = ending == ".stl"   ? read_stl(file, millimetres)
                    : ending == ".obj" ? read_obj(file, millimetres)
                                       : read_threemf(file);
    for (auto& triangle : facets.triangles) {
        for (Vec3d& corner : triangle) {
            corner = placed.of(corner);
            check_corner(corner, [&] { return file; });
        }
    }
    check_facets(facets, file);
    return facets;
}

}  // namespace cusp::import
