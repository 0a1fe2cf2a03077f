// The text of `cusp --version`.
#include "host_tools/cli/version_text.hpp"

#include "host_tools/cli/build_version.hpp"

namespace cusp::cli {

std::string version_text()
{
    return "cusp " CUSP_VERSION "\ncommit " CUSP_COMMIT "\nbuild " CUSP_BUILD "\n";
}

}  // namespace cusp::cli
