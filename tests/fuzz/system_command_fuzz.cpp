// Any text behind a '$' is a command or an error, and never reads beyond its line.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "firmware/base/assert.hpp"
#include "firmware/protocol/system_command.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    std::string line{"$"};
    for (std::size_t i = 0; i < size; ++i) {
        line += static_cast<char>(data[i]);
    }
    const auto command = cusp::protocol::parse_system_command(line);
    if (command && !command->text.empty()) {
        const std::string_view text = command->text;
        CUSP_ASSERT(text.data() > line.data());
        CUSP_ASSERT(text.data() + text.size() == line.data() + line.size());
    }
    return 0;
}
