// DriveWire: the single wires of TMC2209 drives on any pins, by DMA: no interrupt makes or reads a bit.
//
// Timer 1 asks stream 5 of DMA2 for one word each bit, which goes to the set/reset register of the wire's
// port. If the drive answers, the stream then samples that port kSamples times a bit, until the answer
// must be over; the main loop finds the bytes in the samples. The interrupt at the end of the request
// turns the pin round: a drive answers no sooner than 8 bits after it.
//
// One drive at a time. At rest all wires are driven high. Not for a board with Timer1Pace. Never tried on
// silicon; runs against a model of the drives in tests/target/cosim.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "firmware/base/span.hpp"
#include "hal/stm32f4/dma_streams.hpp"
#include "hal/stm32f4/peripheral_clocks.hpp"
#include "hal/stm32f4/pins.hpp"
#include "hal/stm32f4/registers.hpp"

namespace cusp::hal::stm32f4 {

// The wires of X, Y, Z and the second motor; a board may lack any.
using DrivePins = std::array<Pin, 4>;
constexpr std::uint8_t drive_wires(const DrivePins& pins) noexcept
{
    unsigned wires = 0;
    for (unsigned i = 0; i < pins.size(); ++i) {
        wires |= is_there(pins[i]) ? 1U << i : 0U;
    }
    return static_cast<std::uint8_t>(wires);
}

// `Table` has kDriveWires, a DrivePins.
template <class Chip, class Table>
class DriveWire {
public:
    static constexpr unsigned kTimer = 1;
    static constexpr unsigned kStream = 5;  // of DMA2; channel 6 is timer 1's update
    static constexpr unsigned kInterrupt = dma2_interrupt(kStream);
    static constexpr PeripheralClocks kClocks{1U << 22U, 0, 1U};

    // Drives the wires high. Uses no statics. Precondition: the clocks of the ports are on.
    static void rest() noexcept;
    // Precondition: the clocks of timer and controller are on; timer 1 counts `timer_hz`.
    void start(std::uint32_t timer_hz) noexcept;

    // See hal/contract/board.hpp.
    void begin(unsigned drive, Span<const std::uint8_t> bytes, bool replies) noexcept;
    bool busy() const noexcept { return phase_.load(std::memory_order_acquire) != Phase::kRest; }
    std::size_t take(Span<std::uint8_t> answer) const noexcept;
    bool let_go() noexcept;

    // Stream 5's.
    void on_interrupt() noexcept;

private:
    enum class Phase : std::uint8_t { kRest, kSending, kListening };

    static constexpr std::uint32_t kBaud = 40000;
    static constexpr unsigned kSamples = 5;
    static constexpr unsigned kBitsOfByte = 10;  // start, eight, stop
    static constexpr unsigned kMostBytes = 8;
    // The last word is written at the begin of its bit: one more for the stop bit's end.
    static constexpr unsigned kMostWords = kMostBytes * kBitsOfByte + 1;
    // 8 bits of delay (SENDDELAY at its reset value), the answer, and some to spare.
    static constexpr unsigned kHeardBits = 8 + kMostBytes * kBitsOfByte + 12;
    static constexpr unsigned kHeard = kHeardBits * kSamples;

    static constexpr std::uint32_t kChannel = 6U << 25U;
    static constexpr std::uint32_t kCompleteInterrupt = 1U << 4U | 1U << 2U;
    static constexpr std::uint32_t kMemoryGoesOn = 1U << 10U;
    static constexpr std::uint32_t kSend =
        kChannel | kCompleteInterrupt | kMemoryGoesOn | 2U << 13U | 2U << 11U | 1U << 6U;
    static constexpr std::uint32_t kListen =
        kChannel | kCompleteInterrupt | kMemoryGoesOn | 1U << 13U | 1U << 11U;
    static constexpr unsigned kPlace = stream_flag_place(kStream);
    static constexpr unsigned kDisableRounds = 1000;

    static auto& timer() noexcept { return Chip::timer1(); }
    static auto& stream() noexcept { return Chip::dma2().stream[kStream]; }
    auto& port() const noexcept { return Chip::port(pin_.port); }
    void run(std::uint32_t settings,
             std::uint32_t place,
             const volatile void* memory,
             std::uint32_t count,
             std::uint32_t period) noexcept;
    static void halt() noexcept;
    bool heard(unsigned sample) const noexcept { return (heard_[sample] >> pin_.number & 1U) != 0; }

