// Finds the examples that come with the program.
#pragma once

#include <filesystem>
#include <string>

namespace cusp::cli {

// The folder of examples that contains `needed`. If `given` is empty, searches share/cusp/examples
// (an installation) and examples (a source tree) in the folders above the executable, the nearest
// first.
//
// needed  relative path of an example, "demo/pocket.toml"
//
// Throws InputError where there is no such folder.
std::filesystem::path examples_folder(const std::string& given, const std::string& needed);

}  // namespace cusp::cli
