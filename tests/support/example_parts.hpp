// Paths of the parts of the examples.
#pragma once

#include <string>

#include "host_tools/job/import/import.hpp"

namespace cusp::test {

inline const std::string kExampleParts = CUSP_SOURCE_DIR "/examples/parts/";

// The first surface of a file there.
inline nurbs::Surface example_part(const std::string& name)
{
    return import::read_surfaces(kExampleParts + name).front();
}

}  // namespace cusp::test
