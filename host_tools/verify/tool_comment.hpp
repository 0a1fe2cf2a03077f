// The comments by which this product's programs describe their tools.
#pragma once

#include <optional>
#include <string_view>

#include "host_tools/toolpath/tool.hpp"

namespace cusp::verify {

// The tool of a line such as "(tool 2 bull diameter 6 mm corner radius 1 mm: name)" or
// "; tool 1 vee diameter 0.25 inch tip angle 60", as toolpath::tool_text() writes them. No value for
// any other line. The flat at the tip of a cone is not described: it is taken as sharp, which cuts less.
std::optional<toolpath::Tool> tool_of_comment(std::string_view line);

// Whether shape and sizes are equal.
bool is_same_cutter(const toolpath::Tool& a, const toolpath::Tool& b);

}  // namespace cusp::verify
