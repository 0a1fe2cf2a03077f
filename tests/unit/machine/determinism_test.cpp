#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"

namespace {

// A hash of every edge and its time.
class EdgeHash : public cusp::hal::FrameListener {
public:
    void frame_played(std::uint64_t start_tick, const cusp::PulseFrame& frame) override
    {
        for (const cusp::PulseEdge& edge : frame.edges) {
            add(start_tick + edge.tick);
            add(std::uint64_t{edge.raise} << 8U | edge.lower);
        }
    }
    std::uint64_t value{14695981039346656037U};

private:
    void add(std::uint64_t word) { value = (value ^ word) * 1099511628211U; }
};

std::uint64_t edges_of(const std::string& program)
{
    cusp::ControllerBench bench;
    EdgeHash hash;
    bench.board.pulse_player.add_listener(hash);
    bench.board.byte_link.send(program);
    (void)bench.finish();
    return hash.value;
}

constexpr const char* kProgram =
    "G21G90G64P0.02\nG1X5Y3F2000\nX8Y3\nG2X12Y7I4J0\nG3X0Y0R20\nG0Z-2\nX1Y1Z0\nM30\n";

}  // namespace

TEST_GROUP(Frames){};

TEST(Frames, AreTheSameForTheSameBytes)
{
    CHECK(edges_of(kProgram) == edges_of(kProgram));
    CHECK(edges_of(kProgram) != edges_of("G1X5F2000\n"));
}

TEST(Frames, DoNotDependOnCommentsAndStatusReports)
{
    std::string wordy;
    for (const char c : std::string{kProgram}) {
        wordy += c == '\n' ? std::string{" (a comment)?\n"} : std::string{c};
    }
    CHECK(edges_of(kProgram) == edges_of(wordy));
}
