// Selects the reader by the ending of the file.
#include "host_tools/job/import/mesh_file.hpp"

#include "host_tools/job/import/obj_facets.hpp"
#include "host_tools/job/import/path_ending.hpp"
#include "host_tools/job/import/relief_facets.hpp"
#include "host_tools/job/import/stl_facets.hpp"
#include "host_tools/job/import/threemf_facets.hpp"

namespace cusp::import {

bool is_mesh_file(const std::string& file)
{
    const std::string ending = path_ending(file);
    return ending == ".stl" || ending == ".obj" || ending == ".3mf" || is_picture_file(file);
}

bool lacks_unit(const std::string& file)
{
    const std::string ending = path_ending(file);
    return ending == ".stl" || ending == ".obj" || ending == ".json";
}

Facets read_facets(const std::string& file,
                   double millimetres,
                   const Similarity& placed,
                   const std::optional<ReliefSize>& relief)
{
    const std::string ending = path_ending(file);
    const bool picture = is_picture_file(file);
    if (picture && !relief) {
        throw InputError(file +
                         ": a picture is a relief once [placing] has its width and its heights "
                         "(--width, --heights)");
    }
    Facets facets = picture            ? read_relief(file, *relief)
                    : ending == ".stl" ? read_stl(file, millimetres)
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
