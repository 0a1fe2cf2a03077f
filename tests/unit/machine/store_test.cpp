#include <optional>
#include <string>
#include <variant>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"

namespace {

using cusp::hal::SimulatedBoard;
using cusp::hal::SimulatedStore;

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

// A controller that comes up with what another left in the store.
struct PowerCycle {
    explicit PowerCycle(const SimulatedStore& store) : board{{}}
    {
        board.settings_store = store;
        app.emplace(board);
        for (unsigned i = 0; i < 50; ++i) {
            while (app->poll()) {
            }
            app->tick();
            board.advance();
        }
        greeting = board.byte_link.take_answers();
    }
    SimulatedBoard board;
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
    CHECK(contains(again.greeting, ">G20:ok"));
    CHECK(machine.state() == cusp::machine::State::kIdle);
}

TEST(Store, IsAskedBeforeTheAnswer)
{
    (void)bench.exchange("", 5);
    bench.board.settings_store.cut_power_after(3);
    const std::string said = bench.exchange("$110=5000\n");
    CHECK(contains(said, "error:7"));
    CHECK_FALSE(contains(said, "ok"));
}

TEST(Store, ReportsDamageAndLocksInsteadOfGoingOnWithDefaults)
{
    (void)bench.exchange("$110=5000\n", 50);
    bench.board.settings_store.damage(0, 40, 0xFF);
    const PowerCycle again{bench.board.settings_store};
    CHECK(contains(again.greeting, "error:7"));
    CHECK(contains(again.greeting, "[MSG:Settings lost"));
    CHECK(again.app->machine().state() == cusp::machine::State::kAlarm);
}
