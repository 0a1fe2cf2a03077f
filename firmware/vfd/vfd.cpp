// The dialogue with a spindle's drive, message by message.
#include "firmware/vfd/vfd.hpp"

namespace cusp::vfd {
namespace {

// A Huanyang does not answer what comes sooner after its last answer; it is also long enough for any other's
// 3.5 characters.
constexpr std::uint32_t kSilenceTicks = 7;
constexpr std::uint32_t kReadTicks = 100;  // between two readings of the speed
constexpr unsigned kAttempts = 3;
constexpr unsigned kReadings = 2;
constexpr float kUsualScale = 3000;  // of a Huanyang that says 0

bool same(const VfdSetup& a, const VfdSetup& b) noexcept
{
    const PlainDrive& p = a.plain;
    const PlainDrive& q = b.plain;
    return a.protocol == b.protocol && a.address == b.address && p.run_register == q.run_register &&
           p.speed_register == q.speed_register && p.read_register == q.read_register &&
           p.clockwise == q.clockwise && p.counter_clockwise == q.counter_clockwise &&
           p.stop == q.stop && p.to_multiplier == q.to_multiplier && p.to_divisor == q.to_divisor &&
           p.from_multiplier == q.from_multiplier && p.from_divisor == q.from_divisor;
}

}  // namespace

void Vfd::configure(const VfdSetup& setup, const VfdTimes& times) noexcept
{
    times_ = times;
    if (!same(setup, setup_)) {
        setup_ = setup;
        restart();
    }
}

void Vfd::restart() noexcept
{
    turning_.reset();
    word_.reset();
    scale_ = has_scale(setup_.protocol) ? 0.0F : 1.0F;
    readings_ = 0;
    failed_ = false;
    fault_.reset();
    attempts_ = 0;
    stale_ = waits_;
}

void Vfd::want(Turning turning, float rpm) noexcept
{
    const bool stops = turning == Turning::kOff || rpm <= 0;
    const Turning wanted = stops ? Turning::kOff : turning;
    const float wanted_rpm = stops ? 0 : rpm;
    if (wanted != wanted_ || wanted_rpm != wanted_rpm_) {
        wanted_ = wanted;
        wanted_rpm_ = wanted_rpm;
        readings_ = 0;
    }
    forgive();
}

// A drive that is stopped, and shall be, may be tried anew.
void Vfd::forgive() noexcept
{
    failed_ = failed_ && !(wanted_ == Turning::kOff && turning_ == Turning::kOff);
}

bool Vfd::at_speed() const noexcept
{
    if (!in_use()) {
        return true;
    }
    if (failed_ || turning_ != wanted_) {
        return false;
    }
    return wanted_ == Turning::kOff || (word_ == wanted_word() && readings_ >= kReadings);
}

// The first of what is missing; a drive that lacks nothing and runs is read. One of which nothing is known is
// stopped before all else.
std::optional<Query> Vfd::due_query(std::uint32_t tick) const noexcept
{
    if (tick - over_at_ < pause_) {
        return std::nullopt;
    }
    const bool stops = wanted_ == Turning::kOff || failed_ || !turning_;
    if (stops) {
        return turning_ == Turning::kOff ? std::nullopt : std::optional<Query>{Query::kRun};
    }
    if (scale_ <= 0) {
        return Query::kScale;
    }
    if (turning_ != wanted_) {
        return Query::kRun;
    }
    if (word_ != wanted_word()) {
        return Query::kSpeed;
    }
    return tick - read_at_ < kReadTicks ? std::nullopt : std::optional<Query>{Query::kRead};
}

std::optional<Message> Vfd::next(std::uint32_t tick) noexcept
{
    if (!in_use() || waits_) {
        return std::nullopt;
    }
    const std::optional<Query> query = due_query(tick);
    if (!query) {
        return std::nullopt;
    }
    query_ = *query;
    waits_ = true;
    asked_ = tick;
    switch (query_) {
        case Query::kScale:
            message_ = scale_message(setup_);
            break;
        case Query::kRun:
            sent_turning_ = failed_ || !turning_ ? Turning::kOff : wanted_;
            message_ = run_message(setup_, sent_turning_);
            break;
        case Query::kSpeed:
            sent_word_ = wanted_word();
            message_ = speed_message(setup_, sent_word_);
            break;
        case Query::kRead:
            message_ = read_message(setup_);
            break;
    }
    return message_;
}

bool Vfd::is_over(Span<const std::uint8_t> bytes, std::uint32_t tick) const noexcept
{
    constexpr unsigned kRefusal = 0x80;
    const bool refused = bytes.size() >= kRefusalSize && (bytes[1] & kRefusal) != 0;
    return tick - asked_ > times_.answer || refused ||
           bytes.size() >= answer_size(setup_.protocol, query_);
}

void Vfd::take(Span<const std::uint8_t> bytes, std::uint32_t tick) noexcept
{
    waits_ = false;
    over_at_ = tick;
    pause_ = times_.answer + kSilenceTicks;
    if (stale_) {
        stale_ = false;
        return;
    }
    const Answer answer = parse_answer(setup_.protocol, query_, message_, bytes);
    switch (answer.kind) {
        case AnswerKind::kGood:
            pause_ = kSilenceTicks;
            attempts_ = 0;
            accept(answer.value, tick);
            return;
        case AnswerKind::kRefused:
            reject(FaultKind::kRefused);
            return;
        case AnswerKind::kGarbled:
            reject(bytes.empty() ? FaultKind::kSilent : FaultKind::kGarbled);
            return;
    }
}

void Vfd::put_off(std::uint32_t tick) noexcept
{
    waits_ = false;
    stale_ = false;
    over_at_ = tick;
    pause_ = times_.answer + kSilenceTicks;
}

void Vfd::accept(std::uint16_t value, std::uint32_t tick) noexcept
{
    switch (query_) {
        case Query::kScale:
            scale_ = value > 0 ? static_cast<float>(value) : kUsualScale;
            return;
        case Query::kRun:
            turning_ = sent_turning_;
            word_.reset();  // some take a speed only while they run
            forgive();
            return;
        case Query::kSpeed:
            word_ = sent_word_;
            readings_ = 0;
            read_at_ = tick;
            return;
        case Query::kRead:
            break;
    }
    read_at_ = tick;
    const float off = speed_of(setup_, value, scale_) - wanted_rpm_;
    const float most = times_.tolerance * wanted_rpm_;
    const bool agrees =
        turning_ == wanted_ && word_ == wanted_word() && off <= most && off >= -most;
    readings_ = agrees ? readings_ + 1 : 0;
}

void Vfd::reject(FaultKind kind) noexcept
{
    ++attempts_;
    if (attempts_ < kAttempts) {
        return;
    }
    attempts_ = 0;
    turning_.reset();
    readings_ = 0;
    if (!failed_) {
        failed_ = true;
        fault_ = kind;
    }
}

}  // namespace cusp::vfd
