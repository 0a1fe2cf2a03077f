// Data sheet of the TMC2209, revision 1.09: sections 4 and 5.
#include "tests/target/cosim/drive_model.hpp"

namespace cusp::cosim {
namespace {

constexpr std::uint32_t kGconf = 0x00, kGstat = 0x01, kIfcnt = 0x02, kSlaveconf = 0x03,
                        kIoin = 0x06;
constexpr std::uint32_t kIholdIrun = 0x10, kTpowerdown = 0x11, kTpwmthrs = 0x13, kChopconf = 0x6C;
constexpr std::uint32_t kDrvStatus = 0x6F, kPwmconf = 0x70;
constexpr unsigned kLongestPause = 63;               // bits between two bytes
constexpr Picoseconds kSlowestBit = kSecond / 9000;  // section 4.1: 9000 baud at least

// Bit by bit: what a shift register with the polynomial's taps holds.
std::uint8_t checksum(const std::vector<std::uint8_t>& bytes, std::size_t count)
{
    bool cell[8] = {};
    for (std::size_t i = 0; i < count; ++i) {
        for (unsigned bit = 0; bit < 8; ++bit) {
            const bool feedback = cell[7] != ((bytes[i] >> bit & 1) != 0);
            for (unsigned k = 7; k > 0; --k) {
                cell[k] = cell[k - 1];
            }
            cell[0] = feedback;
            cell[1] = cell[1] != feedback;
            cell[2] = cell[2] != feedback;
        }
    }
    unsigned value = 0;
    for (unsigned k = 0; k < 8; ++k) {
        value |= (cell[k] ? 1U : 0U) << k;
    }
    return static_cast<std::uint8_t>(value);
}

}  // namespace

DriveModel::DriveModel(Circuit& circuit, std::string name, PortModel& port, unsigned pin)
    : SocketModel{circuit}, name_{std::move(name)}, port_{port}, pin_{pin}
{
    port_.set_listener(pin_, [this] { look(); });
    DriveModel::reset();
}

void DriveModel::reset()
{
    registers_ = {{kGconf, 0x141},       {kGstat, 1},       {kIfcnt, 0},    {kSlaveconf, 0},
                  {kIholdIrun, 0},       {kTpowerdown, 20}, {kTpwmthrs, 0}, {kChopconf, 0x10000053},
                  {kPwmconf, 0xC10D0024}};
    written_at_ = -1;
    state_ = State::kIdle;
    plan(kNever);
    port_.drive(pin_, -1);
}

void DriveModel::plan(Picoseconds at)
{
    due_ = at;
    circuit_.next_event = 0;
}

void DriveModel::set_missing(bool on)
{
    if (missing_ && !on) {
        reset();
    }
    missing_ = on;
}

void DriveModel::set_status(std::uint32_t bits)
{
    status_ = bits;
    if ((bits & 0x3EU) != 0) {
        registers_[kGstat] |= 2;  // drv_err: over-temperature or a short has switched it off
    }
}

bool DriveModel::level() const { return port_.wire_high(pin_); }

void DriveModel::look()
{
    const bool high = level();
    if (high == was_high_) {
        return;
    }
    was_high_ = high;
    if (state_ == State::kAnswer) {
        return;  // its own
    }
    if (state_ == State::kIdle && !high) {
        bytes_.clear();
        edges_ = {circuit_.now};
        state_ = State::kSync;
        plan(circuit_.now + (bit_ > 0 ? bit_ : kSlowestBit) * kLongestPause);
    } else if (state_ == State::kSync) {
        // Start, 1, 0, 1, 0: the fifth edge is the begin of the fourth data bit.
        edges_.push_back(circuit_.now);
        if (edges_.size() == 5) {
            bit_ = (edges_[4] - edges_[0]) / 4;
            start_ = edges_[0];
            bits_taken_ = 4;
            byte_ = 5;
            state_ = State::kBits;
            plan(start_ + bit_ * 11 / 2);
        }
    } else if (state_ == State::kBetween && !high) {
        begin_byte();
    }
}

void DriveModel::begin_byte()
{
    start_ = circuit_.now;
    bits_taken_ = 0;
    byte_ = 0;
    state_ = State::kBits;
    plan(start_ + bit_ * 3 / 2);
}

void DriveModel::happen()
{
    if (state_ == State::kAnswer) {
        send_bit();
        return;
    }
    if (state_ != State::kBits) {
        state_ = State::kIdle;  // too long a pause
        plan(kNever);
        return;
    }
    if (bits_taken_ < 8) {
        byte_ |= (level() ? 1U : 0U) << bits_taken_;
        ++bits_taken_;
        plan(start_ + bit_ * static_cast<Picoseconds>(2 * bits_taken_ + 3) / 2);
        return;
    }
    if (!level()) {  // no stop bit
        state_ = State::kIdle;
        plan(kNever);
        return;
    }
    take_byte();
}

void DriveModel::take_byte()
{
    bytes_.push_back(static_cast<std::uint8_t>(byte_));
    const bool writes = bytes_.size() > 2 && (bytes_[2] & 0x80U) != 0;
    if (bytes_.size() == (writes ? 8 : 4)) {
        state_ = State::kIdle;
        plan(kNever);
        take_datagram();
        return;
    }
    state_ = State::kBetween;
    plan(circuit_.now + bit_ * kLongestPause);
}

void DriveModel::take_datagram()
{
    const std::size_t last = bytes_.size() - 1;
    if (missing_ || bytes_[1] != 0) {
        return;
    }
    if (checksum(bytes_, last) != bytes_[last]) {
        ++damaged_;
        return;
    }
    const std::uint32_t place = bytes_[2] & 0x7FU;
    if (bytes_.size() == 8) {
        if (!deaf_) {
            write(place, std::uint32_t{bytes_[3]} << 24U | std::uint32_t{bytes_[4]} << 16U |
                             std::uint32_t{bytes_[5]} << 8U | bytes_[6]);
        }
        return;
    }
    const std::uint32_t value = read(place);
    std::vector<std::uint8_t> answer{5, 0xFF, static_cast<std::uint8_t>(place)};
    for (unsigned shift = 32; shift > 0; shift -= 8) {
        answer.push_back(static_cast<std::uint8_t>(value >> (shift - 8)));
    }
    const unsigned wrong = garbled_ > 0 ? 0x10 : 0;
    garbled_ -= garbled_ > 0 ? 1 : 0;
    answer.push_back(static_cast<std::uint8_t>(checksum(answer, 7) ^ wrong));
    answer_.clear();
    for (const std::uint8_t byte : answer) {
        answer_.push_back(false);
        for (unsigned bit = 0; bit < 8; ++bit) {
            answer_.push_back((byte >> bit & 1) != 0);
        }
        answer_.push_back(true);
    }
    sent_ = 0;
    ++answers_;
    state_ = State::kAnswer;
    // Now is the middle of the stop bit.
    const unsigned delay = registers_[kSlaveconf] >> 8U & 15U;
    plan(circuit_.now + bit_ / 2 + bit_ * 8 * (delay < 2 ? 1 : (delay | 1U)));
}

void DriveModel::send_bit()
{
    if (sent_ < answer_.size()) {
        port_.drive(pin_, answer_[sent_] ? 1 : 0);
        ++sent_;
        plan(circuit_.now + bit_ * (1000 + drift_) / 1000);
        return;
    }
    if (port_.driven(pin_)) {
        circuit_.violate(name_ + ": the wire is driven from both ends");
    }
    port_.drive(pin_, -1);
    was_high_ = true;
    state_ = State::kIdle;
    plan(kNever);
}

std::uint32_t DriveModel::read(std::uint32_t place)
{
    if (place == kIoin) {
        return version_ << 24U | 1U << 6U;
    }
    if (place == kDrvStatus) {
        return status_ | 1U << 31U;
    }
    // Write-only registers read as 0.
    const bool readable = place == kGconf || place == kGstat || place == kIfcnt ||
                          place == kChopconf || place == kPwmconf;
    return readable ? registers_[place] : 0;
}

void DriveModel::write(std::uint32_t place, std::uint32_t value)
{
    if (registers_.count(place) == 0 || place == kIfcnt) {
        circuit_.violate(name_ + ": write to a register that can't be written, " +
                         hexadecimal(place));
        return;
    }
    registers_[place] = place == kGstat ? registers_[place] & ~value : value;
    registers_[kIfcnt] = (registers_[kIfcnt] + 1) % 256;
    written_at_ = circuit_.now;
}

}  // namespace cusp::cosim
