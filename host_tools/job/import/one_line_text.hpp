// Pieces that the jobs of all one-line calls have in common, as TOML and in words.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/import/one_line_choice.hpp"
#include "host_tools/job/import/sheet_nest.hpp"

namespace cusp::import {

// A text as TOML writes it; a list of texts.
std::string quoted(const std::string& text);
std::string quoted_list(const std::vector<std::string>& texts);

// The unit, the post, the tools and [cutting].
std::string head_toml(const OneLineRequest& request, const OneLineChoice& choice);

// The table [placing], or one for each of the copied; "" if no option places the parts.
std::string placing_toml(const OneLineRequest& request,
                         const std::vector<NestedFiles>& copied = {});

// Feeds and spindle, and by which options they are set.
std::string said_feeds(const OneLineRequest& request, const OneLineChoice& choice);

}  // namespace cusp::import
