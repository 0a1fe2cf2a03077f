// Loads libcusp_cad.so when a STEP or IGES file is read.
#include "host_tools/import/cad_surfaces.hpp"

#include <dlfcn.h>

#include "host_tools/import/turning_knots.hpp"
#include "host_tools/input_error/input_error.hpp"

#include "fmt/format.h"

namespace cusp::host {
namespace {

CadModel read_model(const std::string& file, bool all_faces)
{
    // Looked for where the program's RUNPATH says. It stays loaded: Open CASCADE keeps state that
    // outlives a call.
    void* const module = dlopen("libcusp_cad.so", RTLD_NOW | RTLD_LOCAL);
    void* const door = module == nullptr ? nullptr : dlsym(module, "cusp_read_cad_model");
    if (door == nullptr) {
        throw InputError(
            fmt::format("{}: STEP and IGES can't be read: {}; it is built where Open CASCADE "
                        "(libocct-data-exchange-dev) is installed",
                        file, dlerror()));
    }
    CadModel model;
    reinterpret_cast<decltype(&cusp_read_cad_model)>(door)(file, all_faces, model);
    for (Surface& surface : model.faces) {
        surface = with_turning_knots(surface);
    }
    return model;
}

}  // namespace

std::vector<Surface> read_cad_surfaces(const std::string& file)
{
    return read_model(file, false).faces;
}

CadModel read_cad_model(const std::string& file) { return read_model(file, true); }

}  // namespace cusp::host
