// RM0090 section 10: requests, counts, flags; what may not be changed while a stream is on.
#include "tests/target/cosim/dma_model.hpp"

#include <cstring>
#include <utility>

namespace cusp::cosim {
namespace {

constexpr std::uint32_t kEnable = 1;
constexpr std::uint32_t kCircular = 1U << 8U;
constexpr std::uint32_t kMemoryGoesOn = 1U << 10U;
constexpr std::uint32_t kTransferError = 8;
constexpr std::uint32_t kHalf = 16;
constexpr std::uint32_t kComplete = 32;
// A stream that is switched off finishes what it does.
constexpr Picoseconds kStopTime = 120'000;
// NDTR is 0 after the last item of a ring, at most until the next.
constexpr Picoseconds kReloadTime = 990'000;
// Interrupt enables may be changed at any time.
constexpr std::uint32_t kFreeBits = 0x1F;
constexpr std::array<unsigned, 4> kFlagPlaces{0, 6, 16, 22};

bool to_peripheral(std::uint32_t cr) { return (cr >> 6U & 3U) == 1; }
std::uint32_t memory_size(std::uint32_t cr) { return 1U << (cr >> 13U & 3U); }

}  // namespace

DmaModel::DmaModel(Circuit& circuit,
                   std::string name,
                   std::array<unsigned, 8> interrupts,
                   Port port)
    : Model{circuit}, name_{std::move(name)}, interrupts_{interrupts}, port_{std::move(port)}
{
}

void DmaModel::reset()
{
    streams_ = {};
    flags_ = {};
    due_ = kNever;
    for (unsigned i = 0; i < 8; ++i) {
        update_line(i);
    }
}

void DmaModel::complain(unsigned index, const std::string& what)
{
    circuit_.violate(name_ + " stream " + std::to_string(index) + ": " + what);
}

// The manual does not say when NDTR is loaded anew: as late as it can be, which is at the next item.
bool DmaModel::reloads(const Stream& stream) const
{
    return stream.left == stream.size && circuit_.now - stream.reloaded_at < kReloadTime;
}

std::uint32_t DmaModel::read(std::uint32_t offset)
{
    if (offset < 8) {
        std::uint32_t value = 0;
        for (unsigned i = 0; i < 4; ++i) {
            value |= flags_[offset + i] << kFlagPlaces[i];
        }
        return value;
    }
    if (offset < 0x10 || offset >= 0xD0) {
        return 0;
    }
    const Stream& stream = streams_[(offset - 0x10) / 0x18];
    switch ((offset - 0x10) % 0x18) {
        case 0x00:
            return stream.cr;
        case 0x04:
            return (stream.cr & kEnable) == 0 ? stream.ndtr : reloads(stream) ? 0 : stream.left;
        case 0x08:
            return stream.par;
        case 0x0C:
            return stream.m0ar;
        case 0x10:
            return stream.m1ar;
        default:
            return stream.fcr;
    }
}

void DmaModel::write(std::uint32_t offset, std::uint32_t value)
{
    if (offset == 8 || offset == 12) {
        for (unsigned i = 0; i < 4; ++i) {
            const unsigned index = (offset - 8) + i;
            flags_[index] &= ~(value >> kFlagPlaces[i] & 0x3DU);
            update_line(index);
        }
        return;
    }
    if (offset < 0x10 || offset >= 0xD0) {
        circuit_.violate(name_ + ": write to a register to be read, " + hexadecimal(offset));
        return;
    }
    write_stream((offset - 0x10) / 0x18, (offset - 0x10) % 0x18, value);
}

void DmaModel::write_stream(unsigned index, std::uint32_t offset, std::uint32_t value)
{
    Stream& stream = streams_[index];
    if (offset == 0) {
        write_settings(index, value);
        return;
    }
    if ((stream.cr & kEnable) != 0) {
        complain(index, "changed while it is on");
    }
    std::uint32_t* const registers[] = {&stream.ndtr, &stream.par, &stream.m0ar, &stream.m1ar,
                                        &stream.fcr};
    *registers[offset / 4 - 1] = value;
}

void DmaModel::write_settings(unsigned index, std::uint32_t value)
{
    Stream& stream = streams_[index];
    const bool on = (stream.cr & kEnable) != 0;
    if (on && ((stream.cr ^ value) & ~(kEnable | kFreeBits)) != 0) {
        complain(index, "its settings are changed while it is on");
    }
    if (on && (value & kEnable) == 0) {
        stream.stops_at = circuit_.now + kStopTime;
        due_ = std::min(due_, stream.stops_at);
        circuit_.next_event = 0;
        stream.cr = value | kEnable;
    } else {
        const bool starts = !on && (value & kEnable) != 0;
        stream.cr = value;
        if (starts) {
            start(index);
        }
    }
    update_line(index);
}

void DmaModel::start(unsigned index)
{
    Stream& stream = streams_[index];
    if (flags_[index] != 0) {
        complain(index, "switched on with its flags set");
    }
    if ((stream.fcr & 4U) != 0) {
        complain(index, "the FIFO is not modelled");
    }
    if (stream.ndtr == 0) {
        complain(index, "switched on with nothing to transfer");
    }
    stream.size = stream.ndtr;
    stream.left = stream.ndtr;
    stream.stops_at = kNever;
    if (to_peripheral(stream.cr)) {
        fetch(index);
        if (started_) {
            started_();
        }
    }
}

// In direct mode a stream to a peripheral has the next item at hand before it is asked for.
void DmaModel::fetch(unsigned index)
{
    Stream& stream = streams_[index];
    const std::uint32_t width = memory_size(stream.cr);
    const std::uint32_t done =
        (stream.cr & kMemoryGoesOn) != 0 ? (stream.size - stream.left) * width : 0;
    const std::uint8_t* const from = circuit_.dma_memory(stream.m0ar + done, width);
    stream.prefetched = 0;
    if (from == nullptr) {
        complain(index, "reads memory that it does not reach, " + hexadecimal(stream.m0ar + done));
        raise(index, kTransferError);
        stream.cr &= ~kEnable;
        return;
    }
    std::memcpy(&stream.prefetched, from, width);
}

bool DmaModel::serves(unsigned stream, unsigned channel) const
{
    const std::uint32_t cr = streams_[stream].cr;
    return (cr & kEnable) != 0 && (cr >> 25U & 7U) == channel;
}

bool DmaModel::request(unsigned index, unsigned channel)
{
    if (!serves(index, channel)) {
        return false;
    }
    Stream& stream = streams_[index];
    const std::uint32_t width = memory_size(stream.cr);
    if (to_peripheral(stream.cr)) {
        port_.write(stream.par, stream.prefetched);
        count_item(index);
        return true;
    }
    const std::uint32_t done =
        (stream.cr & kMemoryGoesOn) != 0 ? (stream.size - stream.left) * width : 0;
    const std::uint32_t value = port_.read(stream.par);
    std::uint8_t* const to = circuit_.dma_memory(stream.m0ar + done, width);
    if (to == nullptr) {
        complain(index, "writes memory that it does not reach, " + hexadecimal(stream.m0ar + done));
        raise(index, kTransferError);
        stream.cr &= ~kEnable;
        return true;
    }
    std::memcpy(to, &value, width);
    count_item(index);
    return true;
}

void DmaModel::count_item(unsigned index)
{
    Stream& stream = streams_[index];
    --stream.left;
    if (stream.left == stream.size / 2) {
        raise(index, kHalf);
    }
    if (stream.left == 0) {
        raise(index, kComplete);
        if ((stream.cr & kCircular) == 0) {
            stream.cr &= ~kEnable;
            stream.ndtr = 0;
            return;
        }
        stream.left = stream.size;
        stream.reloaded_at = circuit_.now;
    }
    if (to_peripheral(stream.cr)) {
        fetch(index);
    }
}

void DmaModel::happen()
{
    due_ = kNever;
    for (unsigned i = 0; i < 8; ++i) {
        Stream& stream = streams_[i];
        if (stream.stops_at <= circuit_.now) {
            stream.stops_at = kNever;
            stream.cr &= ~kEnable;
            stream.ndtr = stream.left;
            // Section 10.3.17: the complete flag is set at an early end, too.
            raise(i, kComplete);
        }
        due_ = std::min(due_, stream.stops_at);
    }
}

void DmaModel::raise(unsigned index, std::uint32_t flag)
{
    flags_[index] |= flag;
    update_line(index);
}

void DmaModel::update_line(unsigned index)
{
    const std::uint32_t cr = streams_[index].cr;
    const std::uint32_t enabled = ((cr >> 4U & 1U) != 0 ? kComplete : 0U) |
                                  ((cr >> 3U & 1U) != 0 ? kHalf : 0U) |
                                  ((cr >> 2U & 1U) != 0 ? kTransferError : 0U);
    circuit_.set_line(interrupts_[index], (flags_[index] & enabled) != 0);
}

}  // namespace cusp::cosim
