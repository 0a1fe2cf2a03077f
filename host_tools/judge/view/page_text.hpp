// The pages as bundled at build time: HTML with script and style inside.
#pragma once

#include <string_view>

namespace cusp::view {

enum class Page { kView, kPlayground };

// HTML; kView contains the lines kFactsPlace and kDataPlace. Empty if the page was not built.
std::string_view page_text(Page page);

// The reason why page_text() is empty; empty if it is not.
std::string_view why_no_page();

// True if the pages contain the firmware's core in WebAssembly.
bool pages_hold_core();

// Lines that are replaced by the figures, before the script, and by the data, after it.
inline constexpr std::string_view kFactsPlace = "@FACTS@\n";
inline constexpr std::string_view kDataPlace = "@DATA@\n";

}  // namespace cusp::view
