// Files that come with the program by name: posts, materials, libraries of tools; or a user's by path.
//
//     const auto file = data_file({"material", "materials", "aluminium"}, "brass", folder_of_the_job);
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cusp::import {

struct DataKind {
    const char* word;    // in messages
    const char* folder;  // of the files that come with the program
    const char* always;  // one of them
};

// Their names, in alphabetical order.
std::vector<std::string> data_names(const DataKind& kind);

// The same. Errors: InputError if there are none: the program was copied without them.
std::vector<std::string> data_names_or_refuse(const DataKind& kind);

// The file of that name; or `name` itself, relative to `folder`, if it ends in .toml.
//
// Errors: InputError with the nearest name and all of them.
std::filesystem::path data_file(const DataKind& kind,
                                const std::string& name,
                                const std::filesystem::path& folder);

}  // namespace cusp::import
