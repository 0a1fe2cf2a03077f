// DmaLink: the serial line through a USART, both ways by DMA: bytes are received even while the core
// is stalled, as during an erase of the flash.
//
// Received bytes go round in a ring that one stream fills; what is sent leaves a ring through
// another, a piece at a time. The port's receive interrupt only wakes the core: the byte is the
// stream's.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "hal/contract/board.hpp"
#include "hal/stm32f4/dma_streams.hpp"
#include "hal/stm32f4/registers.hpp"
#include "hal/stm32f4/serial_ports.hpp"

namespace cusp::hal::stm32f4 {

// `Port` is one of hal/stm32f4/serial_ports.hpp.
template <class Chip, class Port>
class DmaLink {
public:
    // Precondition: the clocks of port and controller are on and the pins are set.
    void start(std::uint32_t bus_hz, std::uint32_t baud) noexcept;

    // See hal/contract/board.hpp.
    bool try_read(std::uint8_t& byte) noexcept;
    bool try_scan(std::uint8_t& byte) noexcept;
    bool overrun() noexcept;
    std::uint32_t write_room() const noexcept;
    void write(Span<const std::uint8_t> bytes) noexcept;

    // The port's interrupt, and that of the stream that sends.
    void on_interrupt() noexcept;

private:
    // More than a sender may have in transit (1024 bytes, as `$I` reports) plus its status queries
    // while a sector is erased.
    static constexpr std::uint32_t kReceiveSize = 2048;
    static constexpr auto kTurn = static_cast<std::int32_t>(kReceiveSize);
    static constexpr std::uint32_t kSendSize = 512;

    static constexpr std::uint32_t kLost =
        1U << 3U | 1U << 2U | 1U << 1U;  // overrun, noise, framing
    static constexpr std::uint32_t kReceiver = 1U << 2U;
    static constexpr std::uint32_t kTransmitter = 1U << 3U;
    static constexpr std::uint32_t kReceiveInterrupt = 1U << 5U;
    static constexpr std::uint32_t kPortEnable = 1U << 13U;
    static constexpr std::uint32_t kReceiveByDma = 1U << 6U;
    static constexpr std::uint32_t kTransmitByDma = 1U << 7U;

    static constexpr unsigned kReceivePlace = stream_flag_place(Port::kReceiveStream);
    static constexpr unsigned kSendPlace = stream_flag_place(Port::kSendStream);
    static constexpr std::uint32_t kReceiveHalf = kStreamHalf << kReceivePlace;
    static constexpr std::uint32_t kReceiveEnd = kStreamComplete << kReceivePlace;
    static constexpr std::uint32_t kReceiveFlags = kStreamAllFlags << kReceivePlace;
    static constexpr std::uint32_t kSendFlags = kStreamAllFlags << kSendPlace;
    static constexpr std::uint32_t kSendEnd = kStreamComplete << kSendPlace;
    // Bytes, memory increments; the port's streams have a lower priority than the pulses'.
    static constexpr std::uint32_t kBytes = 4U << 25U | 1U << 16U | 1U << 10U;
    static constexpr std::uint32_t kReceiveSettings = kBytes | 1U << 8U;
    static constexpr std::uint32_t kSendSettings = kBytes | 1U << 6U | 1U << 4U;

    static auto& receive_stream() noexcept { return Port::dma().stream[Port::kReceiveStream]; }
    static auto& send_stream() noexcept { return Port::dma().stream[Port::kSendStream]; }
    std::uint32_t head() const noexcept
    {
        const std::uint32_t left = receive_stream().ndtr.read();
        return left == 0 || left > kReceiveSize ? 0 : kReceiveSize - left;
    }
    void send_piece() noexcept;

    std::array<std::uint8_t, kReceiveSize> received_{};
    // These count bytes and wrap at 2^32. The main loop writes the first, the servo tick the others.
    std::atomic<std::uint32_t> read_{0};
    std::atomic<std::uint32_t> arrived_{0};  // up to the last try_scan()
    std::uint32_t scanned_{0};
    std::uint32_t seen_{0};    // head when overrun() looked last
    std::uint32_t unread_{0};  // bytes between tail and head then

