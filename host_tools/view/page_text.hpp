// The pages as bundled at build time: HTML with script and style inside.
#pragma once

#include <string_view>

namespace cusp::view {

enum class Page { kView, kPlayground };

// HTML with the line kDataPlace, for which the data of a run stand; empty where the page was not built.
std::string_view page_text(Page page);

// Why page_text() is empty, in words; empty where it is not.
std::string_view why_no_page();

inline constexpr std::string_view kDataPlace = "@DATA@\n";

}  // namespace cusp::view
