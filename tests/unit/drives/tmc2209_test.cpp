// Datagrams and registers of the TMC2209, against bytes that other programs send and the data sheet's formulas.
#include "firmware/drives/tmc2209.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::drives;

namespace {

std::vector<int> bytes_of(const Datagram& datagram) { return {datagram.begin(), datagram.end()}; }
void is(const std::vector<int>& expected, const Datagram& datagram)
{
    CHECK_TRUE(expected == bytes_of(datagram));
}
// mA that a drive with these registers gives: section 9 of the data sheet.
double current(const DriveRegisters& registers, unsigned place, double sense_ohms = 0.110)
{
    const double full_scale = (registers.chopper >> 17U & 1U) != 0 ? 0.180 : 0.325;
    const double scale = (registers.currents >> place & 31U) + 1;
    return scale / 32 * full_scale / (sense_ohms + 0.020) / std::sqrt(2.0) * 1000;
}

}  // namespace

TEST_GROUP(Tmc2209Datagrams){};

TEST(Tmc2209Datagrams, read_requests_have_the_checksums_that_drives_answer_to)
{
    is({0x05, 0x00, 0x00, 0x48}, tmc2209::read_request(Register::kGlobalSettings));
    is({0x05, 0x00, 0x01, 0xC1}, tmc2209::read_request(Register::kGlobalStatus));
    is({0x05, 0x00, 0x02, 0x8F}, tmc2209::read_request(Register::kWriteCount));
    is({0x05, 0x00, 0x06, 0x6F}, tmc2209::read_request(Register::kInputs));
    is({0x05, 0x00, 0x6C, 0xCA}, tmc2209::read_request(Register::kChopper));
    is({0x05, 0x00, 0x6F, 0x84}, tmc2209::read_request(Register::kStatus));
}

TEST(Tmc2209Datagrams, a_write_has_the_highest_byte_first)
{
    const Datagram request = tmc2209::write_request(Register::kChopper, 0x12345678);
    const std::vector<int> bytes = bytes_of(request);
    CHECK_TRUE((std::vector<int>{0x05, 0x00, 0xEC, 0x12, 0x34, 0x56, 0x78} ==
                std::vector<int>(bytes.begin(), bytes.end() - 1)));
    UNSIGNED_LONGS_EQUAL(tmc2209::crc8(Span<const std::uint8_t>{request.span()}.first(7)),
                         request[7]);
}

TEST(Tmc2209Datagrams, an_answer_gives_its_value)
{
    std::array<std::uint8_t, tmc2209::kReplySize> answer{0x05, 0xFF, 0x06, 0x21,
                                                         0x00, 0x01, 0x40, 0};
    answer[7] = tmc2209::crc8(Span<const std::uint8_t>{answer.data(), 7});
    const auto value = tmc2209::parse_reply(answer, Register::kInputs);
    CHECK_TRUE(value.has_value());
    UNSIGNED_LONGS_EQUAL(0x21000140, *value);
}

TEST(Tmc2209Datagrams, no_single_wrong_bit_passes)
{
    std::array<std::uint8_t, tmc2209::kReplySize> answer{0x05, 0xFF, 0x6F, 0x80,
                                                         0x10, 0x02, 0x33, 0};
    answer[7] = tmc2209::crc8(Span<const std::uint8_t>{answer.data(), 7});
    for (unsigned bit = 0; bit < 8 * tmc2209::kReplySize; ++bit) {
        auto wrong = answer;
        wrong[bit / 8] = static_cast<std::uint8_t>(wrong[bit / 8] ^ 1U << bit % 8);
        CHECK_FALSE(tmc2209::parse_reply(wrong, Register::kStatus).has_value());
    }
    CHECK_FALSE(tmc2209::parse_reply(answer, Register::kInputs).has_value());
    CHECK_FALSE(tmc2209::parse_reply(Span<const std::uint8_t>{answer.data(), 7}, Register::kStatus)
                    .has_value());
    CHECK_FALSE(tmc2209::parse_reply({}, Register::kStatus).has_value());
}

TEST_GROUP(Tmc2209Registers){};

TEST(Tmc2209Registers, the_current_is_the_next_lower_one_that_the_drive_has)
{
    for (int asked = 50; asked <= 1700; ++asked) {
        const DriveRegisters registers =
            tmc2209::registers_for({static_cast<float>(asked), 40, 16, 0, 800, 110});
        const double run = current(registers, 8);
        const double hold = current(registers, 0);
        const double step = asked <= 979 ? 30.6 : 55.3;
        CHECK_TRUE(run <= asked + 0.01 && run > asked - step);
        CHECK_TRUE(hold <= run * 0.4 + 0.01 || (registers.currents & 31U) == 0);
        CHECK_TRUE(hold > run * 0.4 - step);
    }
}

TEST(Tmc2209Registers, more_than_the_drive_gives_is_its_most)
{
    const DriveRegisters registers = tmc2209::registers_for({1700, 100, 16, 0, 800, 220});
    UNSIGNED_LONGS_EQUAL(31, registers.currents >> 8U & 31U);
    UNSIGNED_LONGS_EQUAL(31, registers.currents & 31U);
    UNSIGNED_LONGS_EQUAL(0, registers.chopper >> 17U & 1U);
}

TEST(Tmc2209Registers, microsteps_are_a_power_of_two)
{
    std::uint32_t bits = 8;
    for (std::uint32_t microsteps = 1; microsteps <= 256; microsteps *= 2) {
        const DriveRegisters registers = tmc2209::registers_for({500, 50, microsteps, 0, 800, 110});
        UNSIGNED_LONGS_EQUAL(bits, registers.chopper >> 24U & 15U);
        --bits;
    }
}

TEST(Tmc2209Registers, a_speed_for_stealth_chop_is_a_time_between_fine_steps)
{
    // 600 mm/min at 800 steps/mm are 8000 steps/s, 128000 of 1/256: 93.75 clocks of 12 MHz.
    const DriveRegisters silent = tmc2209::registers_for({500, 50, 16, 600, 800, 110});
    UNSIGNED_LONGS_EQUAL(93, silent.stealth_limit);
    UNSIGNED_LONGS_EQUAL(0, silent.global_settings >> 2U & 1U);
    const DriveRegisters spread = tmc2209::registers_for({500, 50, 16, 0, 800, 110});
    UNSIGNED_LONGS_EQUAL(0, spread.stealth_limit);
    UNSIGNED_LONGS_EQUAL(1, spread.global_settings >> 2U & 1U);
    UNSIGNED_LONGS_EQUAL((1U << 20U) - 1,
                         tmc2209::registers_for({500, 50, 256, 0.001F, 0.001F, 110}).stealth_limit);
    UNSIGNED_LONGS_EQUAL(1, tmc2209::registers_for({500, 50, 1, 120000, 10000, 110}).stealth_limit);
}
