// The table of settings, their ranges, and the conditions between them.
#include "firmware/machine/settings.hpp"

#include <cmath>

#include "firmware/base/path_units.hpp"
#include "firmware/machine/report_units.hpp"

namespace cusp::machine {
namespace {

constexpr float kAllAxes = (1U << kAxisCount) - 1;  // a mask
constexpr float kMostAny = 1e7F;
constexpr float kMostJerk = 1e10F;
constexpr float kLeastPositive = 0.001F;
constexpr float kLeastVibration = 10.0F;  // Hz
constexpr float kMostVibration = 200.0F;
constexpr float kMostDamping = 0.99F;
constexpr float kLongestFilter = 0.250F;  // s: the longest filter of the interpolator

// Settings of A: steps/degree, degrees/min, degrees/s^2, travel, its drive, play, degrees/s^3, pull-off.
constexpr std::size_t kRotarySettings = kHasRotaryAxis ? 11 : 0;
constexpr std::array<SettingEntry, 11> kOfRotary{
    {{103, 3, 88.889F, kLeastPositive, 10000, kLayoutWithRotary},
     {113, 3, 3600, kLeastPositive, 120000, kLayoutWithRotary},
     {123, 3, 500, kLeastPositive, kMostAny, kLayoutWithRotary},
     {133, 3, 0, 0, kMostAny, kLayoutWithRotary},
     {143, 0, 500, 50, 3000, kLayoutWithRotary},
     {153, 0, 16, 1, 256, kLayoutWithRotary},
     {163, 3, 0, 0, 10, kLayoutWithRotary},
     {213, 0, 50, 5, 100, kLayoutWithRotary},
     {843, 3, 0, 0, 120000, kLayoutWithRotary},
     {803, 3, 25000, kLeastPositive, kMostJerk, kLayoutWithRotary},
     {853, 3, 0, 0, 1000, kLayoutWithRotary}}};

constexpr std::array<SettingEntry, kSettingCount - kRotarySettings> kWithoutRotary{{
    {0, 0, 2, 1, 100},
    {1, 0, 25, 0, 255},
    {2, 0, 0, 0, 255},
    {3, 0, 0, 0, 255},
    {4, 0, 0, 0, 1},
    {5, 0, 0, 0, 1},
    {6, 0, 0, 0, 1},
    {10, 0, 3, 0, 255},
    {11, 3, 0.010F, 0, 10},
    {12, 3, 0.002F, 0, 10},
    {13, 0, 0, 0, 1},
    {20, 0, 0, 0, 1},
    {21, 0, 0, 0, 1},
    {22, 0, 0, 0, 1},
    {23, 0, 0, 0, 255},
    {24, 3, 25, kLeastPositive, kMostAny},
    {25, 3, 500, kLeastPositive, kMostAny},
    {26, 0, 250, 0, 10000},
    {27, 3, 1, kLeastPositive, 1000},
    {30, 0, 24000, 0, kMostAny},
    {31, 0, 0, 0, kMostAny},
    {32, 0, 0, 0, 1},
    {100, 3, 800, kLeastPositive, 10000},
    {101, 3, 800, kLeastPositive, 10000},
    {102, 3, 800, kLeastPositive, 10000},
    {110, 3, 6000, kLeastPositive, 120000},
    {111, 3, 6000, kLeastPositive, 120000},
    {112, 3, 3000, kLeastPositive, 120000},
    {120, 3, 1000, kLeastPositive, kMostAny},
    {121, 3, 1000, kLeastPositive, kMostAny},
    {122, 3, 500, kLeastPositive, kMostAny},
    {130, 3, 300, kLeastPositive, 100000},
    {131, 3, 200, kLeastPositive, 100000},
    {132, 3, 80, kLeastPositive, 100000},
    {8, 0, 0, 0, 7, 3},
    {14, 0, 0, 0, 511},
    {15, 0, 0, 0, 3},
    {16, 0, 0, 0, 7},
    {29, 0, 5, 1, 100},
    {33, 0, 1000, 1, 100000, 7},
    {34, 3, 0, 0, 100, 7},
    {35, 3, 0, 0, 100, 7},
    {36, 3, 100, 0, 100, 7},
    {37, 0, 0, 0, kAllAxes, 9},
    {44, 0, 4, 0, kAllAxes, 9},
    {45, 0, 3, 0, kAllAxes, 9},
    {46, 0, 0, 0, kAllAxes, 9},
    {140, 0, 500, 50, 3000, 8},
    {141, 0, 500, 50, 3000, 8},
    {142, 0, 500, 50, 3000, 8},
    {150, 0, 16, 1, 256, 8},
    {151, 0, 16, 1, 256, 8},
    {152, 0, 16, 1, 256, 8},
    {160, 3, 0, 0, 2, 9},
    {161, 3, 0, 0, 2, 9},
    {162, 3, 0, 0, 2, 9},
    {170, 3, 0, -10, 10, 3},
    {171, 3, 0, -10, 10, 3},
    {172, 3, 0, -10, 10, 3},
    {210, 0, 50, 5, 100, 8},
    {211, 0, 50, 5, 100, 8},
    {212, 0, 50, 5, 100, 8},
    {338, 0, 7, 0, kAllAxes, 8},
    {340, 0, 5, 1, 50, 10},
    {341, 0, 0, 0, 4, 2},
    {342, 3, 30, kLeastPositive, 1000, 2},
    {343, 3, 25, kLeastPositive, kMostAny, 2},
    {344, 3, 200, kLeastPositive, kMostAny, 2},
    {347, 3, 5, 0, 100, 3},
    {348, 3, 2.5F, kLeastPositive, 1000, 3},
    {349, 3, 25, kLeastPositive, 1000, 3},
    {374, 0, 3, 0, 5, 10},
    {375, 0, 50, 20, 1000, 10},
    {394, 3, 0, 0, 60, 5},
    {395, 0, 0, 0, 3, 10},
    {460, 0, 1, 1, 247, 10},
    {462, 0, 8192, 0, 65535, 10},
    {463, 0, 8193, 0, 65535, 10},
    {464, 0, 8451, 0, 65535, 10},
    {465, 0, 18, 0, 65535, 10},
    {466, 0, 34, 0, 65535, 10},
    {467, 0, 1, 0, 65535, 10},
    {468, 0, 50, 1, 65535, 10},
    {469, 0, 60, 1, 65535, 10},
    {470, 0, 60, 1, 65535, 10},
    {471, 0, 100, 1, 65535, 10},
    {481, 0, 0, 0, 1000, 7},
    {790, 0, 3, 0, 100},
    {791, 0, 0, 0, 600000},
    {792, 0, 0, 0, 1},
    {793, 0, 0, 0, kAxisCount, 3},
    {794, 0, 0, 0, 1, 3},
    {795, 0, 0, 0, 1, 5},
    {796, 0, 1, 0, 1, 6},
    {797, 0, 0, 0, 1, 7},
    {798, 0, 0, 0, kAllAxes, 11},
    {800, 3, 50000, kLeastPositive, kMostJerk},
    {801, 3, 50000, kLeastPositive, kMostJerk},
    {802, 3, 25000, kLeastPositive, kMostJerk},
    {810, 0, 0, 0, 3, 4},
    {811, 0, 0, 0, 3, 4},
    {812, 0, 0, 0, 3, 4},
    {820, 3, 40, kLeastVibration, kMostVibration, 4},
    {821, 3, 40, kLeastVibration, kMostVibration, 4},
    {822, 3, 40, kLeastVibration, kMostVibration, 4},
    {830, 3, 0.05F, 0, kMostDamping, 4},
    {831, 3, 0.05F, 0, kMostDamping, 4},
    {832, 3, 0.05F, 0, kMostDamping, 4},
    {840, 3, 0, 0, 120000, 8},
    {841, 3, 0, 0, 120000, 8},
    {842, 3, 0, 0, 120000, 8},
    {850, 3, 0, 0, 1000, 9},
    {851, 3, 0, 0, 1000, 9},
    {852, 3, 0, 0, 1000, 9},
}};

// All settings: each of A stands behind that of Z.
constexpr std::array<SettingEntry, kSettingCount> make_table() noexcept
{
    std::array<SettingEntry, kSettingCount> table{};
    std::size_t count = 0;
    for (const SettingEntry& entry : kWithoutRotary) {
        table[count++] = entry;
        for (std::size_t i = 0; i < kRotarySettings; ++i) {
            if (entry.number + 1 == kOfRotary[i].number) {
                table[count++] = kOfRotary[i];
            }
        }
    }
    return table;
}
constexpr std::array<SettingEntry, kSettingCount> kTable = make_table();

std::optional<std::size_t> find_index(std::uint32_t number) noexcept
{
    for (std::size_t i = 0; i < kSettingCount; ++i) {
        if (kTable[i].number == number) {
            return i;
        }
    }
    return std::nullopt;
}

bool is_power_of_two(float value) noexcept
{
    const auto whole = static_cast<std::uint32_t>(value);
    return whole != 0 && (whole & (whole - 1)) == 0;
}
bool is_microsteps(std::size_t index) noexcept
{
    return index >= index_of(Setting::kMicrosteps) &&
           index < index_of(Setting::kMicrosteps) + kAxisCount;
}

}  // namespace

std::size_t settings_in_layout(std::uint8_t layout) noexcept
{
    std::size_t count = 0;
    for (const SettingEntry& entry : kTable) {
        count += holds(layout, entry) ? 1U : 0U;
    }
    return count;
}

const SettingEntry& setting_entry(std::size_t index) noexcept { return kTable[index]; }

Settings::Settings() noexcept
{
    for (std::size_t i = 0; i < kSettingCount; ++i) {
        values_[i] = kTable[i].standard;
    }
}

std::optional<Error> Settings::put(std::uint32_t number, float value) noexcept
{
    const std::optional<std::size_t> index = find_index(number);
    if (!index) {
        return Error::kInvalidStatement;
    }
    const SettingEntry& entry = kTable[*index];
    if (value < 0 && entry.least >= 0) {
        return Error::kNegativeValue;
    }
    const bool is_switch = entry.least == 0 && entry.most == 1;
    const float whole = entry.decimals == 0 ? std::floor(value) : value;
    const float cut = is_switch && whole > 1 ? 1.0F : whole;
    if (cut < entry.least) {
        return number == 0 ? Error::kSettingStepPulseMin : Error::kNegativeValue;
    }
    if (cut > entry.most) {
        return Error::kGcodeMaxValueExceeded;
    }
    if (is_microsteps(*index) && !is_power_of_two(cut)) {
        return Error::kInvalidStatement;
    }
    values_[*index] = cut;
    // As in Grbl: without homing there are no soft limits.
    if (!on(Setting::kHoming) && number == kTable[index_of(Setting::kHoming)].number) {
        values_[index_of(Setting::kSoftLimits)] = 0;
    }
    return std::nullopt;
}

std::optional<SettingFault> Settings::find_fault(const BoardLimits& board) const noexcept
{
    struct Need {
        Setting setting;
        bool met;
    };
    for (const Need& need : {Need{Setting::kSecondMotor, board.second_motor},
                             Need{Setting::kAtSpeedInput, board.at_speed_input},
                             Need{Setting::kSpindleType, board.spindle_wire},
                             Need{Setting::kBusDrives, board.drive_bus}}) {
        if (on(need.setting) && !need.met) {
            return SettingFault{Error::kSettingDisabled, kTable[index_of(need.setting)].number};
        }
    }
    const auto most_rate = static_cast<float>(board.most_steps_per_second);
    constexpr float kMicrosecondsPerSecond = 1e6F;
    const float least_spacing = 2.0F * value(Setting::kStepPulse);
    for (unsigned axis = 0; axis < axes(); ++axis) {
        const auto number = [axis](Setting setting) {
            return kTable[index_of(setting, axis)].number;
        };
        const float rate = value(Setting::kMaxRate, axis) / kSecondsPerMinute *
                           value(Setting::kStepsPerMillimetre, axis);
        const float spacing = kMicrosecondsPerSecond / rate;
        if (spacing < least_spacing) {
            return SettingFault{Error::kMaxStepRateExceeded, number(Setting::kMaxRate),
                                number(Setting::kStepsPerMillimetre), spacing, least_spacing};
        }
        if (rate > most_rate) {
            return SettingFault{Error::kMaxStepRateExceeded,
                                number(Setting::kMaxRate),
                                number(Setting::kStepsPerMillimetre),
                                rate,
                                most_rate,
                                true};
        }
        const float filter = value(Setting::kAcceleration, axis) / value(Setting::kJerk, axis);
        if (filter > kLongestFilter) {
            return SettingFault{Error::kGcodeMaxValueExceeded, number(Setting::kAcceleration),
                                number(Setting::kJerk), filter, kLongestFilter};
        }
    }
    const planner::InputShaper shaper = input_shaper();
    if (shaper.ticks > planner::kMostShaperTicks) {
        const unsigned axis = slowest_shaped_axis();
        return SettingFault{Error::kGcodeMaxValueExceeded,
                            kTable[index_of(Setting::kShaperFrequency, axis)].number,
                            kTable[index_of(Setting::kShaperType, axis)].number, shaper.length,
                            static_cast<float>(planner::kMostShaperTicks) * kServoTick};
    }
    if (on(Setting::kSoftLimits) && !on(Setting::kHoming)) {
        return SettingFault{Error::kSoftLimitError};
    }
    return std::nullopt;
}

bool Settings::in_range_at(std::size_t index) const noexcept
{
    // This form of the comparison refuses a NaN.
    const bool inside =
        values_[index] >= kTable[index].least && values_[index] <= kTable[index].most;
    return inside && (!is_microsteps(index) || is_power_of_two(values_[index]));
}

bool Settings::in_range() const noexcept
{
    for (std::size_t i = 0; i < kSettingCount; ++i) {
        if (!in_range_at(i)) {
            return false;
        }
    }
    return true;
}

bool Settings::sound(const BoardLimits& board) const noexcept
{
    return in_range() && !find_fault(board);
}

bool Settings::mend(const Settings& standard, const BoardLimits& board) noexcept
{
    bool mended = false;
    for (std::size_t i = 0; i < kSettingCount; ++i) {
        if (!in_range_at(i)) {
            values_[i] = standard.values_[i];
            mended = true;
        }
    }
    const auto take_standard = [&](std::uint16_t number) {
        const std::optional<std::size_t> index = find_index(number);
        if (index) {
            values_[*index] = standard.values_[*index];
        }
    };
    // A fault names two settings of an axis at most, and there are three kinds of an axis.
    constexpr unsigned kMostFaults = 3 * kAxisCount + 5;
    for (unsigned i = 0; i < kMostFaults; ++i) {
        const std::optional<SettingFault> fault = find_fault(board);
        if (!fault) {
            return mended;
        }
        mended = true;
        if (fault->error == Error::kSoftLimitError) {
            values_[index_of(Setting::kSoftLimits)] = 0;
            continue;
        }
        take_standard(fault->first);
        take_standard(fault->second);
        if (fault->error == Error::kMaxStepRateExceeded && !fault->of_board) {
            values_[index_of(Setting::kStepPulse)] = standard.value(Setting::kStepPulse);
        }
    }
    if (find_fault(board)) {
        *this = standard;
    }
    return mended;
}

Span<std::uint8_t> Settings::bytes() noexcept
{
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): trivially copyable, bytes only.
    return {reinterpret_cast<std::uint8_t*>(values_.data()), sizeof values_};
}

