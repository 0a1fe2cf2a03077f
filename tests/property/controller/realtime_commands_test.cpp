// With holds, overrides and reports at random ticks a program ends at its end point, to the
// nanometre and the step, and every line is answered once.
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>
#include <variant>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"

namespace {

struct Program {
    std::string text;
    unsigned lines;
    cusp::Position end;
};

Program random_program(std::mt19937& random)
{
    Program program{"G21G90\n", 1, {}};
    std::uniform_int_distribution<int> place{-20000, 20000};  // micrometres
    for (unsigned i = 0; i < 30; ++i) {
        const int x = place(random);
        const int y = place(random);
        char line[64];
        (void)std::snprintf(line, sizeof line, "G%uX%.3fY%.3fF%u\n", i % 4 == 0 ? 0U : 1U, x * 1e-3,
                            y * 1e-3, 500U + static_cast<unsigned>(random() % 5500));
        program.text += line;
        ++program.lines;
        program.end = {std::int64_t{x} * 1000, std::int64_t{y} * 1000, 0};
        if (i % 7 == 0) {
            program.text += i % 2 == 0 ? "G64P0.05\n" : "G61\n";
            ++program.lines;
        }
    }
    return program;
}

unsigned count(const std::string& text, const std::string& what)
{
    unsigned found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
        ++found;
    }
    return found;
}

}  // namespace

TEST_GROUP(RealtimeCommands){};

TEST(RealtimeCommands, LeaveTheEndOfAProgramAndItsAnswersAsTheyAre)
{
    constexpr unsigned kPrograms = 12;
    for (unsigned seed = 1; seed <= kPrograms; ++seed) {
        std::mt19937 random{seed};
        const Program program = random_program(random);
        cusp::ControllerBench bench;
        (void)bench.exchange("", 5);
        bench.board.byte_link.send(program.text);
        std::string said;
        const std::string commands = "!~?\x90\x91\x92\x93\x94\x95\x96\x97\x9A\xA0!~";
        for (unsigned i = 0; i < 120; ++i) {
            const char command = commands[random() % commands.size()];
            said +=
                bench.exchange(std::string(1, command), 1 + static_cast<unsigned>(random() % 60));
        }
        for (unsigned i = 0; i < 100 && !bench.app.machine().idle(); ++i) {
            said += bench.exchange("~\x90\x95", 100);
        }
        said += bench.finish();
        const std::string where = "seed " + std::to_string(seed);
        CHECK_TEXT(bench.app.machine().idle(), where.c_str());
        CHECK_TEXT(bench.app.machine().motion().position() == program.end, where.c_str());
        const cusp::PerAxis<std::int64_t>& steps = bench.board.mill.steps();
        constexpr std::int64_t kNanometresPerStep = 1250;
        CHECK_TEXT(
            std::abs(program.end.x - steps[0] * kNanometresPerStep) <= kNanometresPerStep / 2,
            where.c_str());
        CHECK_TEXT(
            std::abs(program.end.y - steps[1] * kNanometresPerStep) <= kNanometresPerStep / 2,
            where.c_str());
        UNSIGNED_LONGS_EQUAL_TEXT(program.lines, count(said, "ok\r\n"), where.c_str());
        UNSIGNED_LONGS_EQUAL_TEXT(0, count(said, "error"), where.c_str());
    }
}
