// Drives against drives that are a map of registers each.
#include "firmware/drives/drives.hpp"

#include <map>
#include <random>
#include <string>

#include "CppUTest/TestHarness.h"

#include "firmware/drives/tmc2209.hpp"

using namespace cusp;
using namespace cusp::drives;

namespace {

struct FakeDrive {
    std::map<unsigned, std::uint32_t> registers{{0, 0x141}, {1, 1}, {2, 250}, {6, 0x21000000}};
    unsigned silent{0};   // so many answers are not given
    unsigned garbled{0};  // so many are wrong
    bool forgets{false};
    unsigned requests{0};
};

class Bench {
public:
    Bench()
    {
        for (unsigned drive = 0; drive < kMostDrives; ++drive) {
            registers[drive] = tmc2209::registers_for(
                {500.0F + 100.0F * static_cast<float>(drive), 50, 16, 0, 800, 110});
        }
        drives.configure(registers, 7);
        drives.restart(tick);
    }
    // So many ticks; each datagram takes four.
    void run(unsigned ticks)
    {
        for (unsigned i = 0; i < ticks; ++i, ++tick) {
            if (drives.waits() && tick - sent_at >= 4) {
                drives.take(Span<const std::uint8_t>{answer.begin(), answer.size()}, tick);
            }
            if (const auto request = drives.next(tick)) {
                sent_at = tick;
                perform(*request);
            }
        }
    }
    void perform(const DriveRequest& request)
    {
        FakeDrive& drive = fakes[request.drive];
        ++drive.requests;
        answer.clear();
        const unsigned place = request.bytes[2] & 0x7FU;
        CHECK_EQUAL((request.bytes[2] & 0x80U) == 0, request.replies);
        if (!request.replies) {
            std::uint32_t value = 0;
            for (unsigned i = 3; i < 7; ++i) {
                value = value << 8U | request.bytes[i];
            }
            if (!drive.forgets) {
                drive.registers[place] = place == 1 ? drive.registers[1] & ~value : value;
            }
            drive.registers[2] = (drive.registers[2] + 1) % 256;
            return;
        }
        if (drive.silent > 0) {
            --drive.silent;
            return;
        }
        (void)answer.try_push_back(5);
        (void)answer.try_push_back(0xFF);
        (void)answer.try_push_back(static_cast<std::uint8_t>(place));
        for (unsigned shift = 32; shift > 0; shift -= 8) {
            (void)answer.try_push_back(
                static_cast<std::uint8_t>(drive.registers[place] >> (shift - 8)));
        }
        const unsigned wrong = drive.garbled > 0 ? 1 : 0;
        drive.garbled -= wrong;
        (void)answer.try_push_back(static_cast<std::uint8_t>(tmc2209::crc8(answer.span()) ^ wrong));
    }
    void fails(unsigned drive, FaultKind kind)
    {
        CHECK_TRUE(drives.fault().has_value());
        UNSIGNED_LONGS_EQUAL(drive, drives.fault()->drive);
        CHECK_TRUE(drives.fault()->kind == kind);
        CHECK_FALSE(drives.ready());
        CHECK_FALSE(drives.may_have_current());
        const unsigned before = fakes[drive].requests;
        run(200);
        UNSIGNED_LONGS_EQUAL(before, fakes[drive].requests);
    }

    std::array<DriveRegisters, kMostDrives> registers{};
    Drives drives;
    std::array<FakeDrive, kMostDrives> fakes;
    Datagram answer;
    std::uint32_t tick{0xFFFFFFC0};  // it wraps soon
    std::uint32_t sent_at{0};
};

constexpr unsigned kSetTime = 400;

}  // namespace

TEST_GROUP(Drives) { Bench bench; };

TEST(Drives, are_ready_once_each_holds_what_it_shall)
{
    CHECK_FALSE(bench.drives.ready());
    for (unsigned i = 0; i < kSetTime && !bench.drives.ready(); ++i) {
        CHECK_FALSE(bench.drives.may_have_current());
        bench.run(1);
    }
    CHECK_TRUE(bench.drives.ready());
    CHECK_TRUE(bench.drives.may_have_current());
    for (unsigned drive = 0; drive < 3; ++drive) {
        auto& registers = bench.fakes[drive].registers;
        UNSIGNED_LONGS_EQUAL(bench.registers[drive].global_settings, registers[0x00]);
        UNSIGNED_LONGS_EQUAL(0, registers[0x01]);
        UNSIGNED_LONGS_EQUAL(bench.registers[drive].currents, registers[0x10]);
        UNSIGNED_LONGS_EQUAL(bench.registers[drive].chopper, registers[0x6C]);
    }
    UNSIGNED_LONGS_EQUAL(0, bench.fakes[3].requests);
}

TEST(Drives, a_board_without_any_is_ready_at_once)
{
    Drives none;
    none.restart(0);
    CHECK_TRUE(none.ready());
    CHECK_TRUE(none.may_have_current());
    CHECK_FALSE(none.next(1000).has_value());
}

