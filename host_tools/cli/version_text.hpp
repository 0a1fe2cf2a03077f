// The program's version, the commit that it was built from, and how it was built.
#pragma once

#include <string>

namespace cusp::cli {

// Three lines: "cusp 0.2.0", "commit 1a2b3c4d5e" (with a + where the tree had changes; "unknown"
// outside git), "build Release, GNU 12.2.0, with Eigen, with Open CASCADE".
std::string version_text();

}  // namespace cusp::cli
