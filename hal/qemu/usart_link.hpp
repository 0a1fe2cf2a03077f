// UsartLink: the serial line through USART1 as QEMU models it: a ring and an interrupt for received
// bytes, polling for sent ones. On the chip stm32f4::DmaLink is used.
#pragma once

#include <atomic>
#include <cstdint>

#include "firmware/base/spsc_ring.hpp"
#include "hal/contract/board.hpp"
#include "hal/stm32f4/registers.hpp"

namespace cusp::hal::qemu {

template <class Chip>
class UsartLink {
public:
    // Precondition: the clock of USART1 is on and its pins are set.
    void start(std::uint32_t bus_hz, std::uint32_t baud) noexcept
    {
        auto& port = Chip::usart1();
        port.brr.write((bus_hz + baud / 2) / baud);
        port.cr1.write(kPortEnable | kTransmitter | kReceiver | kReceiveInterrupt);
    }

    // See hal/contract/board.hpp. write() waits for the port byte by byte.
    bool try_read(std::uint8_t& byte) noexcept { return received_.try_pop(byte); }
    bool try_scan(std::uint8_t& byte) noexcept { return received_.try_peek(scanned_, byte); }
    bool overrun() noexcept { return overrun_.exchange(false, std::memory_order_relaxed); }
    std::uint32_t write_room() const noexcept { return kRoom; }
    void write(Span<const std::uint8_t> bytes) noexcept
    {
        for (const std::uint8_t byte : bytes) {
            send(byte);
        }
    }

    // The port's interrupt.
    void on_interrupt() noexcept
    {
        auto& port = Chip::usart1();
        const std::uint32_t state = port.sr.read();
        if ((state & kLost) != 0) {
            overrun_.store(true, std::memory_order_relaxed);
        }
        // Reading the byte also clears the errors.
        if ((state & (kReceived | kLost)) != 0) {
            const auto byte = static_cast<std::uint8_t>(port.dr.read());
            if ((state & kReceived) != 0 && !received_.try_push(byte)) {
                overrun_.store(true, std::memory_order_relaxed);
            }
        }
    }

private:
    static constexpr std::uint32_t kLost = 1U << 3U | 1U << 1U;  // overrun, framing error
    static constexpr std::uint32_t kReceived = 1U << 5U;
    static constexpr std::uint32_t kTransmitEmpty = 1U << 7U;
    static constexpr std::uint32_t kReceiver = 1U << 2U;
    static constexpr std::uint32_t kTransmitter = 1U << 3U;
    static constexpr std::uint32_t kReceiveInterrupt = 1U << 5U;
    static constexpr std::uint32_t kPortEnable = 1U << 13U;
    static constexpr std::uint32_t kRoom = 512;
    // A byte at 9600 baud lasts 175 000 cycles of 168 MHz.
    static constexpr std::uint32_t kSendRounds = 200000;

    static void send(std::uint8_t byte) noexcept
    {
        auto& port = Chip::usart1();
        for (std::uint32_t round = 0; round < kSendRounds && (port.sr.read() & kTransmitEmpty) == 0;
             ++round) {
        }
        port.dr.write(byte);
    }

    // 44 ms of the fastest sender: the firmware, which has the large buffer, takes bytes out far
    // sooner.
    SpscRing<std::uint8_t, 512> received_;
    std::uint32_t scanned_{0};  // the servo tick's place
    std::atomic<bool> overrun_{false};
};

}  // namespace cusp::hal::qemu
