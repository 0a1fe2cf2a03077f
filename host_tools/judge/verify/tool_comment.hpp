// The comments by which this product's programs describe their tools.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "host_tools/geometry/toolpath/tool.hpp"

namespace cusp::verify {

// The tool of a line such as "(tool 2 bull diameter 6 mm corner radius 1 mm: name)" or
// "; tool 1 vee diameter 0.25 inch tip angle 60", as toolpath::tool_text() writes them. No value for
// any other line. A cone without "tip diameter" is sharp.
std::optional<toolpath::Tool> tool_of_comment(std::string_view line);

// The tools of a program's lines in turn. Comments that were too long for a line go on in the next
// comment (toolpath::comment_lines()).
class ToolComments {
public:
    // The tool whose comment ends with this line.
    std::optional<toolpath::Tool> tool_after(std::string_view line);

private:
    std::string begun_;  // of a comment on a tool whose sizes are not complete yet
};

// True if shape and sizes are equal, within what the digits of a comment and of a job may differ.
bool is_same_cutter(const toolpath::Tool& a, const toolpath::Tool& b);

}  // namespace cusp::verify
