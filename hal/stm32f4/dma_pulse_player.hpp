// DmaPulsePlayer: plays pulse frames by DMA, so that no interrupt makes a step.
//
// A timer requests one word a port from DMA2 each microsecond; a stream takes it from a ring of two
// halves, a frame each, and writes it to the port's set/reset register: bits 0 to 15 raise pins, bits
// 16 to 31 lower them, 0 changes nothing. While one half plays, the servo tick fills the other. The
// lines may lie on up to three ports: one ring and one stream each, all requested by one event of the
// timer. Their words of a microsecond follow each other within some 20 bus cycles.
//
// At each change of half the interrupt clears the half that has just played, so no word is played
// twice: where a frame is late, no steps are played. If the next frame is missing during motion, the
// stream is stopped with the steps low: an underrun.
//
// Timer 2 gates the requests: a single pulse that the interrupt restarts. If the interrupt does not
// come (the core is halted, locked up or handles faults) the stream ends kGateMargin after the half
// that plays, before a word of the next is played twice.
//
// Never tried on silicon. tests/unit/hal_stm32f4 runs it against a model of timer, stream and port.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "firmware/base/pulse_frame.hpp"
#include "hal/contract/board.hpp"
#include "hal/stm32f4/dma_streams.hpp"
#include "hal/stm32f4/pace.hpp"
#include "hal/stm32f4/pins.hpp"
#include "hal/stm32f4/registers.hpp"
#include "hal/stm32f4/step_ports.hpp"

namespace cusp::hal::stm32f4 {

// `Chip` as in hal/stm32f4/chip.hpp; `Table` has kLines (hal/stm32f4/step_ports.hpp); `Pace` as in
// hal/stm32f4/pace.hpp.
template <class Chip, class Table, class Pace>
class DmaPulsePlayer {
public:
    // Makes the lines outputs, sets timers and streams up and starts them on silence.
    // Precondition: the clocks of DMA2 and both timers are on. `timer_hz` and `gate_hz` are what the
    // pace's timer and timer 2 count. `moved`: the last run ended amid motion, which counts as an
    // underrun.
    void start(std::uint32_t timer_hz, std::uint32_t gate_hz, bool moved = false) noexcept;

    // Drives the lines low, as `inverted` says, before start(). Uses no statics.
    static void rest(PulseLines inverted) noexcept;

    // See hal/contract/board.hpp; takes the frame and drops it after an underrun. Also false, and
    // nothing written, where less than kFillTime is left of the half that plays. A frame that is
    // still being written when its half begins is an underrun, even from rest: its first edges may
    // have played.
    bool try_play(const PulseFrame& frame) noexcept;
    bool underrun() const noexcept { return underrun_.load(std::memory_order_relaxed); }
    void clear_underrun() noexcept;
    void invert(PulseLines lines) noexcept
    {
        wanted_inversion_.store(lines, std::memory_order_relaxed);
    }
    // True if a frame with edges may be on its way to the pins.
    bool moving() const noexcept { return has_edges_[0] || has_edges_[1]; }

    // The interrupt of the first port's stream. True where the servo tick is due. Context: the most
    // urgent interrupt; integers only.
    bool on_interrupt() noexcept;

    // Stops the streams at once with the steps low. Context: any; used by the fault handler.
    static void stop() noexcept;

private:
    using Ports = StepPorts<Table>;
    static constexpr unsigned kPorts = Ports::kCount;
    static_assert(kPorts <= Pace::kRequests.size(), "the lines lie on more than three ports");
    using EachPort = std::make_index_sequence<kPorts>;
    using Half = std::array<std::uint32_t, kPulseTicksPerFrame>;
    using Ring = std::array<Half, 2>;
    static constexpr std::uint32_t kWords = 2 * kPulseTicksPerFrame;
    // Longest time from the first word of a frame to the last, in words: 1000 edges at some ten
    // instructions a port, and the interrupts of the serial port in between.
    static constexpr std::uint32_t kFillTime = 80 + 70 * kPorts;
    // The stream fetches a word ahead of its turn.
    static constexpr std::uint32_t kFetchedAhead = 4;

