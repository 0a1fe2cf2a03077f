#include <array>
#include <optional>
#include <string>
#include <variant>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"

namespace {

using cusp::hal::SimulatedBoard;
using cusp::hal::SimulatedStore;

// A controller that starts with the store of another one.
struct PowerCycle {
    explicit PowerCycle(const SimulatedStore& store) : board{{}}
    {
        board.settings_store = store;
        app.emplace(board, queue);
        for (unsigned i = 0; i < 50; ++i) {
            while (app->poll()) {
            }
            app->tick();
            board.advance();
        }
        greeting = board.byte_link.take_answers();
    }
    SimulatedBoard board;
    cusp::planner::PathQueue queue;
    std::optional<cusp::app::App<SimulatedBoard>> app;
    std::string greeting;
};

}  // namespace

TEST_GROUP(Store) { cusp::ControllerBench bench; };

TEST(Store, KeepsSettingsOffsetsAndTextsThroughAPowerCycle)
{
    (void)bench.exchange("$110=5000\nG10L2P2X7\n$N1=G20\n$I=MILL\nG92X3\n", 100);
    const PowerCycle again{bench.board.settings_store};
    const cusp::machine::Machine& machine = again.app->machine();
    DOUBLES_EQUAL(
        5000, static_cast<double>(machine.settings().value(cusp::machine::Setting::kMaxRate)), 0);
    CHECK(has_text(again.greeting, ">G20:ok"));
    CHECK(machine.state() == cusp::machine::State::kIdle);
}

TEST(Store, IsAskedBeforeTheAnswer)
{
    (void)bench.exchange("", 5);
    bench.board.settings_store.cut_power_after(3);
    const std::string said = bench.exchange("$110=5000\n");
    CHECK(has_text(said, "error:7"));
    CHECK_FALSE(has_text(said, "ok"));
}

TEST(Store, ReportsDamageAndLocksInsteadOfGoingOnWithDefaults)
{
    (void)bench.exchange("$110=5000\n", 50);
    bench.board.settings_store.damage(0, 40, 0xFF);
    const PowerCycle again{bench.board.settings_store};
    CHECK(has_text(again.greeting, "error:7"));
    CHECK(has_text(again.greeting, "[MSG:Settings lost"));
    CHECK(again.app->machine().state() == cusp::machine::State::kAlarm);
}

TEST(Store, KeepsTheTableOfTools)
{
    (void)bench.exchange("G10L1P2Z-7.3\nG10L1P16Z0\n", 100);
    const PowerCycle again{bench.board.settings_store};
    const cusp::gcode::ToolTable& tools = again.app->machine().parameters().tools;
    CHECK(tools.has(2) && tools.has(16) && !tools.has(1));
    LONGS_EQUAL(-7300000, tools.length_nm(2));
}

// A record of another layout does not count: a message says so, and the machine is locked.
TEST(Store, TellsOfSettingsOfAnEarlierVersion)
{
    (void)bench.exchange("$110=5000\n", 50);
    constexpr std::uint32_t kMark = 0x43555305;
    std::array<std::uint8_t, 4> mark{};
    auto& store = bench.board.settings_store;
    for (std::uint32_t at = 0; at + 4 <= store.sector_size(); at += 4) {
        store.read(0, at, mark);
        const std::uint32_t word =
            mark[0] | mark[1] << 8U | mark[2] << 16U | static_cast<std::uint32_t>(mark[3]) << 24U;
        if (word == kMark) {
            store.damage(0, at, 0x01);  // 05 becomes 04
        }
    }
    const PowerCycle again{store};
    CHECK(has_text(again.greeting, "error:7"));
    CHECK(has_text(again.greeting, "[MSG:Settings lost"));
}
