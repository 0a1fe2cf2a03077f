// The options of commands that may take long: threads and memory.
#pragma once

#include <cstddef>

#include "CLI/App.hpp"

namespace cusp::cli {

struct Resources {
    int threads{};         // 0: one a core
    std::size_t memory{};  // bytes; 0: half of the machine's
};

void add_resource_options(CLI::App& command, Resources& resources);

// Limits the process, and has Ctrl-C and the end of memory end it with a line.
void apply(const Resources& resources);

}  // namespace cusp::cli
