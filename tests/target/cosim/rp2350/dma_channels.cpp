// Section 12.6 of the data sheet.
#include "tests/target/cosim/rp2350/dma_channels.hpp"

#include <algorithm>
#include <utility>

namespace cusp::cosim::rp2350 {
namespace {

constexpr std::uint32_t kOn = 1;
constexpr std::uint32_t kBusy = 1U << 26U;
constexpr std::uint32_t kQuiet = 1U << 23U;
constexpr std::uint32_t kCount = (1U << 28U) - 1U;
constexpr unsigned kFirstTimer = 59;
constexpr unsigned kUnpaced = 63;
enum Word : unsigned { kFrom, kTo, kWords, kCtrl };
// What lies at the four places of each alias; the last one triggers.
constexpr Word kPlaces[4][4] = {{kFrom, kTo, kWords, kCtrl},
                                {kCtrl, kFrom, kTo, kWords},
                                {kCtrl, kWords, kFrom, kTo},
                                {kCtrl, kTo, kWords, kFrom}};

}  // namespace

DmaChannels::DmaChannels(Circuit& circuit, Wiring wiring)
    : Model{circuit}, wiring_{std::move(wiring)}
{
}

void DmaChannels::complain(unsigned number, const std::string& what)
{
    circuit_.violate("DMA channel " + std::to_string(number) + ": " + what);
}

void DmaChannels::reset()
{
    channels_ = {};
    for (unsigned i = 0; i < kChannels; ++i) {
        channels_[i].ctrl = 0;
    }
    timers_ = {};
    timers_due_.fill(kNever);
    enabled_ = forced_ = {};
    raised_ = 0;
    update_lines();
    plan();
}

std::uint32_t DmaChannels::read_channel(std::uint32_t offset) const
{
    const Channel& channel = channels_[offset / 0x40];
    switch (kPlaces[offset / 16 % 4][offset / 4 % 4]) {
        case kFrom:
            return channel.from;
        case kTo:
            return channel.to;
        case kWords:
            return channel.count;
        case kCtrl:
            break;
    }
    return channel.ctrl | (channel.busy ? kBusy : 0U);
}

void DmaChannels::write_channel(std::uint32_t offset, std::uint32_t value)
{
    const unsigned number = offset / 0x40;
    Channel& channel = channels_[number];
    const Word word = kPlaces[offset / 16 % 4][offset / 4 % 4];
    const bool triggers = offset % 16 == 12;
    if (channel.busy && (word == kFrom || word == kTo)) {
        complain(number, "an address is written while it is busy");
    }
    switch (word) {
        case kFrom:
            channel.from = value;
            break;
        case kTo:
            channel.to = value;
            break;
        case kWords:
            channel.reload = value;
            break;
        case kCtrl:
            if (channel.busy && (value & kOn) != 0 &&
                ((channel.ctrl ^ value) & ~(kOn | 15U << 13U | kQuiet)) != 0) {
                complain(number, "what it does is changed while it is busy");
            }
            channel.ctrl = value & 0x03FFFFFFU;
            break;
    }
    if (triggers) {
        trigger(number, value == 0 || (channel.ctrl & kOn) == 0);
    }
    look();
}

void DmaChannels::trigger(unsigned number, bool null)
{
    Channel& channel = channels_[number];
    if (null) {
        if ((channel.ctrl & kQuiet) != 0) {
            raised_ |= 1U << number;
            update_lines();
        }
        return;
    }
    if ((channel.ctrl & kOn) == 0) {
        return;
    }
    if (channel.busy) {
        complain(number, "started while it is busy");
        return;
    }
    if ((channel.reload >> 28U) != 0) {
        complain(number, "a mode of its count that is not modelled");
    }
    channel.busy = true;
    channel.count = channel.reload & kCount;
    channel.done_at = kNever;
    if (channel.count == 0) {
        finish(number);
    } else if (request_of(channel) == kUnpaced) {
        const Picoseconds cycle = kSecond / std::max(1U, wiring_.clock_hz());
        channel.done_at = circuit_.now + cycle * channel.count;
    }
    plan();
}

std::uint32_t DmaChannels::step(const Channel& channel, std::uint32_t address, bool write) const
{
    const bool goes_on = (channel.ctrl >> (write ? 6U : 4U) & 1U) != 0;
    if (!goes_on) {
        return address;
    }
    const std::uint32_t size = 1U << (channel.ctrl >> 2U & 3U);
    const bool backwards = (channel.ctrl >> (write ? 7U : 5U) & 1U) != 0;
    const std::uint32_t next = backwards ? address - size : address + size;
    const unsigned ring = channel.ctrl >> 8U & 15U;
    const bool rings = ring != 0 && ((channel.ctrl >> 12U & 1U) != 0) == write;
    const std::uint32_t mask = rings ? (1U << ring) - 1U : ~0U;
    return (address & ~mask) | (next & mask);
}

void DmaChannels::move_one(unsigned number)
{
    Channel& channel = channels_[number];
    const unsigned code = channel.ctrl >> 2U & 3U;
    if (code == 3 || (channel.ctrl >> 24U & 3U) != 0) {
        complain(number, "a size or a swap that is not modelled");
    }
    const unsigned size = 1U << code;
    if (channel.from % size != 0 || channel.to % size != 0) {
        complain(number, "an address between words");
    }
    const std::uint32_t from = channel.from;
    const std::uint32_t to = channel.to;
    channel.from = step(channel, from, false);
    channel.to = step(channel, to, true);
    --channel.count;
    wiring_.write(to, size, wiring_.read(from, size));
    if (channel.count == 0 && channel.busy) {
        finish(number);
    }
}

void DmaChannels::finish(unsigned number)
{
    Channel& channel = channels_[number];
    channel.busy = false;
    channel.done_at = kNever;
    if ((channel.ctrl & kQuiet) == 0) {
        raised_ |= 1U << number;
    }
    update_lines();
    const unsigned next = channel.ctrl >> 13U & 15U;
    if (next != number) {
        trigger(next, false);
    }
    again_ = true;
}

// A word that is moved may make a block ask for another one.
void DmaChannels::look()
{
    again_ = true;
    if (looking_) {
        return;
    }
    looking_ = true;
    while (std::exchange(again_, false)) {
        for (unsigned i = 0; i < kChannels; ++i) {
            const unsigned request = request_of(channels_[i]);
            while (channels_[i].busy && (channels_[i].ctrl & kOn) != 0 && request < kFirstTimer &&
                   wiring_.asks(request)) {
                move_one(i);
            }
        }
    }
    looking_ = false;
    plan();
}

Picoseconds DmaChannels::timer_period(unsigned timer) const
{
    const std::uint32_t x = timers_[timer] >> 16U;
    const std::uint32_t y = timers_[timer] & 0xFFFFU;
    if (x == 0 || y == 0) {
        return kNever;
    }
    return static_cast<Picoseconds>(static_cast<double>(kSecond) * y / x / wiring_.clock_hz());
}

void DmaChannels::happen()
{
    for (unsigned i = 0; i < kChannels; ++i) {
        Channel& channel = channels_[i];
        while (channel.busy && channel.done_at <= circuit_.now) {
            move_one(i);
        }
    }
    for (unsigned timer = 0; timer < kTimers; ++timer) {
        if (timers_due_[timer] > circuit_.now) {
            continue;
        }
        timers_due_[timer] += timer_period(timer);
        for (unsigned i = 0; i < kChannels; ++i) {
            if (channels_[i].busy && request_of(channels_[i]) == kFirstTimer + timer) {
                move_one(i);
            }
        }
    }
    look();
}

void DmaChannels::plan()
{
    due_ = kNever;
    for (const Channel& channel : channels_) {
        due_ = channel.busy ? std::min(due_, channel.done_at) : due_;
    }
    for (const Picoseconds due : timers_due_) {
        due_ = std::min(due_, due);
    }
    circuit_.next_event = 0;
}

void DmaChannels::abort(std::uint32_t mask)
{
    for (unsigned i = 0; i < kChannels; ++i) {
        Channel& channel = channels_[i];
        if ((mask >> i & 1U) == 0) {
            continue;
        }
        // Erratum E5: the end of an abort starts the channel again, or the next of its chain.
        if ((channel.ctrl & kOn) != 0) {
            complain(i, "aborted while it is on (erratum E5)");
        }
        channel.busy = false;
        channel.count = 0;
        channel.done_at = kNever;
    }
}

void DmaChannels::update_lines()
{
    for (unsigned i = 0; i < 4; ++i) {
        circuit_.set_line(wiring_.interrupt + i, ((raised_ & enabled_[i]) | forced_[i]) != 0);
    }
}

std::uint32_t DmaChannels::read(std::uint32_t offset)
{
    if (offset < 0x400) {
        return read_channel(offset);
    }
    if (offset < 0x440) {
        const unsigned line = (offset - 0x400) / 16;
        switch (offset % 16) {
            case 0:
                return raised_;
            case 4:
                return enabled_[line];
            case 8:
                return forced_[line];
            default:
                return (raised_ & enabled_[line]) | forced_[line];
        }
    }
    if (offset < 0x450) {
        return timers_[(offset - 0x440) / 4];
    }
    if (offset >= 0x800 && offset < 0x800 + 0x40 * kChannels) {
        return offset % 0x40 == 4 ? channels_[(offset - 0x800) / 0x40].reload : 0U;
    }
    switch (offset) {
        case 0x464:  // aborts take no time
            return 0;
        case 0x468:
            return kChannels;
        default:
            circuit_.violate("DMA: a register is read that is not modelled, " +
                             hexadecimal(offset));
            return 0;
    }
}

void DmaChannels::write(std::uint32_t offset, std::uint32_t value)
{
    if (offset < 0x400) {
        write_channel(offset, value);
        return;
    }
    if (offset < 0x440) {
        const unsigned line = (offset - 0x400) / 16;
        if (offset % 16 == 4) {
            enabled_[line] = value & 0xFFFFU;
        } else if (offset % 16 == 8) {
            forced_[line] = value & 0xFFFFU;
        } else {
            raised_ &= ~value;
        }
        update_lines();
    } else if (offset < 0x450) {
        const unsigned timer = (offset - 0x440) / 4;
        timers_[timer] = value;
        const Picoseconds period = timer_period(timer);
        timers_due_[timer] = period == kNever ? kNever : circuit_.now + period;
        plan();
    } else if (offset == 0x450) {
        for (unsigned i = 0; i < kChannels; ++i) {
            if ((value >> i & 1U) != 0) {
                trigger(i, false);
            }
        }
        look();
    } else if (offset == 0x464) {
        abort(value);
        plan();
    } else {
        circuit_.violate("DMA: a register is written that is not modelled, " + hexadecimal(offset));
    }
}

}  // namespace cusp::cosim::rp2350
