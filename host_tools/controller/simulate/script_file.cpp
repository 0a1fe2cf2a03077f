// Scripts: realtime bytes with the servo ticks of their arrival, for repeatable holds and
// overrides.
#include <fmt/format.h>
#include <fstream>
#include <sstream>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/controller/simulate/simulate.hpp"

namespace cusp::simulate {

using program_run::ScriptedByte;

std::vector<ScriptedByte> read_script(const std::string& file)
{
    std::ifstream in{file};
    if (!in) {
        throw InputError{file + ": can't be read"};
    }
    std::vector<ScriptedByte> script;
    std::string line;
    for (unsigned number = 1; std::getline(in, line); ++number) {
        std::istringstream words{line};
        std::uint64_t tick = 0;
        unsigned byte = 0;
        std::string rest;
        if (line.find_first_not_of(" \t\r") == std::string::npos) {
            continue;
        }
        const bool numbers = (words >> tick >> byte) && !(words >> rest);
        if (!numbers || byte == 0 || byte > 255 || (!script.empty() && tick < script.back().tick)) {
            throw InputError{fmt::format(
                "{}:{}: '{}' is not a servo tick, not before the one above, and a byte from 1 to "
                "255",
                file, number, line)};
        }
        script.push_back({tick, static_cast<std::uint8_t>(byte)});
    }
    return script;
}

}  // namespace cusp::simulate
