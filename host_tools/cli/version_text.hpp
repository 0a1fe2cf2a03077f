// Version, commit and build configuration of the program.
#pragma once

#include <string>

namespace cusp::cli {

// Three lines: "cusp 0.3.0", "commit 1a2b3c4d5e" (with a + where the tree had changes; "unknown"
// outside git), "build Release, GNU 12.2.0, with Eigen, with Open CASCADE".
std::string version_text();

}  // namespace cusp::cli
