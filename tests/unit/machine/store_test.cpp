#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"
#include "tests/unit/machine/earlier_record.hpp"

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

namespace {

// A store with nothing but this record in it.
SimulatedStore store_with(const std::vector<std::uint8_t>& record, std::uint32_t at = 0)
{
    SimulatedStore store;
    CHECK(store.write(0, at, cusp::Span<const std::uint8_t>{record.data(), record.size()}));
    return store;
}

double value_of(const PowerCycle& mill, std::uint32_t number)
{
    for (std::size_t i = 0; i < cusp::machine::kSettingCount; ++i) {
        if (cusp::machine::setting_entry(i).number == number) {
            return static_cast<double>(mill.app->machine().settings().value_at(i));
        }
    }
    return -1;
}

void check_carried_over(const PowerCycle& mill, double rate)
{
    CHECK_FALSE(has_text(mill.greeting, "error"));
    CHECK_FALSE(has_text(mill.greeting, "Settings"));
    CHECK(has_text(mill.greeting, ">G20:ok"));
    CHECK(mill.app->machine().state() == cusp::machine::State::kIdle);
    DOUBLES_EQUAL(rate, value_of(mill, 110), 0);
    DOUBLES_EQUAL(5, value_of(mill, 14), 0);
    DOUBLES_EQUAL(7, value_of(mill, 790), 0);
    DOUBLES_EQUAL(2, value_of(mill, 793), 0);
    DOUBLES_EQUAL(2, value_of(mill, 811), 0);
    DOUBLES_EQUAL(0.1, value_of(mill, 832), 1e-6);
    // New since then.
    DOUBLES_EQUAL(0, value_of(mill, 394), 0);
    DOUBLES_EQUAL(0, value_of(mill, 795), 0);
    DOUBLES_EQUAL(1, value_of(mill, 796), 0);
    DOUBLES_EQUAL(1000, value_of(mill, 33), 0);
    DOUBLES_EQUAL(100, value_of(mill, 36), 0);
    const cusp::gcode::Parameters& parameters = mill.app->machine().parameters();
    CHECK(parameters.work_offsets[1].x == 177800000);  // in inches, by $N1
    LONGS_EQUAL(-114300000, parameters.tools.length_nm(3));
}

// The settings that layout 11, 10, 9, 8, 7, 6, 5, 4 and 3 brought, as `$` numbers.
const std::vector<std::vector<std::uint16_t>> kBrought{
    {798},
    {340, 374, 375, 395, 460, 462, 463, 464, 465, 466, 467, 468, 469, 470, 471},
    {37, 44, 45, 46, 160, 161, 162, 850, 851, 852},
    {140, 141, 142, 150, 151, 152, 210, 211, 212, 338, 840, 841, 842},
    {33, 34, 35, 36, 481, 797},
    {796},
    {394, 795},
    {810, 811, 812, 820, 821, 822, 830, 831, 832},
    {8, 170, 171, 172, 347, 348, 349, 793, 794},
};

// The record of a state as a firmware of an earlier layout, without the rotary axis, would have written it.
std::vector<std::uint8_t> record_of(const cusp::machine::StoredState& state, unsigned layout)
{
    std::vector<std::uint8_t> bytes;
    const auto add_word = [&bytes](std::uint32_t word) {
        for (unsigned shift = 0; shift < 32; shift += 8) {
            bytes.push_back(static_cast<std::uint8_t>(word >> shift));
        }
    };
    for (std::size_t i = 0; i < cusp::machine::kSettingCount; ++i) {
        const cusp::machine::SettingEntry& entry = cusp::machine::setting_entry(i);
        const std::uint16_t number = entry.number;
        bool lacks = entry.since == cusp::machine::kLayoutWithRotary;
        for (unsigned later = cusp::machine::kLayoutNumber; later > layout; --later) {
            const auto& brought = kBrought[cusp::machine::kLayoutNumber - later];
            lacks = lacks || std::find(brought.begin(), brought.end(), number) != brought.end();
        }
        const float value = state.settings.value_at(i);
        std::uint32_t word = 0;
        std::memcpy(&word, &value, sizeof word);
        if (!lacks) {
            add_word(word);
        }
    }
    bytes.resize((bytes.size() + 7) / 8 * 8);
    const auto* rest = reinterpret_cast<const std::uint8_t*>(&state.parameters);
    const auto* end = reinterpret_cast<const std::uint8_t*>(&state + 1);
    // Numbers of X, Y and Z.
    for (std::size_t i = 0; i < cusp::gcode::Parameters::kPositions; ++i) {
        bytes.insert(bytes.end(), rest, rest + 3 * sizeof(std::int64_t));
        rest += sizeof(cusp::Position);
    }
    bytes.insert(bytes.end(), rest, end);
    const auto size = static_cast<std::uint32_t>(bytes.size());
    add_word(1);
    add_word(size);
    cusp::protocol::Crc32 crc;
    crc.add(cusp::Span<const std::uint8_t>{bytes.data(), bytes.size()});
    add_word(crc.value());
    add_word(0x43555300U | layout);
    return bytes;
}

}  // namespace

