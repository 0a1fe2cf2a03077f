// Any bytes as a part or a job: the readers accept the file or refuse it with a message.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/job/import/import.hpp"
#include "tests/support/temporary_folder.hpp"

// The first byte picks the format.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const cusp::test::TemporaryFolder folder;  // to the end of the process
    static const std::array<const char*, 8> kNames{"s.json", "c.json", "c.dxf", "s.stl",
                                                   "j.toml", "c.svg",  "c.gbr", "c.drl"};
    if (size == 0) {
        return 0;
    }
    const std::size_t kind = data[0] % kNames.size();
    const std::string file = folder.file(kNames[kind]);
    std::FILE* out = std::fopen(file.c_str(), "wb");
    if (out == nullptr) {
        return 0;
    }
    std::fwrite(data + 1, 1, size - 1, out);
    std::fclose(out);
    try {
        if (kind == 0 || kind == 3) {
            cusp::import::read_surfaces(file);
        } else if (kind == 4) {
            cusp::import::read_job(file, cusp::strategies::all());
        } else {
            cusp::import::read_loop(file);
        }
    } catch (const cusp::InputError&) {
        // refused in words, as it should be
    }
    return 0;
}
