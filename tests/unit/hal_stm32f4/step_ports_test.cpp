#include "hal/stm32f4/step_ports.hpp"

#include "CppUTest/TestHarness.h"

using namespace cusp::hal::stm32f4;
using cusp::PulseLines;

namespace {

struct ThreePorts {
    static constexpr LinePins kLines{{{'E', 2}, {'D', 5}, {'A', 15}, {'E', 1}, {'D', 4}, {'A', 8}}};
};
struct OnePort {
    static constexpr LinePins kLines{{{'C', 0}, {'C', 1}, {'C', 2}, {'C', 3}, {'C', 4}, {'C', 5}}};
};
// One port too, but not in the order of the lines.
struct TurnedPort {
    static constexpr LinePins kLines{{{'C', 5}, {'C', 4}, {'C', 3}, {'C', 2}, {'C', 1}, {'C', 0}}};
};
// The third port's letter is the second motor's too.
struct SecondMotor {
    static constexpr LinePins kLines{
        {{'E', 2}, {'D', 5}, {'A', 15}, {'E', 1}, {'D', 4}, {'A', 8}, {'D', 15}, {'D', 14}}};
};
using Two = StepPorts<SecondMotor>;
using Three = StepPorts<ThreePorts>;
using One = StepPorts<OnePort>;
using Turned = StepPorts<TurnedPort>;

static_assert(Two::kCount == 3 && Two::kAllLines == 0xFF && Three::kAllLines == 0x3F);
static_assert(Three::kCount == 3 && One::kCount == 1 && Turned::kCount == 1);
static_assert(Three::kLetters[0] == 'E' && Three::kLetters[1] == 'D' && Three::kLetters[2] == 'A');

}  // namespace

TEST_GROUP(StepPorts){};

TEST(StepPorts, GiveEachPortItsPinsOfTheLines)
{
    // Up: step X and direction Z; down: step Y.
    UNSIGNED_LONGS_EQUAL(1U << 2U, Three::word<0>(0x21, 0x02));
    UNSIGNED_LONGS_EQUAL(1U << 5U << 16U, Three::word<1>(0x21, 0x02));
    UNSIGNED_LONGS_EQUAL(1U << 8U, Three::word<2>(0x21, 0x02));
    UNSIGNED_LONGS_EQUAL(0x00020021, One::word<0>(0x21, 0x02));
    UNSIGNED_LONGS_EQUAL(0x00100021, Turned::word<0>(0x21, 0x02));
}

TEST(StepPorts, KnowEveryLineByThePinsOfAllPorts)
{
    for (unsigned lines = 0; lines <= Three::kAllLines; ++lines) {
        const auto wanted = static_cast<PulseLines>(lines);
        const unsigned found = Three::lines<0>(Three::pins<0>(wanted)) |
                               Three::lines<1>(Three::pins<1>(wanted)) |
                               Three::lines<2>(Three::pins<2>(wanted));
        UNSIGNED_LONGS_EQUAL(lines, found);
        UNSIGNED_LONGS_EQUAL(lines, Turned::lines<0>(Turned::pins<0>(wanted)));
    }
}

TEST(StepPorts, HaveRoomForASecondMotor)
{
    for (unsigned lines = 0; lines <= Two::kAllLines; ++lines) {
        const auto wanted = static_cast<PulseLines>(lines);
        const unsigned found = Two::lines<0>(Two::pins<0>(wanted)) |
                               Two::lines<1>(Two::pins<1>(wanted)) |
                               Two::lines<2>(Two::pins<2>(wanted));
        UNSIGNED_LONGS_EQUAL(lines, found);
    }
    UNSIGNED_LONGS_EQUAL(1U << 15U | 1U << 14U << 16U, Two::word<1>(0x40, 0x80));
}