TEST(Store, CarriesOverWhatAnEarlierVersionKept)
{
    const PowerCycle again{store_with(cusp::record_of_layout_4())};
    check_carried_over(again, 5000);
}

TEST(Store, KeepsWhatWasCarriedOverWithTheNextChange)
{
    constexpr std::uint32_t kTenthSlot = 9 * 888;
    PowerCycle first{store_with(cusp::record_of_layout_4(), kTenthSlot)};
    first.board.byte_link.send("$110=4000\n");
    for (unsigned i = 0; i < 400; ++i) {
        while (first.app->poll()) {
        }
        first.app->tick();
        first.board.advance();
    }
    const PowerCycle second{first.board.settings_store};
    check_carried_over(second, 4000);
}

TEST(Store, ReadsEveryEarlierLayoutWithDefaultsForWhatItLacks)
{
    for (unsigned layout = cusp::machine::kOldestLayout; layout <= cusp::machine::kLatestEarlier;
         ++layout) {
        cusp::machine::StoredState state{};
        CHECK_FALSE(state.settings.put(110, 4321));
        CHECK_FALSE(state.settings.put(802, 12345));
        CHECK_FALSE(state.settings.put(792, 1));
        CHECK_FALSE(state.settings.put(341, 3));
        state.build.set("A MILL");
        const PowerCycle again{store_with(record_of(state, layout))};
        CHECK_FALSE(has_text(again.greeting, "error"));
        DOUBLES_EQUAL(4321, value_of(again, 110), 0);
        DOUBLES_EQUAL(12345, value_of(again, 802), 0);
        DOUBLES_EQUAL(1, value_of(again, 792), 0);
        DOUBLES_EQUAL(3, value_of(again, 341), 0);
        DOUBLES_EQUAL(40, value_of(again, 820), 0);
        DOUBLES_EQUAL(5, value_of(again, 347), 0);
    }
}

// A version that nobody knows: a message says so, and the machine is locked.
TEST(Store, TellsOfSettingsOfAnUnknownVersion)
{
    std::vector<std::uint8_t> record = cusp::record_of_layout_4();
    record[record.size() - 4] = 0x77;
    const PowerCycle again{store_with(record)};
    CHECK(has_text(again.greeting, "error:7"));
    CHECK(has_text(again.greeting, "[MSG:Settings lost"));
}

// One by one: what is out of its range and what contradicts; the rest is kept.
TEST(Store, ReplacesOnlyTheValuesThatItCanNotUse)
{
    cusp::machine::StoredState state{};
    CHECK_FALSE(state.settings.put(110, 4321));
    CHECK_FALSE(state.settings.put(121, 1e6F));  // with $801 a filter of 20 s
    CHECK_FALSE(state.settings.put(20, 1));      // without homing
    std::vector<std::uint8_t> record = record_of(state, 4);
    const float none = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(record.data(), &none, sizeof none);  // $0
    record.resize(record.size() - 8);
    cusp::protocol::Crc32 crc;
    crc.add(cusp::Span<const std::uint8_t>{record.data(), record.size()});
    for (const std::uint32_t word : {crc.value(), 0x43555304U}) {
        for (unsigned shift = 0; shift < 32; shift += 8) {
            record.push_back(static_cast<std::uint8_t>(word >> shift));
        }
    }
    const PowerCycle again{store_with(record)};
    CHECK(has_text(again.greeting, "[MSG:Settings damaged: some are defaults"));
    CHECK(again.app->machine().state() == cusp::machine::State::kAlarm);
    CHECK(again.app->machine().settings().sound());
    DOUBLES_EQUAL(4321, value_of(again, 110), 0);
    DOUBLES_EQUAL(2, value_of(again, 0), 0);
    DOUBLES_EQUAL(1000, value_of(again, 121), 0);
    DOUBLES_EQUAL(0, value_of(again, 20), 0);
}