MachineLimits Settings::limits() const noexcept
{
    MachineLimits limits;
    for (unsigned axis = 0; axis < axes(); ++axis) {
        limits.velocity[axis] = value(Setting::kMaxRate, axis) / kSecondsPerMinute;
        limits.acceleration[axis] = value(Setting::kAcceleration, axis);
        limits.jerk[axis] = value(Setting::kJerk, axis);
    }
    limits.set_rotary(has_rotary());
    limits.settle_lacking_axis();
    return limits;
}

AxisVecf Settings::backlash() const noexcept
{
    AxisVecf play;
    for (unsigned axis = 0; axis < axes(); ++axis) {
        play[axis] = value(Setting::kBacklash, axis);
    }
    return play;
}

vfd::VfdSetup Settings::vfd() const noexcept
{
    const auto word = [this](Setting setting) {
        return static_cast<std::uint16_t>(whole(setting));
    };
    vfd::VfdSetup setup;
    setup.protocol =
        has_vfd() ? static_cast<vfd::Protocol>(whole(Setting::kSpindleType)) : vfd::Protocol::kNone;
    setup.address = static_cast<std::uint8_t>(whole(Setting::kVfdAddress));
    setup.plain = {word(Setting::kVfdRunRegister),      word(Setting::kVfdSpeedRegister),
                   word(Setting::kVfdReadRegister),     word(Setting::kVfdClockwise),
                   word(Setting::kVfdCounterClockwise), word(Setting::kVfdStop),
                   value(Setting::kVfdToMultiplier),    value(Setting::kVfdToDivisor),
                   value(Setting::kVfdFromMultiplier),  value(Setting::kVfdFromDivisor)};
    return setup;
}