    std::array<std::uint32_t, kMostWords> words_{};
    std::array<std::uint16_t, kHeard> heard_{};
    Pin pin_{};
    bool replies_{false};
    std::uint32_t sample_counts_{1};
    std::atomic<Phase> phase_{Phase::kRest};
};

template <class Chip, class Table>
void DriveWire<Chip, Table>::rest() noexcept
{
    for (const Pin pin : Table::kDriveWires) {
        if (is_there(pin)) {
            set_level(Chip::port(pin.port), pin.number, true);
            set_pin(Chip::port(pin.port), pin.number, PinMode::kOutput);
        }
    }
}

template <class Chip, class Table>
void DriveWire<Chip, Table>::start(std::uint32_t timer_hz) noexcept
{
    constexpr std::uint32_t kUpdateRequest = 1U << 8U;
    sample_counts_ = timer_hz / (kBaud * kSamples);
    timer().cr1.write(0);
    timer().psc.write(0);
    timer().dier.write(kUpdateRequest);
}

template <class Chip, class Table>
void DriveWire<Chip, Table>::begin(unsigned drive,
                                   Span<const std::uint8_t> bytes,
                                   bool replies) noexcept
{
    halt();
    phase_.store(Phase::kRest, std::memory_order_relaxed);
    pin_ = Table::kDriveWires[drive];
    replies_ = replies;
    const std::uint32_t high = 1U << pin_.number;
    const std::uint32_t low = high << 16U;
    // The wire may have been left as an input.
    set_level(port(), pin_.number, true);
    set_pin(port(), pin_.number, PinMode::kOutput);
    std::uint32_t count = 0;
    for (const std::uint8_t byte : bytes) {
        // The lowest bit first, between a start and a stop bit.
        const std::uint32_t bits = std::uint32_t{byte} << 1U | 1U << 9U;
        for (unsigned i = 0; i < kBitsOfByte && count + 1 < kMostWords; ++i) {
            words_[count] = (bits >> i & 1U) != 0 ? high : low;
            ++count;
        }
    }
    words_[count] = high;
    phase_.store(Phase::kSending, std::memory_order_relaxed);
    run(kSend, Chip::bus_address(&port().bsrr), words_.data(), count + 1,
        sample_counts_ * kSamples);
}

template <class Chip, class Table>
void DriveWire<Chip, Table>::run(std::uint32_t settings,
                                 std::uint32_t place,
                                 const volatile void* memory,
                                 std::uint32_t count,
                                 std::uint32_t period) noexcept
{
    stream_flag_clear(Chip::dma2(), kStream).write(kStreamAllFlags << kPlace);
    // The words are in memory before the stream reads them.
    std::atomic_thread_fence(std::memory_order_release);
    stream().par.write(place);
    stream().m0ar.write(Chip::bus_address(memory));
    stream().ndtr.write(count);
    stream().fcr.write(0);
    stream().cr.write(settings);
    stream().cr.write(settings | kStreamEnable);
    timer().arr.write(period - 1);
    timer().cnt.write(0);
    timer().cr1.write(1);
}

// The pin turns first: a drive that has the whole request already answers on a wire that nobody drives.
template <class Chip, class Table>
bool DriveWire<Chip, Table>::let_go() noexcept
{
    Phase sending = Phase::kSending;
    if (!replies_ || !phase_.compare_exchange_strong(sending, Phase::kRest)) {
        return false;
    }
    set_pin(port(), pin_.number, PinMode::kInput, Pull::kUp);
    halt();
    replies_ = false;
    return true;
}

// A stream that is switched off may end with its flag: cleared before it is used again.
template <class Chip, class Table>
void DriveWire<Chip, Table>::halt() noexcept
{
    timer().cr1.write(0);
    stream().cr.write(stream().cr.read() & ~kStreamEnable);
    for (unsigned round = 0; round < kDisableRounds && (stream().cr.read() & kStreamEnable) != 0;
         ++round) {
    }
}

template <class Chip, class Table>
void DriveWire<Chip, Table>::on_interrupt() noexcept
{
    const std::uint32_t raised = stream_flags(Chip::dma2(), kStream).read() & kStreamAllFlags
                                                                                  << kPlace;
    stream_flag_clear(Chip::dma2(), kStream).write(raised);
    const Phase phase = phase_.load(std::memory_order_relaxed);
    constexpr std::uint32_t kEnds = (kStreamComplete | kStreamTransferError) << kPlace;
    if ((raised & kEnds) == 0 || phase == Phase::kRest) {
        return;
    }
    timer().cr1.write(0);
    if (phase == Phase::kSending && replies_) {
        set_pin(port(), pin_.number, PinMode::kInput, Pull::kUp);
        phase_.store(Phase::kListening, std::memory_order_relaxed);
        run(kListen, Chip::bus_address(&port().idr), heard_.data(), kHeard, sample_counts_);
        return;
    }
    set_pin(port(), pin_.number, PinMode::kOutput);
    phase_.store(Phase::kRest, std::memory_order_release);
}

// Each byte's start is found anew: its bits are read in their middles, up to 10 bits later.
template <class Chip, class Table>
std::size_t DriveWire<Chip, Table>::take(Span<std::uint8_t> answer) const noexcept
{
    std::size_t size = 0;
    unsigned sample = 0;
    while (replies_ && size < answer.size()) {
        while (sample < kHeard && heard(sample)) {
            ++sample;
        }
        const unsigned middle = sample + kSamples / 2;
        if (middle + (kBitsOfByte - 1) * kSamples >= kHeard) {
            break;
        }
        unsigned bits = 0;
        for (unsigned i = 0; i < kBitsOfByte; ++i) {
            bits |= (heard(middle + i * kSamples) ? 1U : 0U) << i;
        }
        // A wrong stop or start bit is a wrong byte, which the checksum finds.
        answer[size] = static_cast<std::uint8_t>(bits >> 1U);
        ++size;
        sample = middle + (kBitsOfByte - 1) * kSamples;
    }
    return size;
}

}  // namespace cusp::hal::stm32f4