    std::array<std::uint8_t, kSendSize> sent_{};
    std::uint32_t send_head_{0};  // both count bytes and wrap at 2^32
    std::atomic<std::uint32_t> send_tail_{0};
    std::atomic<std::uint32_t> piece_{0};  // bytes on their way
    std::atomic<bool> lost_{false};
};

template <class Chip, class Port>
void DmaLink<Chip, Port>::start(std::uint32_t bus_hz, std::uint32_t baud) noexcept
{
    auto& port = Port::usart();
    auto& receive = receive_stream();
    stream_flag_clear(Port::dma(), Port::kReceiveStream).write(kReceiveFlags);
    stream_flag_clear(Port::dma(), Port::kSendStream).write(kSendFlags);
    receive.par.write(Chip::bus_address(&port.dr));
    receive.m0ar.write(Chip::bus_address(received_.data()));
    receive.ndtr.write(kReceiveSize);
    receive.fcr.write(0);
    receive.cr.write(kReceiveSettings);
    receive.cr.write(kReceiveSettings | kStreamEnable);
    auto& send = send_stream();
    send.par.write(Chip::bus_address(&port.dr));
    send.fcr.write(0);
    port.brr.write((bus_hz + baud / 2) / baud);
    port.cr3.write(kReceiveByDma | kTransmitByDma);
    port.cr1.write(kPortEnable | kTransmitter | kReceiver | kReceiveInterrupt);
}

template <class Chip, class Port>
bool DmaLink<Chip, Port>::try_read(std::uint8_t& byte) noexcept
{
    const std::uint32_t read = read_.load(std::memory_order_relaxed);
    if (read % kReceiveSize == head()) {
        return false;
    }
    std::atomic_thread_fence(std::memory_order_acquire);
    byte = received_[read % kReceiveSize];
    read_.store(read + 1, std::memory_order_relaxed);
    return true;
}

// The ring goes round in 20 ms at 1 Mbaud at the earliest: no tick misses a turn but while a sector
// is erased, which overrun() finds out.
template <class Chip, class Port>
bool DmaLink<Chip, Port>::try_scan(std::uint8_t& byte) noexcept
{
    const std::uint32_t before = arrived_.load(std::memory_order_relaxed);
    const std::uint32_t arrived = before + (head() - before) % kReceiveSize;
    arrived_.store(arrived, std::memory_order_relaxed);
    // Bytes that were read are not scanned, unless the ring has lapped the reader.
    const std::uint32_t read = read_.load(std::memory_order_relaxed);
    const bool lapped = static_cast<std::int32_t>(arrived - read) >= kTurn;
    if (!lapped && static_cast<std::int32_t>(read - scanned_) > 0) {
        scanned_ = read;
    }
    if (static_cast<std::int32_t>(arrived - scanned_) <= 0) {
        return false;
    }
    std::atomic_thread_fence(std::memory_order_acquire);
    byte = received_[scanned_ % kReceiveSize];
    ++scanned_;
    return true;
}

// Called before each reading. The stream passes its middle and its end: if it has passed both and is
// less than half a ring further, it has overrun the ring. If this was not called for longer, the
// tick has counted the turns.
template <class Chip, class Port>
bool DmaLink<Chip, Port>::overrun() noexcept
{
    const std::uint32_t raised = stream_flags(Port::dma(), Port::kReceiveStream).read();
    const std::uint32_t now = head();
    stream_flag_clear(Port::dma(), Port::kReceiveStream).write(raised & kReceiveFlags);
    const std::uint32_t came = (now + kReceiveSize - seen_) % kReceiveSize;
    const bool both = (raised & kReceiveHalf) != 0 && (raised & kReceiveEnd) != 0;
    // A flag raised just after this reading counts for the next call.
    constexpr std::uint32_t kLate = 64;
    bool lapped = unread_ + came >= kReceiveSize || (both && came + kLate < kReceiveSize / 2);
    std::uint32_t read = read_.load(std::memory_order_relaxed);
    const auto behind = static_cast<std::int32_t>(arrived_.load(std::memory_order_relaxed) - read);
    if (behind >= kTurn) {
        lapped = true;
        read += static_cast<std::uint32_t>(behind / kTurn) * kReceiveSize;
        read_.store(read, std::memory_order_relaxed);
    }
    seen_ = now;
    unread_ = (now - read) % kReceiveSize;
    return lost_.exchange(false, std::memory_order_relaxed) || lapped;
}

template <class Chip, class Port>
std::uint32_t DmaLink<Chip, Port>::write_room() const noexcept
{
    return kSendSize - (send_head_ - send_tail_.load(std::memory_order_acquire));
}

template <class Chip, class Port>
void DmaLink<Chip, Port>::write(Span<const std::uint8_t> bytes) noexcept
{
    for (const std::uint8_t byte : bytes) {
        sent_[send_head_ % kSendSize] = byte;
        ++send_head_;
    }
    std::atomic_thread_fence(std::memory_order_release);
    // If the interrupt comes now, it sends the remaining bytes.
    if (piece_.load(std::memory_order_acquire) == 0) {
        send_piece();
    }
}

template <class Chip, class Port>
void DmaLink<Chip, Port>::send_piece() noexcept
{
    const std::uint32_t tail = send_tail_.load(std::memory_order_relaxed);
    const std::uint32_t waiting = send_head_ - tail;
    const std::uint32_t to_end = kSendSize - tail % kSendSize;
    const std::uint32_t size = waiting < to_end ? waiting : to_end;
    if (size == 0) {
        return;
    }
    piece_.store(size, std::memory_order_release);
    auto& send = send_stream();
    send.m0ar.write(Chip::bus_address(&sent_[tail % kSendSize]));
    send.ndtr.write(size);
    send.cr.write(kSendSettings);
    send.cr.write(kSendSettings | kStreamEnable);
}

template <class Chip, class Port>
void DmaLink<Chip, Port>::on_interrupt() noexcept
{
    // Errors go when the state is read and then the byte (RM0090 section 30.6.1). The stream alone does
    // not do: after an overrun it has read its byte before, and the interrupt would come without end.
    if ((Port::usart().sr.read() & kLost) != 0) {
        static_cast<void>(Port::usart().dr.read());
        lost_.store(true, std::memory_order_relaxed);
    }
    const std::uint32_t raised = stream_flags(Port::dma(), Port::kSendStream).read() & kSendFlags;
    stream_flag_clear(Port::dma(), Port::kSendStream).write(raised);
    if ((raised & kSendEnd) == 0) {
        return;
    }
    send_tail_.store(
        send_tail_.load(std::memory_order_relaxed) + piece_.load(std::memory_order_relaxed),
        std::memory_order_release);
    piece_.store(0, std::memory_order_release);
    send_piece();
}

}  // namespace cusp::hal::stm32f4
