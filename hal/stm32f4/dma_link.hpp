// DmaLink: the serial line through USART1, both ways by DMA: while the core stands still, as it does
// when the flash is erased, bytes still come in.
//
// Received bytes go round in a ring that stream 2 of DMA2 fills; what is sent leaves a ring through
// stream 7, a piece at a time (RM0090 table 43: both by channel 4). The port's receive interrupt
// only wakes the core: the byte is the stream's.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "hal/contract/board.hpp"
#include "hal/stm32f4/registers.hpp"

namespace cusp::hal::stm32f4 {

template <class Chip>
class DmaLink {
public:
    // Precondition: the clocks of USART1 and DMA2 are on and the pins are set.
    void start(std::uint32_t bus_hz, std::uint32_t baud) noexcept;

    // See hal/contract/board.hpp.
    bool try_read(std::uint8_t& byte) noexcept;
    bool overrun() noexcept;
    std::uint32_t write_room() const noexcept;
    void write(Span<const std::uint8_t> bytes) noexcept;

    // The port's interrupt, and that of the stream that sends.
    void on_interrupt() noexcept;

private:
    // More than a sender may have under way (1024 bytes, as `$I` says) and its questions while a
    // sector is erased.
    static constexpr std::uint32_t kReceiveSize = 2048;
    static constexpr std::uint32_t kSendSize = 512;

    static constexpr std::uint32_t kLost = 1U << 3U | 1U << 1U;  // overrun, framing error
    static constexpr std::uint32_t kReceiver = 1U << 2U;
    static constexpr std::uint32_t kTransmitter = 1U << 3U;
    static constexpr std::uint32_t kReceiveInterrupt = 1U << 5U;
    static constexpr std::uint32_t kPortEnable = 1U << 13U;
    static constexpr std::uint32_t kReceiveByDma = 1U << 6U;
    static constexpr std::uint32_t kTransmitByDma = 1U << 7U;

    static constexpr unsigned kReceiveStream = 2;
    static constexpr unsigned kSendStream = 7;
    static constexpr std::uint32_t kReceiveHalf = 16U << 16U;  // in the low flags
    static constexpr std::uint32_t kReceiveEnd = 32U << 16U;
    static constexpr std::uint32_t kReceiveFlags = 0x3DU << 16U;
    static constexpr std::uint32_t kSendFlags = 0x3DU << 22U;  // in the high flags
    static constexpr std::uint32_t kSendEnd = 32U << 22U;
    static constexpr std::uint32_t kStreamEnable = 1U << 0U;
    // Bytes, memory goes on; the port's streams are less urgent than the pulses'.
    static constexpr std::uint32_t kBytes = 4U << 25U | 1U << 16U | 1U << 10U;
    static constexpr std::uint32_t kReceiveSettings = kBytes | 1U << 8U;
    static constexpr std::uint32_t kSendSettings = kBytes | 1U << 6U | 1U << 4U;

    std::uint32_t head() const noexcept
    {
        const std::uint32_t left = Chip::dma2().stream[kReceiveStream].ndtr.read();
        return left == 0 || left > kReceiveSize ? 0 : kReceiveSize - left;
    }
    void send_piece() noexcept;

    std::array<std::uint8_t, kReceiveSize> received_{};
    std::uint32_t tail_{0};
    std::uint32_t seen_{0};    // head when overrun() looked last
    std::uint32_t unread_{0};  // bytes between tail and head then