    // The first port's stream calls; the others go with it (RM0090 sections 10.5.1 to 10.5.5).
    static constexpr unsigned kFlagPlace = stream_flag_place(Pace::kRequests[0].stream);
    static constexpr std::uint32_t kHalfTransfer = kStreamHalf << kFlagPlace;
    static constexpr std::uint32_t kTransferComplete = kStreamComplete << kFlagPlace;
    static constexpr std::uint32_t kErrors = (kStreamDirectModeError | kStreamTransferError)
                                             << kFlagPlace;
    static constexpr std::uint32_t kAllFlags = kStreamAllFlags << kFlagPlace;
    static constexpr std::uint32_t kInterrupts = 1U << 4U | 1U << 3U | 1U << 2U | 1U << 1U;
    static constexpr std::uint32_t kStreamSettings = 3U << 16U    // most urgent stream
                                                     | 2U << 13U  // words from memory
                                                     | 2U << 11U  // words to the port
                                                     | 1U << 10U  // memory address increments
                                                     | 1U << 8U   // circular
                                                     | 1U << 6U;  // memory to peripheral
    static constexpr std::uint32_t kTimerEnable = 1U << 0U;
    static constexpr std::uint32_t kOnePulse = 1U << 3U;
    static constexpr std::uint32_t kEnableIsOutput = 1U << 4U;      // of the gate, to ITR1
    static constexpr std::uint32_t kGatedByTimer2 = 1U << 4U | 5U;  // ITR1 is timer 2
    // The latest that the interrupt may come in motion, us after the change of half.
    static constexpr std::uint32_t kGateMargin = 20;
    // The half that plays is unknown: both flags were set.
    static constexpr unsigned kUnknown = 2;
    static constexpr std::uint32_t kAllRequestsAtUpdate = 1U << 3U;  // CCDS
    // A stream that is switched off finishes its word first: some 20 bus cycles.
    static constexpr unsigned kDisableRounds = 1000;

    static auto& gpio(unsigned port) noexcept { return Chip::port(Ports::kLetters[port]); }
    static auto& stream(unsigned port = 0) noexcept
    {
        return Chip::dma2().stream[Pace::kRequests[port].stream];
    }
    static constexpr std::uint32_t settings(unsigned port) noexcept
    {
        return kStreamSettings | Pace::kRequests[port].channel << 25U |
               (port == 0 ? kInterrupts : 0U);
    }
    static auto& flags() noexcept { return stream_flags(Chip::dma2(), Pace::kRequests[0].stream); }
    static auto& flag_clear() noexcept
    {
        return stream_flag_clear(Chip::dma2(), Pace::kRequests[0].stream);
    }
    template <std::size_t... kPort>
    static void set_lines(PinLevels levels, std::index_sequence<kPort...> /*each*/) noexcept
    {
        (gpio(kPort).bsrr.write(Ports::template word<kPort>(levels.up, levels.down)), ...);
    }
    template <std::size_t... kPort>
    static PulseLines high_lines(std::index_sequence<kPort...> /*each*/) noexcept
    {
        return static_cast<PulseLines>(
            (Ports::template lines<kPort>(gpio(kPort).odr.read()) | ...));
    }
    template <std::size_t... kPort>
    void fill(unsigned half,
              const PulseFrame& frame,
              PulseLines inverted,
              std::index_sequence<kPort...> /*each*/) noexcept
    {
        for (const PulseEdge& edge : frame.edges) {
            const PinLevels levels = pin_levels(edge.raise, edge.lower, inverted);
            ((rings_[kPort][half][edge.tick] = Ports::template word<kPort>(levels.up, levels.down)),
             ...);
        }
    }
    void start_stream() noexcept;
    // In two thirds of the time that fill() takes.
    void silence(unsigned half) noexcept
    {
        for (Ring& ring : rings_) {
            __builtin_memset(ring[half].data(), 0, sizeof ring[half]);
        }
    }
    static bool in_step() noexcept;
    // Words left of the half that plays; 0 at its end.
    static std::uint32_t words_left(unsigned playing) noexcept;
    static void begin_gate() noexcept;
    static bool gate_ended() noexcept { return (Chip::timer2().cr1.read() & kTimerEnable) == 0; }
    void apply_inversion() noexcept;
    void finish_half(unsigned playing) noexcept;
    void lose_place() noexcept;
    void fail() noexcept;

