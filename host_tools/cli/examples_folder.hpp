// Finds the examples that come with the program.
#pragma once

#include <filesystem>
#include <string>

namespace cusp::cli {

// The folder that holds `needed`: `given`, or where that is empty share/cusp/examples or examples
// in a folder above the executable, the nearest first: those of an installation, of a source tree.
//
// needed  a file of the examples, "demo/pocket.toml"
//
// Throws InputError where there is no such folder.
std::filesystem::path examples_folder(const std::string& given, const std::string& needed);

}  // namespace cusp::cli