    std::array<std::uint8_t, kSendSize> sent_{};
    std::uint32_t send_head_{0};  // both count bytes and wrap at 2^32
    std::atomic<std::uint32_t> send_tail_{0};
    std::atomic<std::uint32_t> piece_{0};  // bytes on their way
    std::atomic<bool> lost_{false};
};

template <class Chip>
void DmaLink<Chip>::start(std::uint32_t bus_hz, std::uint32_t baud) noexcept
{
    auto& port = Chip::usart1();
    auto& dma = Chip::dma2();
    auto& receive = dma.stream[kReceiveStream];
    dma.lifcr.write(kReceiveFlags);
    dma.hifcr.write(kSendFlags);
    receive.par.write(Chip::bus_address(&port.dr));
    receive.m0ar.write(Chip::bus_address(received_.data()));
    receive.ndtr.write(kReceiveSize);
    receive.fcr.write(0);
    receive.cr.write(kReceiveSettings);
    receive.cr.write(kReceiveSettings | kStreamEnable);
    auto& send = dma.stream[kSendStream];
    send.par.write(Chip::bus_address(&port.dr));
    send.fcr.write(0);
    port.brr.write((bus_hz + baud / 2) / baud);
    port.cr3.write(kReceiveByDma | kTransmitByDma);
    port.cr1.write(kPortEnable | kTransmitter | kReceiver | kReceiveInterrupt);
}

template <class Chip>
bool DmaLink<Chip>::try_read(std::uint8_t& byte) noexcept
{
    if (tail_ == head()) {
        return false;
    }
    std::atomic_thread_fence(std::memory_order_acquire);
    byte = received_[tail_];
    tail_ = (tail_ + 1) % kReceiveSize;
    return true;
}

// Called before each reading. The stream passes its middle and its end: where it has passed both and
// stands less than half a ring further, it went all the way round.
template <class Chip>
bool DmaLink<Chip>::overrun() noexcept
{
    const std::uint32_t raised = Chip::dma2().lisr.read();
    const std::uint32_t now = head();
    Chip::dma2().lifcr.write(raised & kReceiveFlags);
    const std::uint32_t came = (now + kReceiveSize - seen_) % kReceiveSize;
    const bool both = (raised & kReceiveHalf) != 0 && (raised & kReceiveEnd) != 0;
    // A flag may have been raised just after it was read here: it is the next call's.
    constexpr std::uint32_t kLate = 64;
    const bool lapped = unread_ + came >= kReceiveSize || (both && came + kLate < kReceiveSize / 2);
    seen_ = now;
    unread_ = (now + kReceiveSize - tail_) % kReceiveSize;
    return lost_.exchange(false, std::memory_order_relaxed) || lapped;
}

template <class Chip>
std::uint32_t DmaLink<Chip>::write_room() const noexcept
{
    return kSendSize - (send_head_ - send_tail_.load(std::memory_order_acquire));
}

template <class Chip>
void DmaLink<Chip>::write(Span<const std::uint8_t> bytes) noexcept
{
    for (const std::uint8_t byte : bytes) {
        sent_[send_head_ % kSendSize] = byte;
        ++send_head_;
    }
    std::atomic_thread_fence(std::memory_order_release);
    // The interrupt, which may come now, goes on with what is there.
    if (piece_.load(std::memory_order_acquire) == 0) {
        send_piece();
    }
}

template <class Chip>
void DmaLink<Chip>::send_piece() noexcept
{
    const std::uint32_t tail = send_tail_.load(std::memory_order_relaxed);
    const std::uint32_t waiting = send_head_ - tail;
    const std::uint32_t to_end = kSendSize - tail % kSendSize;
    const std::uint32_t size = waiting < to_end ? waiting : to_end;
    if (size == 0) {
        return;
    }
    piece_.store(size, std::memory_order_release);
    auto& send = Chip::dma2().stream[kSendStream];
    send.m0ar.write(Chip::bus_address(&sent_[tail % kSendSize]));
    send.ndtr.write(size);
    send.cr.write(kSendSettings);
    send.cr.write(kSendSettings | kStreamEnable);
}

template <class Chip>
void DmaLink<Chip>::on_interrupt() noexcept
{
    // The stream's reading of the byte clears the errors, once they were read here.
    if ((Chip::usart1().sr.read() & kLost) != 0) {
        lost_.store(true, std::memory_order_relaxed);
    }
    const std::uint32_t raised = Chip::dma2().hisr.read() & kSendFlags;
    Chip::dma2().hifcr.write(raised);
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