vfd::VfdTimes Settings::vfd_times() const noexcept
{
    constexpr float kPercent = 0.01F;
    return {whole(Setting::kVfdTimeout), value(Setting::kSpeedTolerance) * kPercent};
}

std::uint32_t Settings::vfd_baud() const noexcept
{
    constexpr std::array<std::uint32_t, 6> kBauds{2400, 4800, 9600, 19200, 38400, 115200};
    return kBauds[whole(Setting::kVfdBaud)];
}

planner::InputShaper Settings::input_shaper() const noexcept
{
    PerAxis<planner::AxisVibration> axes{};
    for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
        axes[axis] = {static_cast<planner::ShaperType>(
                          static_cast<unsigned>(value(Setting::kShaperType, axis))),
                      value(Setting::kShaperFrequency, axis), value(Setting::kShaperDamping, axis)};
    }
    return planner::make_input_shaper(axes);
}

// The shaped axis with the lowest frequency. Precondition: there is one.
unsigned Settings::slowest_shaped_axis() const noexcept
{
    unsigned slowest = 0;
    float least = kMostAny;
    for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
        if (value(Setting::kShaperType, axis) != 0 &&
            value(Setting::kShaperFrequency, axis) < least) {
            least = value(Setting::kShaperFrequency, axis);
            slowest = axis;
        }
    }
    return slowest;
}

pulse::StepSettings Settings::steps() const noexcept
{
    pulse::StepSettings steps{};
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        constexpr float kThousand = 1000.0F;
        steps.millisteps_per_mm[axis] = static_cast<std::uint32_t>(
            value(Setting::kStepsPerMillimetre, axis) * kThousand + 0.5F);
    }
    // The fourth motor's lines are another's, or nobody's.
    for (unsigned axis = axes(); axis < kAxisCount; ++axis) {
        steps.step_lines[axis] = 0;
        steps.direction_lines[axis] = 0;
    }
    if (const std::optional<unsigned> axis = second_motor_axis()) {
        steps.step_lines[*axis] |= kSecondStepLine;
        steps.direction_lines[*axis] |= kSecondDirectionLine;
    }
    steps.pulse_us = static_cast<std::uint16_t>(value(Setting::kStepPulse));
    steps.direction_setup_us = static_cast<std::uint16_t>(value(Setting::kDirectionSetup));
    return steps;
}

}  // namespace cusp::machine
