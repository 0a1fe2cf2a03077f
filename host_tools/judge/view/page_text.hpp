// The pages, bundled at build time or taken from bundle/: HTML with script and style inside.
#pragma once

#include <string_view>

namespace cusp::view {

enum class Page { kView, kPlayground, kStudio };

// HTML; kView contains the lines kFactsPlace and kDataPlace. kPlayground is empty where the build took the page of bundle/.
std::string_view page_text(Page page);

// True if the pages contain the firmware's core in WebAssembly.
bool pages_hold_core();

// Lines that are replaced by the figures, before the script, and by the data, after it.
inline constexpr std::string_view kFactsPlace = "@FACTS@\n";
inline constexpr std::string_view kDataPlace = "@DATA@\n";

}  // namespace cusp::view
