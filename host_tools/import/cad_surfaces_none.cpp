// STEP and IGES in a build without Open CASCADE: says what is missing.
#include "host_tools/import/cad_surfaces.hpp"
#include "host_tools/input_error/input_error.hpp"

namespace cusp::host {

std::string missing_for_cad_files()
{
    return "this build has no Open CASCADE: install libocct-data-exchange-dev and configure again "
           "(CUSP_OCCT)";
}

std::vector<Surface> read_cad_surfaces(const std::string& file)
{
    throw InputError(file + ": STEP and IGES can't be read: " + missing_for_cad_files());
}

}  // namespace cusp::host
