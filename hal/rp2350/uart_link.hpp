// UartLink: the serial line through UART0. Its interrupt takes the bytes, also while the flash is erased: nothing that
// runs lies there.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "hal/contract/board.hpp"
#include "hal/contract/received_bytes.hpp"
#include "hal/rp2350/chip_registers.hpp"
#include "hal/rp2350/gp_pins.hpp"
#include "hal/rp2350/rp2350.hpp"

namespace cusp::hal::rp2350 {

template <class Chip>
class UartLink {
public:
    static constexpr Pin kTransmit = GP(0);
    static constexpr Pin kReceive = GP(1);

    // Precondition: the block is out of reset and has its clock, the pins are set.
    void start(std::uint32_t clock_hz, std::uint32_t baud) noexcept;

    // See hal/contract/board.hpp.
    bool try_read(std::uint8_t& byte) noexcept { return received_.try_read(byte); }
    bool try_scan(std::uint8_t& byte) noexcept { return received_.try_scan(byte); }
    bool overrun() noexcept { return lost_.exchange(false, std::memory_order_relaxed); }
    std::uint32_t write_room() const noexcept
    {
        return kSendSize - (send_head_.load(std::memory_order_relaxed) -
                            send_tail_.load(std::memory_order_acquire));
    }
    void write(Span<const std::uint8_t> bytes) noexcept;

    void on_interrupt() noexcept;

private:
    // More than a sender may have in transit (1024 bytes, as `$I` reports) plus its status queries while a sector is
    // erased.
    static constexpr std::uint32_t kReceiveSize = 2048;
    static constexpr std::uint32_t kSendSize = 512;

    static constexpr std::uint32_t kReceiveEmpty = 1U << 4U;  // FR
    static constexpr std::uint32_t kSendFull = 1U << 5U;
    static constexpr std::uint32_t kByteErrors = 0xFU << 8U;  // DR: framing, parity, break, overrun
    static constexpr std::uint32_t kReceived =
        1U << 4U | 1U << 6U;  // IMSC: some bytes, or one and silence
    static constexpr std::uint32_t kSendLow = 1U << 5U;

    void receive() noexcept;
    void send() noexcept;

    ReceivedBytes<kReceiveSize> received_;
    std::array<std::uint8_t, kSendSize> sent_{};
    // Both count bytes and wrap at 2^32.
    std::atomic<std::uint32_t> send_head_{0};  // by the main loop
    std::atomic<std::uint32_t> send_tail_{0};  // by the interrupt
    std::atomic<bool> lost_{false};
};

template <class Chip>
void UartLink<Chip>::start(std::uint32_t clock_hz, std::uint32_t baud) noexcept
{
    constexpr std::uint32_t kFifos = 1U << 4U;
    constexpr std::uint32_t kEightBits = 3U << 5U;
    constexpr std::uint32_t kOn = 1U << 0U | 1U << 8U | 1U << 9U;  // port, transmitter, receiver
    auto& uart = Chip::uart0();
    // In 64ths, rounded (12.1.7.1).
    const std::uint32_t divisor = (8 * clock_hz / baud + 1) / 2;
    uart.ibrd.write(divisor >> 6U);
    uart.fbrd.write(divisor & 0x3FU);
    uart.lcr_h.write(kEightBits | kFifos);
    uart.ifls.write(0);  // from an eighth of a FIFO on: 4 bytes
    uart.imsc.write(kReceived);
    uart.cr.write(kOn);
}

template <class Chip>
void UartLink<Chip>::write(Span<const std::uint8_t> bytes) noexcept
{
    std::uint32_t head = send_head_.load(std::memory_order_relaxed);
    for (const std::uint8_t byte : bytes) {
        sent_[head % kSendSize] = byte;
        ++head;
    }
    send_head_.store(head, std::memory_order_release);
    Chip::interrupts().ispr[kUart0Interrupt / 32].write(1U << kUart0Interrupt % 32);
}

template <class Chip>
void UartLink<Chip>::on_interrupt() noexcept
{
    receive();
    send();
}

// A ring that is full keeps what it has: what comes is lost, and told.
template <class Chip>
void UartLink<Chip>::receive() noexcept
{
    constexpr unsigned kBytesAtOnce = 32;
    auto& uart = Chip::uart0();
    for (unsigned i = 0; i < kBytesAtOnce && (uart.fr.read() & kReceiveEmpty) == 0; ++i) {
        const std::uint32_t entry = uart.dr.read();
        const bool full = received_.room() == 0;
        if ((entry & kByteErrors) != 0 || full) {
            lost_.store(true, std::memory_order_relaxed);
        }
        if (!full) {
            const auto byte = static_cast<std::uint8_t>(entry & 0xFFU);
            received_.put({&byte, 1});
        }
    }
}

template <class Chip>
void UartLink<Chip>::send() noexcept
{
    constexpr unsigned kBytesAtOnce = 32;
    auto& uart = Chip::uart0();
    const std::uint32_t head = send_head_.load(std::memory_order_acquire);
    std::uint32_t tail = send_tail_.load(std::memory_order_relaxed);
    for (unsigned i = 0; i < kBytesAtOnce && tail != head && (uart.fr.read() & kSendFull) == 0;
         ++i) {
        uart.dr.write(sent_[tail % kSendSize]);
        ++tail;
    }
    send_tail_.store(tail, std::memory_order_release);
    uart.imsc.write(tail == head ? kReceived : kReceived | kSendLow);
}

}  // namespace cusp::hal::rp2350
