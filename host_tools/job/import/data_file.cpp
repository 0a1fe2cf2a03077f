// A name is a file in the folder of its kind.
#include "host_tools/job/import/data_file.hpp"

#include <algorithm>
#include <system_error>

#include "host_tools/base/files/program_data.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/nearest_name.hpp"
#include "host_tools/job/import/path_ending.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

namespace fs = std::filesystem;

std::vector<std::string> data_names(const DataKind& kind)
{
    std::vector<std::string> names;
    std::error_code failed;
    if (const auto folder = files::program_data(kind.folder, std::string{kind.always} + ".toml")) {
        for (const fs::directory_entry& entry : fs::directory_iterator{*folder, failed}) {
            if (entry.path().extension() == ".toml") {
                names.push_back(entry.path().stem().string());
            }
        }
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::vector<std::string> data_names_or_refuse(const DataKind& kind)
{
    std::vector<std::string> names = data_names(kind);
    if (names.empty()) {
        throw InputError(
            fmt::format("the {0} that come with cusp are not found: share/cusp/{0} stands beside "
                        "the folder bin of the program",
                        kind.folder));
    }
    return names;
}

fs::path data_file(const DataKind& kind, const std::string& name, const fs::path& folder)
{
    if (path_ending(name) == ".toml") {
        return folder / name;
    }
    const bool plain = name.find('/') == std::string::npos;
    const auto found = plain ? files::program_data(kind.folder, name + ".toml") : std::nullopt;
    if (!found) {
        const std::vector<std::string> names = data_names_or_refuse(kind);
        const auto nearest = nearest_names(name, names, 1);
        throw InputError(fmt::format(
            "{} \"{}\": there is none of that name{}; there are: {}; a {} of one's own is a path "
            "that ends in .toml",
            kind.word, name, nearest.empty() ? "" : ", the nearest is \"" + nearest.front() + "\"",
            fmt::join(names, ", "), kind.word));
    }
    return *found / (name + ".toml");
}

}  // namespace cusp::import
