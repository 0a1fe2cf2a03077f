// Reads a fitted program again and measures how far it is from the lines it replaces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "firmware/base/vec.hpp"

namespace cusp::program_fit {

// A written line that replaces `count` lines of the program: those from vertex `first` to vertex
// `first + count` of a list.
struct Replacement {
    std::size_t text_line;  // of the written program, from 0
    std::size_t first;
    std::uint32_t count;
};

struct MeasuredFit {
    double vertices{};  // mm: the largest distance of a vertex from its replacement
    double between{};   // and of the middle of a line
    std::uint64_t lines{};
    std::uint64_t arcs{};
    std::uint64_t other_moves{};  // NURBS pieces, probes, holes
    std::uint64_t rapids{};
};

// Runs the written program through the controller's interpreter.
// Errors: std::logic_error where it is refused or does not end each replacement at its last vertex.
MeasuredFit measure_fit(std::string_view program,
                        const std::vector<Position>& vertices,
                        const std::vector<Replacement>& replacements);

}  // namespace cusp::program_fit
