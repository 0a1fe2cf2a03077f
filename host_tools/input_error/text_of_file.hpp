// A file's whole text, or the reason why there is none.
#pragma once

#include <string>

namespace cusp {

// Errors: InputError with the file's name and the system's reason.
std::string text_of_file(const std::string& file);

}  // namespace cusp
