// Selects the reader by the ending of the file, and describes how meshes are converted.
#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <optional>
#include <utility>

#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/job/import/cad_surfaces.hpp"
#include "host_tools/job/import/file_loops.hpp"
#include "host_tools/job/import/geometry_json.hpp"
#include "host_tools/job/import/height_field.hpp"
#include "host_tools/job/import/import.hpp"
#include "host_tools/job/import/loop_nesting.hpp"
#include "host_tools/job/import/mesh_file.hpp"
#include "host_tools/job/import/mesh_holes.hpp"
#include "host_tools/job/import/mesh_patches.hpp"
#include "host_tools/job/import/nurbs_validity.hpp"
#include "host_tools/job/import/path_ending.hpp"
#include "host_tools/job/job/job.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::Loop;
using nurbs::Surface;

std::string path_ending(const std::string& file)
{
    std::string ending = std::filesystem::path(file).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

namespace {

bool is_layered(const std::string& file)
{
    return is_drawing_file(file) || is_cad_file(file) || is_mesh_file(file);
}

}  // namespace

std::size_t layer_mark(const std::string& name)
{
    for (std::size_t at = name.find('#'); at != std::string::npos; at = name.find('#', at + 1)) {
        if (is_layered(name.substr(0, at))) {
            return at;
        }
    }
    return is_layered(name) ? std::string::npos : name.rfind('#');
}

namespace {

// Adds notes on degenerate facets and overhangs.
void describe(const std::string& file,
              const Facets& facets,
              double overhangs,
              std::vector<std::string>& notes)
{
    constexpr double kShown = 1e-3;
    if (!facets.note.empty()) {
        notes.push_back(fmt::format("{}: {}", file, facets.note));
    }
    if (facets.degenerate > 0) {
        notes.push_back(
            fmt::format("{}: {} without area left out", file, counted(facets.degenerate, "facet")));
    }
    if (overhangs > kShown) {
        notes.push_back(fmt::format(
            "{}: overhangs: {:.4g} mm2 of facets face down above the base; material below them "
            "can't be reached from above and remains",
            file, overhangs));
    }
}

void describe_patches(const std::string& file,
                      const MeshPatches& patches,
                      double tolerance,
                      std::vector<std::string>& notes)
{
    notes.push_back(fmt::format(
        "{}: its facets are covered by {}, nowhere below them and at most {:.3g} mm above "
        "them",
        file, counted(patches.surfaces.size(), "surface"), patches.lift));
    if (patches.loose_share > 0) {
        notes.push_back(fmt::format(
            "{}: on {:.1f} % of its curved parts the path is up to {:.3g} mm off the mesh instead "
            "of {:.3g} mm: cells of {:.3g} mm are not more accurate",
            file, 100 * patches.loose_share, patches.lift, tolerance, patches.cell));
    }
}

void describe_field(const std::string& file,
                    const HeightField& field,
                    double tolerance,
                    std::vector<std::string>& notes)
{
    constexpr double kShown = 1e-3;
    notes.push_back(fmt::format(
        "{}: its facets can't be grouped into surfaces (inconsistent orientation, facets above "
        "each other, or too many sharp edges): it is taken as one height field",
        file));
    if (field.open_share > kShown) {
        notes.push_back(fmt::format(
            "{}: no facets on {:.1f} % of its box; there the height is the mesh's lowest", file,
            100 * field.open_share));
    }
    if (field.loose_share > 0) {
        notes.push_back(fmt::format(
            "{}: on {:.1f} % of the mesh (steps, sharp edges) the path is up to {:.3g} mm above it "
            "instead of {:.3g} mm: a height field of {:.3g} mm cells is not more accurate",
            file, 100 * field.loose_share, field.lift, tolerance, field.cell));
    }
}

std::vector<Surface> mesh_surfaces(const std::string& file,
                                   const Facets& facets,
                                   double tolerance,
                                   std::vector<std::string>& notes)
{
    if (std::optional<MeshPatches> patches = mesh_patches(facets, tolerance)) {
        describe(file, facets, patches->overhang_area, notes);
        describe_patches(file, *patches, tolerance, notes);
        return std::move(patches->surfaces);
    }
    HeightField field = height_field(facets, tolerance);
    describe(file, facets, field.overhang_area, notes);
    describe_field(file, field, tolerance, notes);
    return {std::move(field.surface)};
}

}  // namespace

const char* drawing_format(const std::string& file)
{
    static constexpr std::array<std::pair<const char*, const char*>, 10> kFormats{
        {{".dxf", "DXF"},
         {".svg", "SVG"},
         {".gbr", "Gerber"},
         {".ger", "Gerber"},
         {".gtl", "Gerber"},
         {".gbl", "Gerber"},
         {".gko", "Gerber"},
         {".gm1", "Gerber"},
         {".drl", "Excellon"},
         {".xln", "Excellon"}}};
    const std::string ending = path_ending(file);
    for (const auto& [known, format] : kFormats) {
        if (ending == known) {
            return format;
        }
    }
    return nullptr;
}

bool is_drawing_file(const std::string& file) { return drawing_format(file) != nullptr; }

bool is_cad_file(const std::string& file)
{
    static constexpr std::array kEndings{".step", ".stp", ".iges", ".igs", ".brep", ".brp"};
    return std::find(kEndings.begin(), kEndings.end(), path_ending(file)) != kEndings.end();
}

std::vector<Surface> read_surfaces(const std::string& file,
                                   double millimetres,
                                   double mesh_tolerance,
                                   std::vector<std::string>* notes,
                                   const Similarity& placed,
                                   const std::optional<ReliefSize>& relief)
{
    if (is_cad_file(file)) {
        return read_cad_surfaces(file, placed, notes);
    }
    std::vector<Surface> surfaces;
    if (path_ending(file) == ".json") {
        surfaces = read_json_surfaces(file, millimetres);
        for (Surface& surface : surfaces) {
            for (Vec3d& point : surface.points) {
                point = placed.of(point);
            }
        }
    } else if (is_mesh_file(file)) {
        std::vector<std::string> unread;
        std::vector<std::string>& said = notes != nullptr ? *notes : unread;
        Facets facets = read_facets(file, millimetres, placed, relief);
        cover_holes(file, facets.triangles, said);
        surfaces = mesh_surfaces(file, facets, mesh_tolerance, said);
    } else {
        throw InputError(fmt::format("{}: surfaces are read from {}, not from \"{}\"", file,
                                     kPartEndings, path_ending(file)));
    }
    for (const Surface& surface : surfaces) {
        check_surface(surface, file);
    }
    return surfaces;
}

std::vector<std::array<Vec3d, 3>> read_mesh(const std::string& file,
                                            double millimetres,
                                            std::vector<std::string>* notes,
                                            const Similarity& placed,
                                            const std::optional<ReliefSize>& relief)
{
    Facets facets = read_facets(file, millimetres, placed, relief);
    if (notes != nullptr) {
        describe(file, facets, overhang_area(facets), *notes);
    }
    return std::move(facets.triangles);
}

Loop read_loop(const std::string& name, double millimetres)
{
    std::vector<std::string> unread;
    std::vector<FileLoop> loops = read_loops(name, millimetres, {0, kEndsMeet}, unread);
    if (loops.size() > 1) {
        throw InputError(fmt::format("{}: holds {} loops, one is needed", name, loops.size()));
    }
    return std::move(loops.front().loop);
}

}  // namespace cusp::import
