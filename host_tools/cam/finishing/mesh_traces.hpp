// Missing passes traced over a mesh from a place that lacks one.
#pragma once

#include <functional>
#include <optional>

#include "host_tools/cam/finishing/gouge_free_path.hpp"
#include "host_tools/cam/finishing/triangle_halves.hpp"

namespace cusp::finishing {

struct MeshPlace {
    Vec3d point;
    Vec3d normal;  // unit, of the side that the tool may touch; never downward
};

inline MeshPlace place_of(const FacetCell& cell) { return {cell.middle(), cell.normal}; }

// The tip that a place misses; none where it misses none.
using MissingTip = std::function<std::optional<Vec3d>(const MeshPlace&)>;
// The next place after one and its tip, one way (1) or the other (-1); none where the trace ends.
using NextPlace = std::function<std::optional<MeshPlace>(const MeshPlace&, Vec3d tip, double way)>;

// The missing tips both ways from a place, as far as tips are missing.
Points traced(const MeshPlace& from, const MissingTip& missing, const NextPlace& next);

// The longer of the traces along x and along y over the mesh.
//
// step  mm: stepover on level ground
Points longest_over_mesh(const MeshPlace& from,
                         const part_model::PartModel& model,
                         double step,
                         const MissingTip& missing);

std::optional<MeshPlace> place_on_mesh(const part_model::PartModel& model, Vec3d at);

// Unit, level along a wall.
Vec3d level_along(Vec3d normal);

}  // namespace cusp::finishing
