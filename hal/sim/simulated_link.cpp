// The two queues of the simulated serial line.
#include "hal/sim/simulated_link.hpp"

#include <algorithm>

#include "firmware/base/pulse_frame.hpp"

namespace cusp::hal {
namespace {

constexpr std::uint64_t kMilliBitsPerByte = 10'000;

// Credit does not pile up while the line is silent: one byte may be under way.
std::uint64_t credit_after_tick(std::uint64_t credit, std::uint32_t rate, bool waiting)
{
    const std::uint64_t more = std::uint64_t{rate} * 1000 / kServoTicksPerSecond;
    return waiting ? credit + more : std::min(credit + more, std::max(kMilliBitsPerByte, more));
}

}  // namespace

bool SimulatedLink::try_read(std::uint8_t& byte) noexcept
{
    if (incoming_.empty()) {
        return false;
    }
    if (bits_per_second_ != 0) {
        if (read_credit_ < kMilliBitsPerByte) {
            return false;
        }
        read_credit_ -= kMilliBitsPerByte;
    }
    byte = incoming_.front();
    incoming_.pop_front();
    scanned_ -= scanned_ > 0 ? 1 : 0;
    return true;
}

bool SimulatedLink::try_scan(std::uint8_t& byte) noexcept
{
    const std::uint64_t arrived =
        bits_per_second_ == 0 ? incoming_.size() : read_credit_ / kMilliBitsPerByte;
    if (scanned_ >= arrived || scanned_ >= incoming_.size()) {
        return false;
    }
    byte = incoming_[scanned_];
    ++scanned_;
    return true;
}

bool SimulatedLink::overrun() noexcept
{
    const bool was = overrun_;
    overrun_ = false;
    return was;
}

std::uint32_t SimulatedLink::write_room() const noexcept
{
    const std::size_t waiting = outgoing_.size();
    return waiting < kWriteRoom ? kWriteRoom - static_cast<std::uint32_t>(waiting) : 0;
}

void SimulatedLink::write(Span<const std::uint8_t> bytes) noexcept
{
    CUSP_ASSERT(bytes.size() <= write_room());
    outgoing_.insert(outgoing_.end(), bytes.begin(), bytes.end());
}

void SimulatedLink::send(std::string_view bytes)
{
    incoming_.insert(incoming_.end(), bytes.begin(), bytes.end());
}

std::string SimulatedLink::take_answers()
{
    std::size_t count = outgoing_.size();
    if (count == 0) {
        return {};  // so in most ticks
    }
    if (bits_per_second_ != 0) {
        count = std::min(count, static_cast<std::size_t>(write_credit_ / kMilliBitsPerByte));
        write_credit_ -= count * kMilliBitsPerByte;
    }
    const auto end = outgoing_.begin() + static_cast<std::ptrdiff_t>(count);
    std::string answers(outgoing_.begin(), end);
    outgoing_.erase(outgoing_.begin(), end);
    return answers;
}

void SimulatedLink::advance() noexcept
{
    read_credit_ = credit_after_tick(read_credit_, bits_per_second_, !incoming_.empty());
    write_credit_ = credit_after_tick(write_credit_, bits_per_second_, !outgoing_.empty());
}

void SimulatedLink::clear() noexcept
{
    incoming_.clear();
    scanned_ = 0;
    outgoing_.clear();
    overrun_ = false;
}

}  // namespace cusp::hal
