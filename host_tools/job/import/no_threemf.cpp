// In place of threemf_facets.cpp where lib3mf is not installed.
#include "host_tools/job/import/threemf_facets.hpp"

namespace cusp::import {

Facets read_threemf(const std::string& file)
{
    throw InputError(
        fmt::format("{}: 3MF can't be read: cusp was built without lib3mf (lib3mf-dev)", file));
}

}  // namespace cusp::import
