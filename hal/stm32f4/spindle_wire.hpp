// SpindleWire: messages to a spindle's drive over RS-485, through a USART with DMA both ways.
//
// A pin tells the transceiver who speaks: high while the chip does. The port's interrupt at the end of the last
// bit lowers it and lets the stream of what comes begin; no other interrupt is needed.
//
// Never tried on silicon; runs against a model of port and drive in tests/target/cosim.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "firmware/base/span.hpp"
#include "hal/stm32f4/dma_streams.hpp"
#include "hal/stm32f4/pins.hpp"
#include "hal/stm32f4/registers.hpp"

namespace cusp::hal::stm32f4 {

// The pins of a USART, and the transceiver's.
struct SpindleWirePins {
    Pin transmit, receive, sends;
};

// `Port` is one of hal/stm32f4/serial_ports.hpp, `Table` has kSpindleWire, its pins.
template <class Chip, class Port, class Table>
class SpindleWire {
public:
    // Precondition: the clocks of ports, USART and controller are on, its pins are set.
    void start(std::uint32_t bus_hz) noexcept
    {
        bus_hz_ = bus_hz;
        constexpr Pin kSends = Table::kSpindleWire.sends;
        set_level(Chip::port(kSends.port), kSends.number, false);
        set_pin(Chip::port(kSends.port), kSends.number, PinMode::kOutput);
    }

    // See hal/contract/board.hpp.
    void begin(Span<const std::uint8_t> bytes, std::uint32_t baud) noexcept;
    std::size_t heard(Span<std::uint8_t> answer) const noexcept;
    bool let_go() noexcept;

    // The port's; harmless at any time.
    void on_interrupt() noexcept;

private:
    static constexpr unsigned kMostBytes = 16;
    static constexpr std::uint32_t kReceiver = 1U << 2U;
    static constexpr std::uint32_t kTransmitter = 1U << 3U;
    static constexpr std::uint32_t kCompleteInterrupt = 1U << 6U;
    static constexpr std::uint32_t kPortEnable = 1U << 13U;
    static constexpr std::uint32_t kByDma = 1U << 6U | 1U << 7U;
    static constexpr std::uint32_t kComplete = 1U << 6U;
    // Bytes by channel 4, memory increments.
    static constexpr std::uint32_t kBytes = 4U << 25U | 1U << 10U;
    static constexpr std::uint32_t kToPort = 1U << 6U;
    static constexpr unsigned kDisableRounds = 1000;

    static auto& receive_stream() noexcept { return Port::dma().stream[Port::kReceiveStream]; }
    static auto& send_stream() noexcept { return Port::dma().stream[Port::kSendStream]; }
    static void talk(bool on) noexcept
    {
        constexpr Pin kSends = Table::kSpindleWire.sends;
        set_level(Chip::port(kSends.port), kSends.number, on);
    }
    template <class Stream>
    static void halt(Stream& stream) noexcept
    {
        stream.cr.write(stream.cr.read() & ~kStreamEnable);
        for (unsigned round = 0; round < kDisableRounds && (stream.cr.read() & kStreamEnable) != 0;
             ++round) {
        }
    }
    template <class Stream>
    void run(Stream& stream,
             unsigned number,
             std::uint8_t* memory,
             std::uint32_t count,
             std::uint32_t settings) noexcept
    {
        stream_flag_clear(Port::dma(), number).write(kStreamAllFlags << stream_flag_place(number));
        std::atomic_thread_fence(std::memory_order_release);
        stream.par.write(Chip::bus_address(&Port::usart().dr));
        stream.m0ar.write(Chip::bus_address(memory));
        stream.ndtr.write(count);
        stream.fcr.write(0);
        stream.cr.write(settings);
        stream.cr.write(settings | kStreamEnable);
    }

    std::array<std::uint8_t, kMostBytes> sent_{};
    std::array<std::uint8_t, kMostBytes> heard_{};
    std::uint32_t bus_hz_{0};
    std::atomic<bool> sends_{false};
    std::atomic<bool> listens_{false};
};

template <class Chip, class Port, class Table>
void SpindleWire<Chip, Port, Table>::begin(Span<const std::uint8_t> bytes,
                                           std::uint32_t baud) noexcept
{
    auto& port = Port::usart();
    // Off: what is on its way is given up, and the rate may be set.
    port.cr1.write(0);
    sends_.store(false, std::memory_order_relaxed);
    listens_.store(false, std::memory_order_relaxed);
    halt(receive_stream());
    halt(send_stream());
    const std::uint32_t count = bytes.size() < kMostBytes ? bytes.size() : kMostBytes;
    for (std::uint32_t i = 0; i < count; ++i) {
        sent_[i] = bytes[i];
    }
    port.brr.write((bus_hz_ + baud / 2) / baud);
    port.cr3.write(kByDma);
    talk(true);
    port.cr1.write(kPortEnable | kTransmitter);
    port.sr.write(~kComplete);
    run(send_stream(), Port::kSendStream, sent_.data(), count, kBytes | kToPort);
    sends_.store(true, std::memory_order_relaxed);
    port.cr1.write(kPortEnable | kTransmitter | kCompleteInterrupt);
}

template <class Chip, class Port, class Table>
bool SpindleWire<Chip, Port, Table>::let_go() noexcept
{
    bool sends = true;
    if (!sends_.compare_exchange_strong(sends, false)) {
        return false;
    }
    Port::usart().cr1.write(0);
    talk(false);
    halt(send_stream());
    return true;
}

template <class Chip, class Port, class Table>
void SpindleWire<Chip, Port, Table>::on_interrupt() noexcept
{
    auto& port = Port::usart();
    if (!sends_.load(std::memory_order_relaxed) || (port.sr.read() & kComplete) == 0) {
        return;
    }
    if (send_stream().ndtr.read() != 0) {
        port.sr.write(~kComplete);  // of what went before the message
        return;
    }
    sends_.store(false, std::memory_order_relaxed);
    talk(false);
    run(receive_stream(), Port::kReceiveStream, heard_.data(), kMostBytes, kBytes);
    port.cr1.write(kPortEnable | kReceiver);
    listens_.store(true, std::memory_order_release);
}

template <class Chip, class Port, class Table>
std::size_t SpindleWire<Chip, Port, Table>::heard(Span<std::uint8_t> answer) const noexcept
{
    if (!listens_.load(std::memory_order_acquire)) {
        return 0;
    }
    const std::size_t came = kMostBytes - receive_stream().ndtr.read();
    const std::size_t count = came < answer.size() ? came : answer.size();
    for (std::size_t i = 0; i < count; ++i) {
        answer[i] = heard_[i];
    }
    return count;
}

}  // namespace cusp::hal::stm32f4
