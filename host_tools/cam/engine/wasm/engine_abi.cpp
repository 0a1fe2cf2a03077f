// The C interface of the engine in WebAssembly. The other side is host_tools/cam/engine/npm/engine.ts: it puts files
// into the set, calls, and reads the answer.
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <emscripten.h>
#include <string>
#include <utility>

#include "firmware/base/assert.hpp"
#include "host_tools/cam/engine/engine.hpp"

// An assertion of the firmware: the worker ends with this line.
void cusp::fault(const char* expression, const char* file, int line) noexcept
{
    std::fprintf(stderr, "cusp: internal error: %s:%d: %s\n", file, line, expression);
    std::abort();
}

namespace {

// clang-format off
EM_JS(void, tell_progress, (double share, const char* text), {
    if (Module.cuspProgress) { Module.cuspProgress(share, UTF8ToString(text)); }
});
EM_JS(int, is_cancelled, (), {
    return Module.cuspCancelled && Module.cuspCancelled() ? 1 : 0;
});
// clang-format on

class PageListener : public cusp::engine::Listener {
public:
    void progress(double share, const std::string& text) override
    {
        tell_progress(share, text.c_str());
    }
    bool cancelled() override { return is_cancelled() != 0; }
};

cusp::files::FileSet given;
cusp::engine::Answer answer;

}  // namespace

extern "C" {

// Copies a file into the set. name, bytes  memory of the caller
EMSCRIPTEN_KEEPALIVE void cusp_put_file(const char* name, const char* bytes, std::size_t size)
{
    given[name].assign(bytes, size);
}

EMSCRIPTEN_KEEPALIVE void cusp_forget_files() { given.clear(); }

// Answers a call: engine.hpp. The answer stays until the next one.
EMSCRIPTEN_KEEPALIVE void cusp_call(const char* name, const char* arguments)
{
    PageListener listener;
    answer = {};
    answer = cusp::engine::call(name, arguments, given, listener);
}

EMSCRIPTEN_KEEPALIVE const char* cusp_answer() { return answer.json.c_str(); }
EMSCRIPTEN_KEEPALIVE std::size_t cusp_block_count() { return answer.blocks.size(); }
EMSCRIPTEN_KEEPALIVE const char* cusp_block_name(std::size_t k)
{
    return answer.blocks[k].name.c_str();
}
EMSCRIPTEN_KEEPALIVE const char* cusp_block_bytes(std::size_t k)
{
    return answer.blocks[k].bytes.data();
}
EMSCRIPTEN_KEEPALIVE std::size_t cusp_block_size(std::size_t k)
{
    return answer.blocks[k].bytes.size();
}
}
