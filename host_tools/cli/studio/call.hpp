// One call of the engine as bytes: what the page sends, and what it gets.
//
// Request: a line of JSON, {"arguments": {...}, "files": [{"name": "part.stl", "size": 684}, ...]}, then the bytes of
// the files, one after the other. Answer: lines of JSON, any number of {"progress": {"share": 0.5, "text": "planning"}},
// then {"answer": {...}, "blocks": [{"name": "gcode-0", "size": 120}, ...]} with the engine's answer, then the bytes of the blocks.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "host_tools/base/files/file_set.hpp"
#include "host_tools/cam/engine/engine.hpp"

namespace cusp::studio {

struct Call {
    std::string arguments;  // JSON
    files::FileSet files;
};

// Errors: InputError where the bytes are no request, or fewer than it announces.
Call read_call(std::string_view request);

// The bytes of an answer, from its line on.
std::string answer_bytes(const engine::Answer& answer);
// The failure of a call that has no answer of the engine: its `kind` is "internal".
std::string failure_bytes(const std::string& text);

// Reads a request to its end, calls the engine, and writes the answer. Progress is written at most twenty times a second.
void answer_call(const std::string& name, std::FILE* in, std::FILE* out);

}  // namespace cusp::studio
