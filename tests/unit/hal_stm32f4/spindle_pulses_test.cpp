// Rate, duty and polarity of the spindle's pulses, in the registers of every timer that can make them.
#include "hal/stm32f4/spindle_pulses.hpp"

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::hal::stm32f4;

namespace {

struct PlainWord {
    std::uint32_t value{0};
    std::uint32_t read() const { return value; }
    void write(std::uint32_t to) { value = to; }
};
using PlainTimer = Timer<PlainWord>;

struct PulseChip {
    static inline std::array<PlainTimer, 13> timers{};
    static inline Gpio<PlainWord> pins{};
    static PlainTimer& timer1() { return timers[1]; }
    static PlainTimer& timer3() { return timers[3]; }
    static PlainTimer& timer4() { return timers[4]; }
    static PlainTimer& timer8() { return timers[8]; }
    static PlainTimer& timer9() { return timers[9]; }
    static PlainTimer& timer12() { return timers[12]; }
    static Gpio<PlainWord>& port(char /*letter*/) { return pins; }
};

template <char Port, unsigned Number, unsigned Channel, unsigned TimerNumber>
struct PulsePlace {
    static constexpr PulsePin kPulses{{Port, Number}, Channel, TimerNumber};
    static constexpr std::uint32_t kFastTimerHz = 168000000;
    static constexpr std::uint32_t kSlowTimerHz = 84000000;
};

const PlainWord& compare_of(const PlainTimer& timer, unsigned channel)
{
    return channel == 1   ? timer.ccr1
           : channel == 2 ? timer.ccr2
           : channel == 3 ? timer.ccr3
                          : timer.ccr4;
}

// Sets rates and duties and reads them back from the registers, by the manual's own words: the counter
// runs at hz / (PSC + 1) and a period has ARR + 1 counts, of which CCR are high.
template <class Place>
void judge()
{
    PulseChip::timers = {};
    PulseChip::pins = {};
    using Pulses = SpindlePulses<PulseChip, Place>;
    constexpr PulsePin kPin = Place::kPulses;
    PlainTimer& timer = PulseChip::timers[kPin.timer];
    const bool fast = kPin.timer == 1 || kPin.timer == 8 || kPin.timer == 9;
    const double counted = fast ? 168e6 : 84e6;
    Pulses::start();
    for (const std::uint32_t hz : {1U, 50U, 1000U, 4999U, 5000U, 20000U, 100000U}) {
        Pulses::set_rate(hz);
        const double period = timer.arr.value + 1.0;
        CHECK(timer.arr.value < 65536 && timer.psc.value < 65536);
        DOUBLES_EQUAL(hz, counted / (timer.psc.value + 1.0) / period, hz * 2e-3);
        for (const unsigned duty : {0U, 1U, 777U, 25000U, 49999U, unsigned{kFullDuty}}) {
            Pulses::set_duty(static_cast<std::uint16_t>(duty), false);
            const std::uint32_t high = compare_of(timer, kPin.channel).value;
            DOUBLES_EQUAL(duty / double{kFullDuty}, high / period, 1.0 / period);
            CHECK((duty == 0) == (high == 0));
        }
    }
    CHECK_EQUAL(1U, timer.ccer.value >> 4 * (kPin.channel - 1) & 3U);
    Pulses::set_duty(0, true);
    CHECK_EQUAL(3U, timer.ccer.value >> 4 * (kPin.channel - 1) & 3U);
    // Only timers 1 and 8 have a main output enable.
    CHECK_EQUAL(kPin.timer == 1 || kPin.timer == 8, (timer.bdtr.value >> 15U & 1U) == 1);
    const unsigned shift = kPin.pin.number % 8 * 4;
    const std::uint32_t function =
        (kPin.pin.number < 8 ? PulseChip::pins.afrl : PulseChip::pins.afrh).value >> shift & 15U;
    const unsigned expected = kPin.timer == 1    ? 1U
                              : kPin.timer <= 4  ? 2U
                              : kPin.timer == 12 ? 9U
                                                 : 3U;
    CHECK_EQUAL(expected, function);
}

}  // namespace

TEST_GROUP(SpindlePulses){};

TEST(SpindlePulses, HaveTheirRateAndDutyOnEveryTimer)
{
    judge<PulsePlace<'A', 9, 2, 1>>();
    judge<PulsePlace<'B', 0, 3, 3>>();
    judge<PulsePlace<'D', 15, 4, 4>>();
    judge<PulsePlace<'C', 6, 1, 8>>();
    judge<PulsePlace<'E', 6, 2, 9>>();
    judge<PulsePlace<'B', 14, 1, 12>>();
}

TEST(SpindlePulses, AreOnNoOtherPins)
{
    CHECK(has_channel({{'B', 9}, 4, 4}));
    CHECK_FALSE(has_channel({{'B', 9}, 3, 4}));
    CHECK_FALSE(has_channel({{'A', 0}, 1, 5}));
    CHECK(pulse_timer(5) == nullptr && pulse_timer(2) == nullptr && pulse_timer(11) == nullptr);
}
