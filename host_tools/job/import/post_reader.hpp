// Reads posts: TOML files that come with the program, or of a user.
//
//     const toolpath::Post post = read_post("linuxcnc", "");
//     const toolpath::Post own = read_post("posts/own_mill.toml", folder_of_the_job);
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host_tools/job/job/job.hpp"

namespace cusp::import {

// name    of a post that comes with the program, or a path that ends in .toml
// folder  that the path is relative to
//
// Errors: InputError with file, line and key, or with the names that there are.
toolpath::Post read_post(const std::string& name, const std::filesystem::path& folder);

// Names of the built-in posts, in alphabetical order.
std::vector<std::string> post_names();

// They themselves. Errors: InputError if the program was copied without them.
std::vector<toolpath::Post> all_posts();

// Two lines: the controller, and what programs for it hold.
std::string post_text(const toolpath::Post& post);

}  // namespace cusp::import