TEST(Drives, two_lost_answers_are_asked_for_again_and_three_are_a_fault)
{
    bench.fakes[1].silent = 2;
    bench.fakes[2].garbled = 2;
    bench.run(kSetTime);
    CHECK_TRUE(bench.drives.ready());
    bench.fakes[1].silent = 3;
    bench.run(200);
    bench.fails(1, FaultKind::kSilent);
}

// Before each store, which may come at any rate.
TEST(Drives, requests_that_are_put_off_are_sent_anew_and_are_no_fault)
{
    for (unsigned i = 0; i < 20; ++i) {
        const std::uint32_t before = bench.tick;
        while (!bench.drives.waits()) {
            bench.run(1);
            CHECK_TRUE(bench.tick - before < kSetTime);
        }
        bench.drives.put_off(bench.tick);
        CHECK_FALSE(bench.drives.waits());
    }
    bench.run(kSetTime);
    CHECK_TRUE(bench.drives.ready());
    UNSIGNED_LONGS_EQUAL(bench.registers[1].currents, bench.fakes[1].registers[0x10]);
}

TEST(Drives, wrong_checksums_are_a_fault_of_that_drive)
{
    bench.fakes[2].garbled = 1000;
    bench.run(kSetTime);
    bench.fails(2, FaultKind::kGarbled);
}

TEST(Drives, a_drive_that_does_not_keep_its_registers_is_found)
{
    bench.fakes[0].forgets = true;
    bench.run(kSetTime);
    bench.fails(0, FaultKind::kUnset);
}

TEST(Drives, another_chip_is_found)
{
    bench.fakes[1].registers[6] = 0x20000000;
    bench.run(kSetTime);
    bench.fails(1, FaultKind::kOtherChip);
}

TEST(Drives, faults_are_seen_while_watching)
{
    const std::pair<unsigned, FaultKind> faults[] = {{1U << 1U, FaultKind::kHot},
                                                     {1U << 2U, FaultKind::kShort},
                                                     {1U << 3U, FaultKind::kShort},
                                                     {1U << 4U, FaultKind::kShort},
                                                     {1U << 5U, FaultKind::kShort}};
    for (const auto& [bit, kind] : faults) {
        Bench fresh;
        fresh.run(kSetTime);
        CHECK_TRUE(fresh.drives.ready());
        // A warning, open coils and stand-still are none.
        fresh.fakes[2].registers[0x6F] = 0xC01F00C1;
        fresh.run(200);
        CHECK_TRUE(fresh.drives.ready());
        fresh.fakes[2].registers[0x6F] |= bit;
        fresh.run(120);
        fresh.fails(2, kind);
    }
    bench.run(kSetTime);
    bench.fakes[0].registers[1] = 1;
    bench.run(120);
    bench.fails(0, FaultKind::kRestarted);
}

TEST(Drives, a_restart_sets_them_again_after_a_fault)
{
    bench.fakes[1].silent = 1000;
    bench.run(kSetTime);
    bench.fails(1, FaultKind::kSilent);
    bench.fakes[1].silent = 0;
    bench.drives.restart(bench.tick);
    CHECK_FALSE(bench.drives.fault().has_value());
    bench.run(kSetTime);
    CHECK_TRUE(bench.drives.ready());
}

TEST(Drives, other_settings_are_written_with_the_current_on)
{
    bench.run(kSetTime);
    bench.drives.configure(bench.registers, 7);
    CHECK_TRUE(bench.drives.ready());
    bench.registers[1] = tmc2209::registers_for({900, 20, 64, 0, 800, 110});
    bench.drives.configure(bench.registers, 7);
    CHECK_FALSE(bench.drives.ready());
    CHECK_TRUE(bench.drives.may_have_current());
    bench.run(kSetTime);
    CHECK_TRUE(bench.drives.ready());
    UNSIGNED_LONGS_EQUAL(bench.registers[1].chopper, bench.fakes[1].registers[0x6C]);
}

// Whenever it comes, amid a datagram too.
TEST(Drives, settings_that_change_at_any_time_end_in_the_last_ones)
{
    std::minstd_rand generator{20261129};
    const auto random = [&generator] {
        return static_cast<unsigned>(generator());
    };
    for (unsigned trial = 0; trial < 200; ++trial) {
        Bench fresh;
        std::uint8_t motors = 7;
        for (unsigned change = 0; change < 3; ++change) {
            fresh.run(random() % 150);
            if (random() % 4 == 0) {
                fresh.drives.restart(fresh.tick);
            }
            motors = static_cast<std::uint8_t>(1 + random() % 15);
            fresh.registers[random() % 4] = tmc2209::registers_for(
                {static_cast<float>(100 + random() % 1500), 50, 16, 0, 800, 110});
            fresh.drives.configure(fresh.registers, motors);
        }
        fresh.run(600);
        CHECK_TRUE(fresh.drives.ready());
        for (unsigned drive = 0; drive < kMostDrives; ++drive) {
            if ((motors >> drive & 1U) != 0) {
                UNSIGNED_LONGS_EQUAL(fresh.registers[drive].currents,
                                     fresh.fakes[drive].registers[0x10]);
            }
        }
    }
}
