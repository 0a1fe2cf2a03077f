// Describes what a part file holds: unit, size, faces, loops, slopes, concave radii, faults. The front door of
// `part_info`; docs/stats.md explains each figure.
//
//     const PartInfo info = inspect_part(import::read_part_geometry("part.step", 1.0), 0.01);
//     fmt::print("{}", text_of(info));  // aligned lines
//     if (info.ball) { ... }            // the largest ball that reaches everything
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/job/job/part_geometry.hpp"
#include "host_tools/job/part_info/ball_reach.hpp"
#include "host_tools/job/part_info/ground.hpp"
#include "host_tools/job/part_info/mesh_health.hpp"
#include "host_tools/job/part_info/surface_places.hpp"

namespace cusp::part_info {

struct PartInfo {
    job::PartGeometry part;  // the lists of surfaces and triangles may be dropped
    std::size_t pieces{};    // number of surfaces or triangles
    std::optional<MeshHealth> mesh;
    std::optional<Ground> ground;
    std::optional<Hollow> hollow;  // of faces; no value: nothing is concave, or a mesh
    std::optional<BallReach> ball;

    bool is_drawing() const { return !part.layers.empty(); }
    bool is_mesh() const { return mesh.has_value(); }
};

// tolerance  mm, above 0: material that a ball may leave
//
// A drawing is reported as it is in the file, without inspection.
PartInfo inspect_part(job::PartGeometry part, double tolerance);

// Aligned lines, with a unit on every number.
std::string text_of(const PartInfo& info);

// {"files": [...]}: stable keys, in mm and degrees.
std::string json_of(const std::vector<PartInfo>& parts);

}  // namespace cusp::part_info