    std::array<Ring, kPorts> rings_{};
    // Written by the servo tick, taken by the interrupt.
    std::array<std::atomic<bool>, 2> ready_{};
    // True if the frame in this half has an edge.
    std::array<bool, 2> has_edges_{};
    std::atomic<bool> underrun_{false};
    std::atomic<unsigned> playing_{0};  // as the stream's flags say
    std::atomic<PulseLines> wanted_inversion_{0};
    // Lines whose pin is low where the line is high; what stop() needs in any context.
    static inline PulseLines inverted_{0};
};

template <class Chip, class Table, class Pace>
void DmaPulsePlayer<Chip, Table, Pace>::start(std::uint32_t timer_hz,
                                              std::uint32_t gate_hz,
                                              bool moved) noexcept
{
    constexpr std::uint32_t kMicrosecondsPerSecond = 1000000;
    auto& gate = Chip::timer2();
    gate.cr1.write(kOnePulse);
    gate.cr2.write(kEnableIsOutput);
    gate.arr.write(gate_hz / kMicrosecondsPerSecond * (kPulseTicksPerFrame + kGateMargin) - 1);
    // A debugger that holds the core holds the stream and its gate.
    set_bits(Chip::debug().apb1_freeze, 1U);
    set_bits(Chip::debug().apb2_freeze, 1U << Pace::kFreezeBit);
    auto& timer = Pace::timer();
    timer.cr1.write(0);
    timer.psc.write(0);
    timer.arr.write(timer_hz / (kPulseTicksPerFrame * kServoTicksPerSecond) - 1);
    timer.smcr.write(kGatedByTimer2);
    timer.cr2.write(kAllRequestsAtUpdate);
    std::uint32_t requests = 0;
    for (unsigned port = 0; port < kPorts; ++port) {
        requests |= Pace::kRequests[port].enable;
    }
    timer.dier.write(requests);
    inverted_ = wanted_inversion_.load(std::memory_order_relaxed);
    rest(inverted_);
    underrun_.store(moved, std::memory_order_relaxed);
    start_stream();
}

template <class Chip, class Table, class Pace>
void DmaPulsePlayer<Chip, Table, Pace>::rest(PulseLines inverted) noexcept
{
    set_lines(pin_levels(0, Ports::kAllLines, inverted), EachPort{});
    for (const Pin pin : Table::kLines) {
        if (is_there(pin)) {
            set_pin(Chip::port(pin.port), pin.number, PinMode::kOutput);
        }
    }
}

// The lines keep their logical levels; only the pins change.
template <class Chip, class Table, class Pace>
void DmaPulsePlayer<Chip, Table, Pace>::apply_inversion() noexcept
{
    const auto levels =
        static_cast<PulseLines>((high_lines(EachPort{}) ^ inverted_) & Ports::kAllLines);
    inverted_ = wanted_inversion_.load(std::memory_order_relaxed);
    const auto low = static_cast<PulseLines>(~unsigned{levels} & Ports::kAllLines);
    set_lines(pin_levels(levels, low, inverted_), EachPort{});
}

template <class Chip, class Table, class Pace>
void DmaPulsePlayer<Chip, Table, Pace>::begin_gate() noexcept
{
    auto& gate = Chip::timer2();
    gate.cnt.write(0);
    gate.cr1.write(kOnePulse | kTimerEnable);
}

template <class Chip, class Table, class Pace>
void DmaPulsePlayer<Chip, Table, Pace>::start_stream() noexcept
{
    stop();
    for (unsigned half = 0; half < 2; ++half) {
        silence(half);
        ready_[half].store(false, std::memory_order_relaxed);
        has_edges_[half] = false;
    }
    playing_.store(0, std::memory_order_relaxed);
    // The silence is in memory before a stream reads it.
    std::atomic_thread_fence(std::memory_order_release);
    for (unsigned port = 0; port < kPorts; ++port) {
        const unsigned number = Pace::kRequests[port].stream;
        stream_flag_clear(Chip::dma2(), number).write(kStreamAllFlags << stream_flag_place(number));
        auto& dma = stream(port);
        dma.par.write(Chip::bus_address(&gpio(port).bsrr));
        dma.m0ar.write(Chip::bus_address(rings_[port].data()));
        dma.ndtr.write(kWords);
        dma.fcr.write(0);
        dma.cr.write(settings(port));
        dma.cr.write(settings(port) | kStreamEnable);
    }
    begin_gate();
    Pace::timer().cr1.write(kTimerEnable);
}

template <class Chip, class Table, class Pace>
void DmaPulsePlayer<Chip, Table, Pace>::stop() noexcept
{
    Pace::timer().cr1.write(0);
    for (unsigned port = 0; port < kPorts; ++port) {
        auto& dma = stream(port);
        dma.cr.write(settings(port));
        for (unsigned round = 0; round < kDisableRounds && (dma.cr.read() & kStreamEnable) != 0;
             ++round) {
        }
    }
    set_lines(pin_levels(0, kStepLines & Ports::kAllLines, inverted_), EachPort{});
}

// True if the streams of further ports are at the same word as the first one. After a bus error a
// stream stops; after a missed request it is late.
template <class Chip, class Table, class Pace>
bool DmaPulsePlayer<Chip, Table, Pace>::in_step() noexcept
{
    // A word may be played between two readings; at its end a counter may be 0 or that of the start.
    constexpr std::uint32_t kAllowed = 2;
    if constexpr (kPorts == 1) {
        return true;
    }
    const std::uint32_t left = stream().ndtr.read();
    for (unsigned port = 1; port < kPorts; ++port) {
        const std::uint32_t ahead = left + kWords - stream(port).ndtr.read() + kAllowed;
        if (ahead % kWords > 2 * kAllowed) {
            return false;
        }
    }
    return true;
}

// The counter is that of both halves, and which of them plays is the flags' to say: at the end of
// the ring it may still stand at 0 when the first half plays.
template <class Chip, class Table, class Pace>
std::uint32_t DmaPulsePlayer<Chip, Table, Pace>::words_left(unsigned playing) noexcept
{
    const std::uint32_t left = stream().ndtr.read();
    if (left == 0) {
        return playing == 0 ? kPulseTicksPerFrame : 0;
    }
    const bool in_first = left > kPulseTicksPerFrame;
    if (in_first != (playing == 0)) {
        return 0;
    }
    return in_first ? left - kPulseTicksPerFrame : left;
}

template <class Chip, class Table, class Pace>
bool DmaPulsePlayer<Chip, Table, Pace>::try_play(const PulseFrame& frame) noexcept
{
    if (underrun()) {
        return true;
    }
    const unsigned playing = playing_.load(std::memory_order_relaxed);
    if (playing == kUnknown) {
        return false;
    }
    const unsigned half = 1U - playing;
    if (ready_[half].load(std::memory_order_relaxed) || words_left(playing) < kFillTime) {
        return false;
    }
    const PulseLines wanted = wanted_inversion_.load(std::memory_order_relaxed);
    if (wanted != inverted_ && frame.edges.empty() && !moving()) {
        apply_inversion();
    }
    const PulseLines inverted = inverted_;
    if (inverted == 0) {
        fill(half, frame, 0, EachPort{});
    } else {
        fill(half, frame, inverted, EachPort{});
    }
    has_edges_[half] = !frame.edges.empty();
    ready_[half].store(true, std::memory_order_release);
    if (playing_.load(std::memory_order_relaxed) == playing &&
        words_left(playing) >= kFetchedAhead && !underrun()) {
        return true;
    }
    fail();
    return false;
}

template <class Chip, class Table, class Pace>
bool DmaPulsePlayer<Chip, Table, Pace>::on_interrupt() noexcept
{
    // A frame that the gate has ended is not played on: the next word may be of a frame that is over.
    const bool late = gate_ended() && moving();
    if (!late) {
        begin_gate();
    }
    const std::uint32_t raised = flags().read();
    flag_clear().write(raised & kAllFlags);
    if ((raised & kErrors) != 0 || !in_step() || late) {
        fail();
        return true;
    }
    const bool first_over = (raised & kHalfTransfer) != 0;
    const bool second_over = (raised & kTransferComplete) != 0;
    if (underrun() || (!first_over && !second_over)) {
        return false;
    }
    if (first_over && second_over) {
        lose_place();
    } else {
        finish_half(first_over ? 1 : 0);
    }
    return true;
}

template <class Chip, class Table, class Pace>
void DmaPulsePlayer<Chip, Table, Pace>::finish_half(unsigned playing) noexcept
{
    const unsigned played = 1U - playing;
    const bool was_moving = has_edges_[played];
    playing_.store(playing, std::memory_order_relaxed);
    if (was_moving) {
        silence(played);
        has_edges_[played] = false;
    }
    ready_[played].store(false, std::memory_order_relaxed);
    if (was_moving && !ready_[playing].load(std::memory_order_acquire)) {
        fail();
    }
}

// Both flags: a whole half went by unserved, and the one that plays may be playing again.
template <class Chip, class Table, class Pace>
void DmaPulsePlayer<Chip, Table, Pace>::lose_place() noexcept
{
    if (moving()) {
        fail();
        return;
    }
    playing_.store(kUnknown, std::memory_order_relaxed);
    ready_[0].store(false, std::memory_order_relaxed);
    ready_[1].store(false, std::memory_order_relaxed);
}

template <class Chip, class Table, class Pace>
void DmaPulsePlayer<Chip, Table, Pace>::fail() noexcept
{
    stop();
    underrun_.store(true, std::memory_order_relaxed);
}

template <class Chip, class Table, class Pace>
void DmaPulsePlayer<Chip, Table, Pace>::clear_underrun() noexcept
{
    if (underrun()) {
        start_stream();
        underrun_.store(false, std::memory_order_relaxed);
    }
}

}  // namespace cusp::hal::stm32f4
