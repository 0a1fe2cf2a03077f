// Drives against models of TMC5160 drives on one bus, bit by bit.
#include <array>
#include <utility>

#include "CppUTest/TestHarness.h"

#include "firmware/drives/drives.hpp"
#include "firmware/drives/tmc5160.hpp"
#include "tests/support/tmc5160_model.hpp"

using namespace cusp;
using namespace cusp::drives;
using test::Tmc5160Model;

namespace {

constexpr std::uint8_t kThree = 7;  // X, Y, Z
constexpr unsigned kBusSetTime = 300;

class Bus {
public:
    Bus()
    {
        for (unsigned drive = 0; drive < kMostDrives; ++drive) {
            registers[drive] =
                registers_for(DriveKind::kTmc5160,
                              {500.0F + 700.0F * static_cast<float>(drive), 50, 16, 0, 800, 75});
        }
        drives.configure(registers, kThree);
        drives.restart(tick);
    }
    // So many ticks; requests are answered at once.
    void run(unsigned ticks)
    {
        for (unsigned i = 0; i < ticks; ++i, ++tick) {
            if (const auto request = drives.next(tick)) {
                CHECK_TRUE(request->kind == DriveKind::kTmc5160 && request->replies);
                exchange(request->drive, request->bytes);
                drives.take(exchange(request->drive, zeros()).span(), tick);
            }
        }
    }
    void fails(unsigned drive, FaultKind kind)
    {
        CHECK_TRUE(drives.fault().has_value());
        UNSIGNED_LONGS_EQUAL(drive, drives.fault()->drive);
        CHECK_TRUE(drives.fault()->kind == kind);
        CHECK_TRUE(drives.fault()->wanted == DriveKind::kTmc5160);
        CHECK_FALSE(drives.ready());
        CHECK_FALSE(drives.may_have_current());
    }
    std::uint32_t held(unsigned drive, std::uint32_t place) const
    {
        return models[drive].registers().at(place);
    }

    std::array<DriveRegisters, kMostDrives> registers{};
    Drives drives;
    std::array<Tmc5160Model, kMostDrives> models;
    std::uint32_t tick{0xFFFFFFC0};  // it wraps soon
    bool pulled_up{true};            // the line that the drives answer on
    bool clock_broken{false};

private:
    static Datagram zeros()
    {
        Datagram datagram;
        for (unsigned i = 0; i < tmc5160::kReplySize; ++i) {
            static_cast<void>(datagram.try_push_back(0));
        }
        return datagram;
    }
    // Mode 3: the clock rests high; both ends change their line as it falls and read as it rises.
    Datagram exchange(unsigned drive, const Datagram& bytes)
    {
        Datagram answer;
        bool data = false;
        const auto set = [this, drive, &data](bool clock) {
            for (unsigned i = 0; i < kMostDrives; ++i) {
                models[i].set_pins(i != drive, clock || clock_broken, data);
            }
        };
        set(true);
        for (const std::uint8_t byte : bytes) {
            unsigned heard = 0;
            for (unsigned bit = 8; bit > 0; --bit) {
                data = (byte >> (bit - 1) & 1U) != 0;
                set(false);
                heard = heard << 1U | (models[drive].data_out().value_or(pulled_up) ? 1U : 0U);
                set(true);
            }
            static_cast<void>(answer.try_push_back(static_cast<std::uint8_t>(heard)));
        }
        models[drive].set_pins(true, true, data);
        return answer;
    }
};

}  // namespace

TEST_GROUP(BusDrives)
{
    Bus bus;

    void teardown() override
    {
        for (const Tmc5160Model& model : bus.models) {
            UNSIGNED_LONGS_EQUAL(0, model.violations().size());
        }
    }
};

