// Geometry files by their ending, and text files.
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "host_tools/import/dxf_curves.hpp"
#include "host_tools/import/geometry_json.hpp"
#include "host_tools/import/job.hpp"
#include "host_tools/import/loop_shape.hpp"
#include "host_tools/import/text_of_file.hpp"

#include "fmt/format.h"

namespace cusp::host {
namespace {

std::string ending_of(const std::string& file)
{
    std::string ending = std::filesystem::path(file).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

}  // namespace

std::string text_of_file(const std::string& file)
{
    if (std::filesystem::is_directory(file)) {
        throw InputError(file + ": is a folder");
    }
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    if (!in && errno != 0) {
        throw InputError(fmt::format("{}: can't be read: {}", file, std::strerror(errno)));
    }
    return text.str();
}

std::vector<Surface> read_surfaces(const std::string& file, double millimetres)
{
    const std::string ending = ending_of(file);
    if (ending == ".json") {
        return read_json_surfaces(file, millimetres);
    }
    throw InputError(
        fmt::format("{}: surfaces are read from .json, not from \"{}\"", file, ending));
}

Loop read_loop(const std::string& file, double millimetres)
{
    const std::string ending = ending_of(file);
    if (ending == ".json") {
        return closed_loop(read_json_curves(file, millimetres), file);
    }
    if (ending == ".dxf") {
        return closed_loop(read_dxf_curves(file, millimetres), file);
    }
    throw InputError(
        fmt::format("{}: loops are read from .json and .dxf, not from \"{}\"", file, ending));
}

}  // namespace cusp::host
