// Searches the folders above the executable.
#include "host_tools/cli/examples_folder.hpp"

#include <system_error>

#include "host_tools/input_error/input_error.hpp"

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
    const fs::path bin = fs::read_symlink("/proc/self/exe", failed).parent_path();
    for (fs::path above = bin; !above.empty(); above = above.parent_path()) {
        for (const char* name : {"share/cusp/examples", "examples"}) {
            if (fs::is_regular_file(above / name / needed, failed)) {
                return above / name;
            }
        }
        if (above == above.root_path()) {
            break;
        }
    }
    throw InputError(
        fmt::format("no share/cusp/examples/{0} and no examples/{0} in {1} or above: "
                    "name the folder of the examples with --examples DIR",
                    needed, bin.string()));
}

}  // namespace cusp::cli
