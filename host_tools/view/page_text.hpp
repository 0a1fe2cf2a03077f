// The pages as bundled at build time: HTML with script and style inside.
#pragma once

#include <string_view>

namespace cusp::view {

enum class Page { kView, kPlayground };

// HTML; kView with the lines kFactsPlace and kDataPlace. Empty where the page was not built.
std::string_view page_text(Page page);

// Why page_text() is empty, in words; empty where it is not.
std::string_view why_no_page();

// Where a page takes its figures, before the script, and its data, after it.
// Whether the pages hold the firmware's core in WebAssembly.
bool pages_hold_core();

inline constexpr std::string_view kFactsPlace = "@FACTS@\n";
inline constexpr std::string_view kDataPlace = "@DATA@\n";

}  // namespace cusp::view
