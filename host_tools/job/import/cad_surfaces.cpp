// Notes on what was mended; cad_module.cpp has Open CASCADE.
#include "host_tools/job/import/cad_surfaces.hpp"

#include <array>
#include <optional>
#include <utility>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/facets.hpp"
#include "host_tools/job/import/mesh_holes.hpp"
#include "host_tools/job/import/mesh_patches.hpp"

#include "fmt/format.h"

namespace cusp::import {

using nurbs::Surface;

namespace {

// Surfaces over the holes that the faces leave open above.
std::vector<Surface> hole_covers(const std::string& file,
                                 const CadModel& model,
                                 std::vector<std::string>& notes)
{
    constexpr double kOff = 1e-3;  // mm
    Facets covers;
    for (std::array<Vec3d, 3> t : covers_of_holes(file, "faces", model.triangles, notes)) {
        if (cross(t[1] - t[0], t[2] - t[0]).z < 0) {
            std::swap(t[1], t[2]);
        }
        add_facet(t, covers);
    }
    if (covers.triangles.empty()) {
        return {};
    }
    std::optional<MeshPatches> patches = mesh_patches(covers, kOff);
    if (!patches) {
        throw InputError(file +
                         ": faces are missing, and what they leave open above can't be closed");
    }
    return std::move(patches->surfaces);
}

}  // namespace

std::vector<Surface> read_cad_surfaces(const std::string& file,
                                       const Similarity& placed,
                                       std::vector<std::string>* notes)
{
    CadModel model = cad_model(file, placed, CadWanted::kUpward);
    std::vector<std::string> said = notes_of(model, file);
    for (Surface& cover : hole_covers(file, model, said)) {
        model.faces.push_back(std::move(cover));
    }
    if (notes != nullptr) {
        notes->insert(notes->end(), said.begin(), said.end());
    }
    return std::move(model.faces);
}

std::vector<std::string> notes_of(const CadModel& model, const std::string& file)
{
    std::vector<std::string> notes;
    const auto note = [&](const FaceFault& fault, const char* before, const char* after) {
        if (fault.faces > 0) {
            notes.push_back(fmt::format("{}: {} {} {} {:.3g} mm {}", file, fault.faces,
                                        fault.faces == 1 ? "face has" : "faces have", before,
                                        fault.most, after));
        }
    };
    note(model.points, "an edge that the file makes a point, but which is up to",
         "long; the faces end there as their surfaces do");
    note(model.gaps, "edges that miss each other at a vertex by up to",
         "within the file's own tolerance; joined");
    note(model.lobes, "edges that cross each other, with lobes up to",
         "wide, within the file's own tolerance; cut off");
    note(model.beside, "edges up to", "beside the surface, within the file's own tolerance");
    return notes;
}

namespace {

// Those that have an area.
std::vector<std::array<Vec3d, 3>> sound_triangles(
    const std::vector<std::array<Vec3d, 3>>& triangles)
{
    Facets facets;
    for (const auto& triangle : triangles) {
        add_facet(triangle, facets);
    }
    return std::move(facets.triangles);
}

}  // namespace

std::vector<std::array<Vec3d, 3>> read_cad_facets(const std::string& file, const Similarity& placed)
{
    return sound_triangles(cad_model(file, placed, CadWanted::kFacets).triangles);
}

CadModel read_whole_cad_model(const std::string& file)
{
    CadModel model = cad_model(file, {}, CadWanted::kEverything);
    model.triangles = sound_triangles(model.triangles);
    return model;
}

CadModel read_cad_model(const std::string& file)
{
    return cad_model(file, {}, CadWanted::kAllFaces);
}

}  // namespace cusp::import
