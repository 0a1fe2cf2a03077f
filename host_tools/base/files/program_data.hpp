// Finds the data that come with the program.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace cusp::files {

// The folder that holds `needed`: share/cusp/FOLDER or FOLDER in a folder above the executable, the
// nearest first: those of an installation, of a source tree. None where there is no such file.
//
// needed  a file, relative to the folder
std::optional<std::filesystem::path> program_data(const std::string& folder,
                                                  const std::string& needed);

// The folder of the executable; the root where there is none, as in WebAssembly.
std::filesystem::path program_folder();

}  // namespace cusp::files
