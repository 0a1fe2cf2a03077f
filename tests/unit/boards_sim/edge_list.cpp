// Runs a program through the whole firmware and writes every edge: to compare architectures.
//
// usage: edge_list PROGRAM [SCRIPT] >EDGES
// SCRIPT has lines `tick byte`. Each edge is a line: its pulse tick, its wire and its level; the last line is their
// checksum, eight hex digits.
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <memory>

#include "firmware/base/assert.hpp"
#include "host_tools/controller/program_run/edge_listener.hpp"
#include "host_tools/controller/program_run/program_run.hpp"

void cusp::fault(const char* expression, const char* file, int line) noexcept
{
    std::fprintf(stderr, "%s:%d: %s\n", file, line, expression);
    std::abort();
}

namespace {

using namespace cusp;

class EdgeLines : public program_run::EdgeListener<EdgeLines> {
public:
    using EdgeListener::EdgeListener;

    void edge(std::uint64_t tick, unsigned wire, bool level)
    {
        std::printf("%" PRIu64 " %u %d\n", tick, wire, level ? 1 : 0);
    }
};

std::vector<program_run::ScriptedByte> script_of(const char* file)
{
    std::ifstream in{file};
    std::vector<program_run::ScriptedByte> script;
    std::uint64_t tick = 0;
    unsigned byte = 0;
    while (in >> tick >> byte) {
        script.push_back({tick, static_cast<std::uint8_t>(byte)});
    }
    return script;
}

void write_edges(const char* program, const char* script)
{
    program_run::RunOptions options;
    options.measures_deviation = false;
    if (script != nullptr) {
        options.script = script_of(script);
    }
    std::unique_ptr<EdgeLines> lines;
    options.started = [&lines](hal::SimulatedBoard& board) {
        lines = std::make_unique<EdgeLines>(board.pulse_player.next_frame_start(),
                                            board.pulse_player.levels());
        board.pulse_player.add_listener(*lines);
    };
    dialect::LineSource source{program};
    program_run::ProgramRun run{source, options};
    while (run.advance()) {
    }
    for (const program_run::RunError& error : run.result().errors) {
        std::fprintf(stderr, "%s\n", fault_text(run.result(), error).c_str());
    }
    std::printf("%08" PRIx32 "\n", run.result().edges_crc32);
}

}  // namespace

int main(int count, char** words)
{
    if (count < 2) {
        std::fputs("usage: edge_list PROGRAM [SCRIPT] >EDGES\n", stderr);
        return 2;
    }
    try {
        write_edges(words[1], count > 2 ? words[2] : nullptr);
    } catch (const std::exception& fault) {
        std::fprintf(stderr, "edge_list: %s\n", fault.what());
        return 2;
    }
    return 0;
}
