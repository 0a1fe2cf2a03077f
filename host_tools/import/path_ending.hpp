// What a file's name ends in, to tell formats apart.
#pragma once

#include <string>

namespace cusp::import {

// With its dot, in small letters: ".step"; "" where there is none.
std::string path_ending(const std::string& file);

}  // namespace cusp::import
