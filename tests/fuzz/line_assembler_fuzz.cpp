// Any bytes give clean lines of at most 255 characters, one for each line end.
#include <cstddef>
#include <cstdint>

#include "firmware/base/assert.hpp"
#include "firmware/protocol/line_assembler.hpp"
#include "firmware/protocol/receive_queue.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    cusp::protocol::LineAssembler line;
    for (std::size_t i = 0; i < size; ++i) {
        const bool ended = line.add(data[i]);
        CUSP_ASSERT(ended == cusp::protocol::is_line_end(data[i]));
        CUSP_ASSERT(line.line().size() <= cusp::protocol::kMaxLineLength);
        CUSP_ASSERT(line.checked_part().size() <= line.line().size());
        if (!ended) {
            continue;
        }
        for (const char c : line.line()) {
            const auto byte = static_cast<std::uint8_t>(c);
            CUSP_ASSERT(byte > ' ' && byte != '(' && byte != ';' && byte != '/');
            CUSP_ASSERT(byte < 'a' || byte > 'z');
        }
        line.begin_line();
        CUSP_ASSERT(line.line().empty() && !line.overflow() && !line.started());
    }
    return 0;
}
