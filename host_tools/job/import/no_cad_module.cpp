// The reader of CAD files in a build that can load no module, as in WebAssembly.
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/cad_surfaces.hpp"

namespace cusp::import {

CadModel cad_model(const std::string& file, const Similarity&, CadWanted)
{
    throw InputError(
        file +
            ": STEP, IGES and BREP can't be read here; the program cusp reads them (cusp "
            "studio), and a CAD program exports STL",
        {file});
}

}  // namespace cusp::import
