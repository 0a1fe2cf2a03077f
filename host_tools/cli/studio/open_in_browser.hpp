// Shows a page to the user.
#pragma once

#include <string>

namespace cusp::studio {

// Does not wait. Nothing happens where there is no browser: whoever calls prints the address, too.
void open_in_browser(const std::string& address);

}  // namespace cusp::studio