TEST(BusDrives, are_ready_once_each_holds_what_it_shall)
{
    for (unsigned i = 0; i < kBusSetTime && !bus.drives.ready(); ++i) {
        CHECK_FALSE(bus.drives.may_have_current());
        bus.run(1);
    }
    CHECK_TRUE(bus.drives.ready());
    CHECK_TRUE(bus.drives.may_have_current());
    for (unsigned drive = 0; drive < 3; ++drive) {
        const DriveRegisters& wanted = bus.registers[drive];
        UNSIGNED_LONGS_EQUAL(wanted.global_settings, bus.held(drive, Tmc5160Model::kGconf));
        UNSIGNED_LONGS_EQUAL(0, bus.held(drive, Tmc5160Model::kGstat));
        UNSIGNED_LONGS_EQUAL(wanted.scaler, bus.held(drive, Tmc5160Model::kGlobalScaler));
        UNSIGNED_LONGS_EQUAL(wanted.currents, bus.held(drive, Tmc5160Model::kIholdIrun));
        UNSIGNED_LONGS_EQUAL(20, bus.held(drive, Tmc5160Model::kTpowerdown));
        UNSIGNED_LONGS_EQUAL(wanted.chopper, bus.held(drive, Tmc5160Model::kChopconf));
        UNSIGNED_LONGS_EQUAL(0, bus.models[drive].damaged());
    }
    UNSIGNED_LONGS_EQUAL(0, bus.models[3].answers());
}

TEST(BusDrives, a_socket_without_a_drive_is_found_however_its_line_is_pulled)
{
    for (const bool up : {true, false}) {
        Bus fresh;
        fresh.pulled_up = up;
        fresh.models[1].missing = true;
        fresh.run(kBusSetTime);
        fresh.fails(1, FaultKind::kSilent);
    }
}

TEST(BusDrives, a_drive_that_falls_silent_while_it_is_watched_is_found)
{
    for (const bool up : {true, false}) {
        Bus fresh;
        fresh.pulled_up = up;
        fresh.run(kBusSetTime);
        CHECK_TRUE(fresh.drives.ready());
        fresh.models[2].missing = true;
        fresh.run(120);
        fresh.fails(2, FaultKind::kSilent);
    }
}

TEST(BusDrives, a_broken_clock_is_found)
{
    bus.clock_broken = true;
    bus.run(kBusSetTime);
    bus.fails(0, FaultKind::kSilent);
}

TEST(BusDrives, another_chip_is_found)
{
    bus.models[1].version = 0x21;
    bus.run(kBusSetTime);
    bus.fails(1, FaultKind::kOtherChip);
}

TEST(BusDrives, a_drive_that_does_not_keep_its_registers_is_found)
{
    bus.models[0].deaf = true;
    bus.run(kBusSetTime);
    bus.fails(0, FaultKind::kUnset);
}

// The bit that is wrong is that of the temperature, too.
TEST(BusDrives, two_wrong_answers_are_borne_and_no_more)
{
    bus.models[0].garbled = 2;
    bus.run(kBusSetTime);
    CHECK_TRUE(bus.drives.ready());
    for (unsigned i = 0; i < 40; ++i) {
        bus.run(13);
        bus.models[i % 3].garbled = 1 + i % 2;
        bus.run(100);
        CHECK_TRUE(bus.drives.ready());
    }
    bus.models[1].garbled = 1000;
    bus.run(200);
    CHECK_TRUE(bus.drives.fault().has_value());
    UNSIGNED_LONGS_EQUAL(1, bus.drives.fault()->drive);
}

TEST(BusDrives, faults_are_seen_while_watching)
{
    const std::pair<unsigned, FaultKind> faults[] = {
        {25, FaultKind::kHot},   {27, FaultKind::kShort}, {28, FaultKind::kShort},
        {12, FaultKind::kShort}, {13, FaultKind::kShort},
    };
    for (const auto& [bit, kind] : faults) {
        Bus fresh;
        fresh.run(kBusSetTime);
        // A warning, open coils, a stall, full steps, stealthChop and stand-still are none.
        constexpr std::uint32_t kNoFaults = 0xE500C3FF & ~(3U << 12U);
        fresh.models[2].set_status(kNoFaults);
        fresh.run(200);
        CHECK_TRUE(fresh.drives.ready());
        fresh.models[2].set_status(kNoFaults | 1U << bit);
        fresh.run(150);
        fresh.fails(2, kind);
    }
}

TEST(BusDrives, a_supply_that_was_gone_or_sank_is_seen)
{
    bus.run(kBusSetTime);
    bus.models[0].power_up();
    bus.run(150);
    bus.fails(0, FaultKind::kRestarted);
    Bus other;
    other.run(kBusSetTime);
    other.models[1].starve();
    other.run(150);
    other.fails(1, FaultKind::kUndervoltage);
    other.drives.restart(other.tick);
    other.run(kBusSetTime);
    CHECK_TRUE(other.drives.ready());
}
