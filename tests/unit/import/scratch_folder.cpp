// Test files in the system's folder for temporary ones.
#include "tests/unit/import/scratch_folder.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

ScratchFolder::ScratchFolder()
{
    std::string pattern = (std::filesystem::temp_directory_path() / "cusp-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) {
        std::abort();
    }
    folder_ = pattern;
}

ScratchFolder::~ScratchFolder() { std::filesystem::remove_all(folder_); }

std::string ScratchFolder::write(const std::string& name, const std::string& text) const
{
    std::ofstream(path(name)) << text;
    return path(name);
}
