// Describes a part file: unit, size, faces, loops, slopes, concave radii, faults. The front door of
// `part_info`; docs/part_info.md explains each line.
//
//     const PartInfo info = inspect_part("part.step", {});
//     fmt::print("{}", text_of(info));  // aligned lines
//     if (info.ball) { ... }            // the largest ball that reaches everything
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/import/loop_nesting.hpp"
#include "host_tools/nurbs/nurbs.hpp"
#include "host_tools/part_info/ball_reach.hpp"
#include "host_tools/part_info/ground.hpp"
#include "host_tools/part_info/mesh_health.hpp"
#include "host_tools/part_info/surface_places.hpp"

namespace cusp::part_info {

struct InspectSettings {
    double millimetres{1};   // of one unit of files that name none: 1 or 25.4
    double tolerance{0.01};  // mm: material that a ball may leave
};

struct PartUnit {
    std::string name;      // "mm", "inch", or as the file has it
    double millimetres{};  // of one; 0: unknown (STEP and IGES are converted on reading)
    bool assumed{};        // the file names none
};

struct LayerInfo {
    std::string name;  // "" where the file has no layers
    bool hidden{};     // switched off or frozen: left out unless it is requested
    std::string problem;
    import::LoopNesting loops;
};

struct PartInfo {
    std::string file;    // as given, "#layer" included
    std::string format;  // as "STEP", "JSON surfaces"
    PartUnit unit;
    Vec3d box_low, box_high;  // mm

    // Drawings and curves.
    std::vector<LayerInfo> layers;

    // Surfaces and meshes. One of the first two is empty.
    std::vector<nurbs::Surface> surfaces;
    std::vector<std::array<Vec3d, 3>> triangles;
    std::size_t pieces{};        // number of surfaces or triangles, whose lists may be dropped
    std::size_t solids{};        // STEP and IGES
    std::size_t unread_faces{};  // that face down and have broken edges
    std::size_t degenerate{};    // facets without area
    std::optional<MeshHealth> mesh;
    std::optional<Ground> ground;
    std::optional<Hollow> hollow;  // of faces; no value: nothing is concave, or a mesh
    std::optional<BallReach> ball;

    bool is_drawing() const { return !layers.empty(); }
    bool is_mesh() const { return mesh.has_value(); }
};

// name  a file; of a drawing "#layer" may follow
//
// Errors: InputError with file, place and reason, as in host_tools/import: missing, empty or broken
// files, an unknown ending.
PartInfo inspect_part(const std::string& name, const InspectSettings& settings);

// Aligned lines, with a unit on every number.
std::string text_of(const PartInfo& info);

// {"files": [...]}: stable keys, in mm and degrees.
std::string json_of(const std::vector<PartInfo>& parts);

}  // namespace cusp::part_info
