// The settings store under power cuts at every write, and under damage.
#include <array>
#include <cstdint>
#include <optional>
#include <variant>

#include "CppUTest/TestHarness.h"

#include "firmware/machine/settings_log.hpp"
#include "hal/sim/simulated_store.hpp"

using cusp::Span;
using cusp::hal::SimulatedStore;
using cusp::machine::LogState;
using cusp::machine::SettingsLog;

namespace {

// Large, so that a sector holds few and is filled often.
using Record = std::array<std::uint8_t, 2400>;

Record record_of(std::uint32_t version)
{
    Record record{};
    std::uint32_t x = version * 2654435761U + 12345U;
    for (std::uint8_t& byte : record) {
        x = x * 1664525U + 1013904223U;
        byte = static_cast<std::uint8_t>(x >> 24U);
    }
    return record;
}

bool append(SimulatedStore& store, std::uint32_t version)
{
    SettingsLog<SimulatedStore> log{store};
    Record held{};
    (void)log.load(held);
    return log.append(record_of(version));
}

LogState load(SimulatedStore& store, Record& record)
{
    SettingsLog<SimulatedStore> log{store};
    return log.load(record);
}

}  // namespace

TEST_GROUP(SettingsStore){};

TEST(SettingsStore, IsEmptyWhenErased)
{
    SimulatedStore store;
    Record record = record_of(7);
    CHECK(load(store, record) == LogState::kEmpty);
    CHECK(record == record_of(7));
}

TEST(SettingsStore, KeepsTheNewestRecordThroughManyErases)
{
    SimulatedStore store;
    SettingsLog<SimulatedStore> log{store};
    Record record{};
    (void)log.load(record);
    for (std::uint32_t version = 1; version < 60; ++version) {
        CHECK(log.append(record_of(version)));
        CHECK(load(store, record) == LogState::kGood);
        CHECK(record == record_of(version));
    }
}

TEST(SettingsStore, HoldsAGoodRecordAfterAPowerCutAtEveryWordOfEveryWrite)
{
    constexpr std::uint32_t kVersions = 14;  // more than two sectors hold
    for (std::uint32_t version = 1; version <= kVersions; ++version) {
        SimulatedStore before;
        for (std::uint32_t earlier = 1; earlier < version; ++earlier) {
            CHECK(append(before, earlier));
        }
        // Every word where the log is new or changes to the other sector; samples in between.
        const bool plain = version > 1 && version % 6 != 0 && version % 6 != 1;
        for (std::uint64_t words = 0;; words += plain ? 17 : 1) {
            SimulatedStore store = before;
            store.cut_power_after(words);
            const bool said_done = append(store, version);
            store.cut_power_after(std::nullopt);
            Record record{};
            const LogState state = load(store, record);
            const bool is_new = state != LogState::kEmpty && record == record_of(version);
            const bool is_old = version > 1 && record == record_of(version - 1);
            const bool never =
                version == 1 && !is_new && (state == LogState::kEmpty || state == LogState::kLost);
            CHECK(is_new || is_old || never);
            CHECK(!said_done || is_new);
            // The store accepts the next record.
            CHECK(append(store, version + 1));
            CHECK(load(store, record) == LogState::kGood);
            CHECK(record == record_of(version + 1));
            if (said_done) {
                break;
            }
        }
    }
}

TEST(SettingsStore, ReportsDamageOfTheNewestRecordAndFallsBackToTheOneBefore)
{
    for (std::uint32_t offset = 2416; offset < 2 * 2416; offset += 7) {
        SimulatedStore store;
        CHECK(append(store, 1));
        CHECK(append(store, 2));
        store.damage(0, offset, 0x10);
        Record record{};
        const LogState state = load(store, record);
        // Damage to the mark itself looks like an interrupted write, and is reported as one.
        CHECK(state == LogState::kDamaged || state == LogState::kInterrupted);
        CHECK(record == record_of(1));
    }
}

TEST(SettingsStore, SaysThatAllIsLostWhereNoRecordIsGood)
{
    SimulatedStore store;
    CHECK(append(store, 1));
    store.damage(0, 100, 1);
    Record record{};
    CHECK(load(store, record) == LogState::kLost);
    CHECK(append(store, 2));
    CHECK(load(store, record) == LogState::kGood);
    CHECK(record == record_of(2));
}
