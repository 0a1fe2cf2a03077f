// Searches the folders above the executable.
#include "host_tools/base/files/program_data.hpp"

#include <system_error>

namespace cusp::files {

namespace fs = std::filesystem;

fs::path program_folder()
{
    std::error_code failed;
    const fs::path program = fs::read_symlink("/proc/self/exe", failed);
    return failed ? fs::path{"/"} : program.parent_path();
}

std::optional<fs::path> program_data(const std::string& folder, const std::string& needed)
{
    std::error_code failed;
    for (fs::path above = program_folder(); !above.empty(); above = above.parent_path()) {
        for (const fs::path& name : {fs::path{"share/cusp"} / folder, fs::path{folder}}) {
            if (fs::is_regular_file(above / name / needed, failed)) {
                return above / name;
            }
        }
        if (above == above.root_path()) {
            break;
        }
    }
    return std::nullopt;
}

}  // namespace cusp::files
