// Loads libcusp_cad.so when the first CAD file is read.
#include <dlfcn.h>
#include <filesystem>

#include "host_tools/base/files/file_set.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/cad_surfaces.hpp"
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

}  // namespace

CadModel cad_model(const std::string& file, const Similarity& placed, CadWanted wanted)
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
        reinterpret_cast<decltype(&cusp_read_cad_model)>(door)(path, placed, wanted, model);
    });
    for (Surface& surface : model.faces) {
        surface = with_turning_knots(surface);
    }
    return model;
}

}  // namespace cusp::import
