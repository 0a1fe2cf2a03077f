// libFuzzer on the G-code interpreter: any bytes, line by line, keep its promises.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "tests/judges/gcode_promises.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
    cusp::GcodePromises promises;
    std::string_view text{reinterpret_cast<const char*>(bytes), size};
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        if (const char* broken = promises.run(text.substr(0, end))) {
            (void)std::fprintf(stderr, "%s\n", broken);
            std::abort();
        }
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    return 0;
}
