// Each drive is set and watched step by step.
#include "firmware/drives/drives.hpp"

#include "firmware/drives/tmc2209.hpp"
#include "firmware/drives/tmc5160.hpp"

namespace cusp::drives {
namespace {

constexpr std::uint32_t kStartTicks = 100;  // until the drives' supply is up
constexpr std::uint32_t kWatchTicks = 10;   // between two questions
constexpr std::uint32_t kAgainTicks = 5;
constexpr std::uint32_t kMostTicks = 50;  // of a datagram and its answer
constexpr unsigned kAttempts = 3;

constexpr std::uint32_t kWasReset = 1;           // of GSTAT
constexpr std::uint32_t kAllOfGlobalStatus = 7;  // written ones clear

// A word on a line that nobody drives, whichever way it is pulled.
constexpr bool is_nobodys(std::uint32_t value) noexcept { return value == 0 || value == ~0U; }

std::uint32_t writes_in(Span<const Step> steps) noexcept
{
    std::uint32_t count = 0;
    for (const Step& step : steps) {
        count += step.action == Action::kWrite ? 1U : 0U;
    }
    return count;
}

std::optional<std::uint32_t> parse_reply(DriveKind kind,
                                         Span<const std::uint8_t> answer,
                                         Register place) noexcept
{
    return kind == DriveKind::kTmc5160 ? tmc5160::parse_reply(answer)
                                       : tmc2209::parse_reply(answer, place);
}

}  // namespace

DriveRegisters registers_for(DriveKind kind, const MotorSetup& setup) noexcept
{
    return kind == DriveKind::kTmc5160 ? tmc5160::registers_for(setup)
                                       : tmc2209::registers_for(setup);
}

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

const Recipe& Drives::recipe() const noexcept
{
    return registers_[drive_].kind == DriveKind::kTmc5160 ? tmc5160::kRecipe : tmc2209::kRecipe;
}

const Step& Drives::step() const noexcept
{
    return (phase_ == Phase::kSetting ? recipe().setting : recipe().watching)[step_];
}

bool Drives::replies() const noexcept
{
    return step().action != Action::kWrite || recipe().mirrors_writes;
}

std::uint32_t Drives::wanted_value() const noexcept
{
    const DriveRegisters& wanted = registers_[drive_];
    switch (step().place) {
        case Register::kGlobalSettings:
            return wanted.global_settings;
        case Register::kChopper:
            return wanted.chopper;
        case Register::kScaler:
            return wanted.scaler;
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
        case Register::kBusInputs:
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
    const DriveKind kind = registers_[drive_].kind;
    const bool on_bus = kind == DriveKind::kTmc5160;
    const Register place = step().place;
    if (step().action == Action::kWrite) {
        const std::uint32_t value = wanted_value();
        return DriveRequest{
            drive_, kind,
            on_bus ? tmc5160::write_request(place, value) : tmc2209::write_request(place, value),
            replies()};
    }
    return DriveRequest{drive_, kind,
                        on_bus ? tmc5160::read_request(place) : tmc2209::read_request(place), true};
}

bool Drives::overdue(std::uint32_t tick) const noexcept { return tick - asked_ > kMostTicks; }

void Drives::take(Span<const std::uint8_t> answer, std::uint32_t tick) noexcept
{
    waits_ = false;
    if (stale_) {
        stale_ = false;
        return;
    }
    if (!replies()) {
        go_on(tick);
        return;
    }
    const std::optional<std::uint32_t> value =
        parse_reply(registers_[drive_].kind, answer, step().place);
    if (!value) {
        const bool garbled = !answer.empty() && recipe().has_checksum;
        ask_again(garbled ? FaultKind::kGarbled : FaultKind::kSilent, tick);
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

void Drives::judge(std::uint32_t value, std::uint32_t tick) noexcept
{
    if (const std::optional<FaultKind> fault = fault_in(value)) {
        suspect(*fault, tick);
    } else if (kept(value)) {
        go_on(tick);
    } else {
        set_again(tick);
    }
}

// The drive's own report of its state.
std::optional<FaultKind> Drives::fault_in(std::uint32_t value) const noexcept
{
    std::optional<FaultKind> fault;
    switch (step().action) {
        case Action::kReadVersion:
            if (value >> 24U != recipe().version) {
                fault = is_nobodys(value) ? FaultKind::kSilent : FaultKind::kOtherChip;
            }
            break;
        case Action::kReadStatus:
            if ((value & recipe().hot) != 0) {
                fault = FaultKind::kHot;
            } else if ((value & recipe().shorts) != 0) {
                fault = FaultKind::kShort;
            }
            break;
        case Action::kReadRestarts:
            if ((value & kWasReset) != 0) {
                fault = FaultKind::kRestarted;
            } else if ((value & recipe().undervoltage) != 0) {
                fault = FaultKind::kUndervoltage;
            }
            break;
        case Action::kWrite:
        case Action::kCompare:
        case Action::kCountBefore:
        case Action::kCountAfter:
            break;
    }
    return fault;
}

// True if it has taken in what was written.
bool Drives::kept(std::uint32_t value) noexcept
{
    constexpr std::uint32_t kCounts = 256;
    switch (step().action) {
        case Action::kWrite:
        case Action::kCompare:
            return value == wanted_value();
        case Action::kCountBefore:
            writes_before_ = value;
            return true;
        case Action::kCountAfter:
            return value % kCounts == (writes_before_ + writes_in(recipe().setting)) % kCounts;
        case Action::kReadVersion:
        case Action::kReadStatus:
        case Action::kReadRestarts:
            break;
    }
    return true;
}

void Drives::go_on(std::uint32_t tick) noexcept
{
    const std::size_t steps =
        phase_ == Phase::kSetting ? recipe().setting.size() : recipe().watching.size();
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

void Drives::suspect(FaultKind kind, std::uint32_t tick) noexcept
{
    if (recipe().has_checksum) {
        fail(kind);
    } else {
        ask_again(kind, tick);
    }
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
    fault_ = {drive_, kind, registers_[drive_].kind};
}

}  // namespace cusp::drives
