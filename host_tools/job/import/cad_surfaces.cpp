// Loads libcusp_cad.so when the first CAD file is read.
#include "host_tools/job/import/cad_surfaces.hpp"

#include <array>
#include <dlfcn.h>
#include <filesystem>
#include <optional>
#include <utility>

#include "host_tools/base/files/file_set.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/facets.hpp"
#include "host_tools/job/import/mesh_holes.hpp"
#include "host_tools/job/import/mesh_patches.hpp"
#include "host_tools/job/import/turning_knots.hpp"

#include "fmt/format.h"

namespace cusp::import {

using nurbs::Surface;

namespace {

constexpr const char* kModule = "libcusp_cad.so";

// Searches the folder of this code, the build folder, the installation folder and (tests) RUNPATH. Null: not found, with the
// reason in dlerror(). The module is never unloaded, since Open CASCADE keeps state between calls.
void* load_module()
{
    std::error_code error;
    // A library of another program, as Python's module, has it beside itself.
    Dl_info here{};
    if (dladdr(reinterpret_cast<void*>(&load_module), &here) != 0) {
        const auto beside = std::filesystem::path{here.dli_fname}.parent_path() / kModule;
        if (std::filesystem::exists(beside, error)) {
            return dlopen(beside.c_str(), RTLD_NOW | RTLD_LOCAL);
        }
    }
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    for (const char* folder : {"lib", CUSP_CAD_FOLDER}) {
        const std::filesystem::path file = program.parent_path().parent_path() / folder / kModule;
        if (!error && std::filesystem::exists(file, error)) {
            return dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
        }
    }
    return dlopen(kModule, RTLD_NOW | RTLD_LOCAL);
}

CadModel read_model(const std::string& file, const Similarity& placed, bool all_faces)
{
    void* const module = load_module();
    void* const door = module == nullptr ? nullptr : dlsym(module, "cusp_read_cad_model");
    if (door == nullptr) {
        throw InputError(
            fmt::format("{}: STEP, IGES and BREP can't be read: {}; the whole build makes it where "
                        "Open CASCADE "
                        "(libocct-data-exchange-dev) is installed",
                        file, dlerror()));
    }
    CadModel model;
    files::with_file_on_disk(file, [&](const std::string& path) {
        reinterpret_cast<decltype(&cusp_read_cad_model)>(door)(path, placed, all_faces, model);
    });
    for (Surface& surface : model.faces) {
        surface = with_turning_knots(surface);
    }
    return model;
}

// Surfaces over the holes that the faces leave open above.
std::vector<Surface> hole_covers(const std::string& file,
                                 const CadModel& model,
                                 std::vector<std::string>& notes)
{
    constexpr double kOff = 1e-3;  // mm
    Facets covers;
    for (std::array<Vec3d, 3> t : covers_of_holes(file, "faces", model.open_faces, notes)) {
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
    CadModel model = read_model(file, placed, false);
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

CadModel read_cad_model(const std::string& file) { return read_model(file, {}, true); }

}  // namespace cusp::import
