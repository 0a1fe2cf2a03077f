// The ending of a file name, which selects the reader.
#pragma once

#include <string>

namespace cusp::import {

// With its dot, in lower case: ".step"; "" where there is none.
std::string path_ending(const std::string& file);

}  // namespace cusp::import
