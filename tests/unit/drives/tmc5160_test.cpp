// Datagrams and registers of the TMC5160, against the data sheet's examples and formulas.
#include "firmware/drives/tmc5160.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::drives;

namespace {

void sends(const std::vector<int>& expected, const Datagram& datagram)
{
    CHECK_TRUE(expected == std::vector<int>(datagram.begin(), datagram.end()));
}
// mA that a drive with these registers gives: section 9 of the data sheet.
double current_5160(const DriveRegisters& registers, unsigned place, double sense_ohms = 0.075)
{
    const double scaler = registers.scaler == 0 ? 256 : registers.scaler;
    const double scale = (registers.currents >> place & 31U) + 1;
    return scaler / 256 * scale / 32 * 0.325 / sense_ohms / std::sqrt(2.0) * 1000;
}
DriveRegisters standard(float milliamperes, float hold = 50)
{
    return tmc5160::registers_for({milliamperes, hold, 16, 0, 800, 75});
}

}  // namespace

TEST_GROUP(Tmc5160Datagrams){};

// Section 4.1.1: a read of DRV_STATUS; section 23: a write of CHOPCONF.
TEST(Tmc5160Datagrams, are_those_of_the_data_sheet)
{
    sends({0x6F, 0, 0, 0, 0}, tmc5160::read_request(Register::kStatus));
    sends({0x04, 0, 0, 0, 0}, tmc5160::read_request(Register::kBusInputs));
    sends({0xEC, 0x00, 0x01, 0x00, 0xC3}, tmc5160::write_request(Register::kChopper, 0x000100C3));
    sends({0x90, 0x00, 0x06, 0x1F, 0x0A}, tmc5160::write_request(Register::kCurrents, 0x00061F0A));
}

TEST(Tmc5160Datagrams, an_answer_gives_its_word)
{
    const std::array<std::uint8_t, tmc5160::kReplySize> answer{0x09, 0x30, 0x00, 0x01, 0x40};
    UNSIGNED_LONGS_EQUAL(0x30000140, *tmc5160::parse_reply(answer));
}

TEST(Tmc5160Datagrams, a_line_that_nobody_drives_is_no_answer)
{
    const std::array<std::uint8_t, tmc5160::kReplySize> high{0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
    CHECK_FALSE(tmc5160::parse_reply(high).has_value());
    CHECK_FALSE(tmc5160::parse_reply(Span<const std::uint8_t>{high.data(), 4}).has_value());
    CHECK_FALSE(tmc5160::parse_reply({}).has_value());
}

TEST_GROUP(Tmc5160Registers){};

TEST(Tmc5160Registers, the_current_is_the_next_lower_one_that_the_drive_has)
{
    for (int asked = 50; asked <= 3000; ++asked) {
        const DriveRegisters registers = standard(static_cast<float>(asked), 40);
        const double run = current_5160(registers, 8);
        const double hold = current_5160(registers, 0);
        // From 32 on the scaler alone gives it, in steps of a 256th of 3.06 A.
        CHECK_TRUE(run <= asked + 0.01 && run > asked - 12.0);
        CHECK_TRUE(hold <= run * 0.4 + 0.01 || (registers.currents & 31U) == 0);
        const double step = run / ((registers.currents >> 8U & 31U) + 1);
        CHECK_TRUE(hold > run * 0.4 - step);
        CHECK_TRUE(registers.scaler == 0 || (registers.scaler >= 32 && registers.scaler < 256));
        CHECK_TRUE(asked < 400 || (registers.currents >> 8U & 31U) >= 16);
    }
}

TEST(Tmc5160Registers, more_than_the_drive_gives_is_its_most)
{
    const DriveRegisters registers = standard(3200, 100);
    UNSIGNED_LONGS_EQUAL(0, registers.scaler);
    UNSIGNED_LONGS_EQUAL(31, registers.currents >> 8U & 31U);
    UNSIGNED_LONGS_EQUAL(31, registers.currents & 31U);
    UNSIGNED_LONGS_EQUAL(0, tmc5160::registers_for({3000, 50, 16, 0, 800, 220}).scaler);
}

TEST(Tmc5160Registers, microsteps_are_a_power_of_two_and_the_stage_is_on)
{
    std::uint32_t bits = 8;
    for (std::uint32_t microsteps = 1; microsteps <= 256; microsteps *= 2) {
        const DriveRegisters registers = tmc5160::registers_for({500, 50, microsteps, 0, 800, 75});
        UNSIGNED_LONGS_EQUAL(bits, registers.chopper >> 24U & 15U);
        // The rest as after its reset, but TOFF.
        UNSIGNED_LONGS_EQUAL(0x10410153, registers.chopper & ~(15U << 24U));
        --bits;
    }
}

TEST(Tmc5160Registers, a_speed_for_stealth_chop_is_a_time_between_fine_steps)
{
    // 600 mm/min at 800 steps/mm are 8000 steps/s, 128000 of 1/256: 93.75 clocks of 12 MHz.
    const DriveRegisters silent = tmc5160::registers_for({500, 50, 16, 600, 800, 75});
    UNSIGNED_LONGS_EQUAL(93, silent.stealth_limit);
    UNSIGNED_LONGS_EQUAL(0xC, silent.global_settings);
    const DriveRegisters spread = standard(500);
    UNSIGNED_LONGS_EQUAL(0, spread.stealth_limit);
    UNSIGNED_LONGS_EQUAL(0x8, spread.global_settings);
}
