// Each drive is set and watched step by step.
#include "firmware/drives/drives.hpp"

namespace cusp::drives {
namespace {

struct Step {
    Register place;
    bool writes;
};
// Setting a drive. The count of writes is read before and after them.
constexpr std::array<Step, 12> kSetting{{
    {Register::kInputs, false},
    {Register::kWriteCount, false},
    {Register::kGlobalSettings, true},
    {Register::kChopper, true},
    {Register::kCurrents, true},
    {Register::kHoldDelay, true},
    {Register::kStealthLimit, true},
    {Register::kGlobalStatus, true},
    {Register::kWriteCount, false},
    {Register::kGlobalSettings, false},
    {Register::kChopper, false},
    {Register::kStatus, false},
}};
constexpr unsigned kFirstCount = 1;
constexpr std::uint32_t kWritesOfSetting = 6;
constexpr std::array<Step, 2> kWatching{{
    {Register::kStatus, false},
    {Register::kGlobalStatus, false},
}};

constexpr std::uint32_t kStartTicks = 100;  // until the drives' supply is up
constexpr std::uint32_t kWatchTicks = 10;   // between two questions
constexpr std::uint32_t kAgainTicks = 5;
constexpr std::uint32_t kMostTicks = 50;  // of a datagram and its answer
constexpr unsigned kAttempts = 3;

constexpr std::uint32_t kVersion = 0x21;
constexpr std::uint32_t kWasReset = 1;                // of GSTAT
constexpr std::uint32_t kAllOfGlobalStatus = 7;       // written ones clear
constexpr std::uint32_t kOverTemperature = 1U << 1U;  // of DRV_STATUS
constexpr std::uint32_t kShorts = 0xFU << 2U;

}  // namespace

void Drives::configure(const std::array<DriveRegisters, kMostDrives>& registers,
                       std::uint8_t motors) noexcept
{
    if (registers == registers_ && motors == motors_) {
        return;
    }
    registers_ = registers;
    motors_ = motors;
    if (phase_ == Phase::kSetting || phase_ == Phase::kWatching) {
        begin();
    }
}

void Drives::restart(std::uint32_t tick) noexcept
{
    were_set_ = false;
    phase_ = Phase::kStarting;
    due_ = tick + kStartTicks;
    stale_ = waits_;
}

// With the first drive.
void Drives::begin() noexcept
{
    phase_ = Phase::kSetting;
    stale_ = waits_;
    drive_ = kMostDrives - 1;
    rounds_ = 0;
    next_drive();
}

bool Drives::writes() const noexcept { return phase_ == Phase::kSetting && kSetting[step_].writes; }

Register Drives::place() const noexcept
{
    return phase_ == Phase::kSetting ? kSetting[step_].place : kWatching[step_].place;
}

std::uint32_t Drives::value_to_write() const noexcept
{
    const DriveRegisters& wanted = registers_[drive_];
    switch (place()) {
        case Register::kGlobalSettings:
            return wanted.global_settings;
        case Register::kChopper:
            return wanted.chopper;
        case Register::kCurrents:
            return wanted.currents;
        case Register::kHoldDelay:
            return wanted.hold_delay;
        case Register::kStealthLimit:
            return wanted.stealth_limit;
        case Register::kGlobalStatus:
            return kAllOfGlobalStatus;
        case Register::kWriteCount:
        case Register::kInputs:
        case Register::kStatus:
            break;
    }
    return 0;
}

std::optional<DriveRequest> Drives::next(std::uint32_t tick) noexcept
{
    const bool early = static_cast<std::int32_t>(tick - due_) < 0;
    if (motors_ == 0 || phase_ == Phase::kFailed || waits_ || early) {
        return std::nullopt;
    }
    if (phase_ == Phase::kStarting) {
        begin();
    }
    waits_ = true;
    asked_ = tick;
    return writes() ? DriveRequest{drive_, write_request(place(), value_to_write()), false}
                    : DriveRequest{drive_, read_request(place()), true};
}

bool Drives::overdue(std::uint32_t tick) const noexcept { return tick - asked_ > kMostTicks; }

void Drives::take(Span<const std::uint8_t> answer, std::uint32_t tick) noexcept
{
    waits_ = false;
    if (stale_) {
        stale_ = false;
        return;
    }
    if (writes()) {
        go_on(tick);
        return;
    }
    const std::optional<std::uint32_t> value = parse_reply(answer, place());
    if (!value) {
        ask_again(answer.empty() ? FaultKind::kSilent : FaultKind::kGarbled, tick);
        return;
    }
    judge(*value, tick);
}

void Drives::put_off(std::uint32_t tick) noexcept
{
    waits_ = false;
    stale_ = false;
    due_ = tick + kAgainTicks;
}

// An answer, by the register that was asked for.
void Drives::judge(std::uint32_t value, std::uint32_t tick) noexcept
{
    const DriveRegisters& wanted = registers_[drive_];
    constexpr std::uint32_t kCounts = 256;
    bool kept = true;
    switch (place()) {
        case Register::kInputs:
            if (value >> 24U != kVersion) {
                fail(FaultKind::kOtherChip);
                return;
            }
            break;
        case Register::kWriteCount:
            if (step_ == kFirstCount) {
                writes_before_ = value;
            }
            kept = step_ == kFirstCount ||
                   value % kCounts == (writes_before_ + kWritesOfSetting) % kCounts;
            break;
        case Register::kGlobalSettings:
            kept = value == wanted.global_settings;
            break;
        case Register::kChopper:
            kept = value == wanted.chopper;
            break;
        case Register::kStatus:
            judge_status(value, tick);
            return;
        case Register::kGlobalStatus:
            if ((value & kWasReset) != 0) {
                fail(FaultKind::kRestarted);
                return;
            }
            break;
        case Register::kCurrents:
        case Register::kHoldDelay:
        case Register::kStealthLimit:
            break;
    }
    if (kept) {
        go_on(tick);
    } else {
        set_again(tick);
    }
}

void Drives::judge_status(std::uint32_t value, std::uint32_t tick) noexcept
{
    if ((value & kOverTemperature) != 0) {
        fail(FaultKind::kHot);
    } else if ((value & kShorts) != 0) {
        fail(FaultKind::kShort);
    } else {
        go_on(tick);
    }
}

void Drives::go_on(std::uint32_t tick) noexcept
{
    const std::size_t steps = phase_ == Phase::kSetting ? kSetting.size() : kWatching.size();
    due_ = phase_ == Phase::kWatching ? tick + kWatchTicks : tick;
    attempts_ = 0;
    ++step_;
    if (step_ < steps) {
        return;
    }
    const unsigned before = drive_;
    next_drive();
    rounds_ = 0;
    if (phase_ == Phase::kSetting && drive_ <= before) {
        phase_ = Phase::kWatching;
        were_set_ = true;
    }
}

// Precondition: there is one.
void Drives::next_drive() noexcept
{
    for (unsigned i = 0; i < kMostDrives; ++i) {
        drive_ = (drive_ + 1) % kMostDrives;
        if ((motors_ >> drive_ & 1U) != 0) {
            break;
        }
    }
    step_ = 0;
    attempts_ = 0;
}

void Drives::ask_again(FaultKind reason, std::uint32_t tick) noexcept
{
    ++attempts_;
    due_ = tick + kAgainTicks;
    if (attempts_ == kAttempts) {
        fail(reason);
    }
}

// From its first step on.
void Drives::set_again(std::uint32_t tick) noexcept
{
    ++rounds_;
    step_ = 0;
    attempts_ = 0;
    due_ = tick + kAgainTicks;
    if (rounds_ == kAttempts) {
        fail(FaultKind::kUnset);
    }
}

void Drives::fail(FaultKind kind) noexcept
{
    phase_ = Phase::kFailed;
    fault_ = {drive_, kind};
}

}  // namespace cusp::drives
