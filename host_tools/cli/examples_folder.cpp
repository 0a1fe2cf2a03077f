// The folder that is given, or that of the program's data.
#include "host_tools/cli/examples_folder.hpp"

#include <system_error>

#include "host_tools/base/files/program_data.hpp"
#include "host_tools/base/input_error/input_error.hpp"

#include "fmt/format.h"

namespace cusp::cli {

namespace fs = std::filesystem;

fs::path examples_folder(const std::string& given, const std::string& needed)
{
    std::error_code failed;
    if (!given.empty()) {
        if (!fs::is_regular_file(given / fs::path{needed}, failed)) {
            throw InputError(fmt::format("--examples {}: holds no {}", given, needed));
        }
        return given;
    }
    if (const auto found = files::program_data("examples", needed)) {
        return *found;
    }
    throw InputError(
        fmt::format("no share/cusp/examples/{0} and no examples/{0} in {1} or above: "
                    "name the folder of the examples with --examples DIR",
                    needed, files::program_folder().string()));
}

}  // namespace cusp::cli
