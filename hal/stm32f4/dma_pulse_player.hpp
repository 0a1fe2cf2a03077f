// DmaPulsePlayer: plays pulse frames by DMA, so that no interrupt makes a step.
//
// A timer asks DMA2 for one word each microsecond; the stream takes it from a ring of two halves, a
// frame each, and writes it to the port's set/reset register: bits 0 to 15 raise pins, bits 16 to
// 31 lower them, 0 changes nothing. While one half plays, the servo tick fills the other.
//
// At each change of half the interrupt erases the half that has just played, so that no word is
// ever played twice: a frame that comes late finds silence, never yesterday's steps. If motion went
// on and the next frame is not there, the stream is stopped with the steps low: an underrun.
//
// The pace needs the core: timer 2, a single pulse that the interrupt begins anew, gates it. Where
// the interrupt stays away (a core that is held, locked up or busy with faults) the stream ends
// kGateMargin after the half that plays, before a word of the next is played twice.
//
// Never tried on silicon. tests/unit/hal_stm32f4 runs it against a model of timer, stream and port.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "firmware/base/pulse_frame.hpp"
#include "hal/contract/board.hpp"
#include "hal/stm32f4/pins.hpp"
#include "hal/stm32f4/registers.hpp"

namespace cusp::hal::stm32f4 {

// Lines X Y Z step on pins 0 to 2 of the port and X Y Z direction on pins 3 to 5; `inverted` has a
// 1 for each line whose pin is low where the line is high.
constexpr std::uint32_t port_word(PulseLines raise, PulseLines lower, PulseLines inverted) noexcept
{
    const auto pins_up = static_cast<std::uint32_t>((raise & ~inverted) | (lower & inverted));
    const auto pins_down = static_cast<std::uint32_t>((lower & ~inverted) | (raise & inverted));
    return pins_up | pins_down << 16U;
}

inline constexpr PulseLines kStepLines = 0x07;

// Which timer asks which stream (RM0090 table 43): timer 8's update asks stream 1 by channel 7,
// timer 1's asks stream 5 by channel 6.
template <class Chip>
struct Timer8Pace {
    static constexpr unsigned kStream = 1;
    static constexpr std::uint32_t kChannel = 7;
    static constexpr unsigned kInterrupt = 57;
    static constexpr unsigned kClockBit = 1;   // of RCC_APB2ENR
    static constexpr unsigned kFreezeBit = 1;  // of DBGMCU_APB2_FZ
    static auto& timer() noexcept { return Chip::timer8(); }
};
template <class Chip>
struct Timer1Pace {
    static constexpr unsigned kStream = 5;
    static constexpr std::uint32_t kChannel = 6;
    static constexpr unsigned kInterrupt = 68;
    static constexpr unsigned kClockBit = 0;
    static constexpr unsigned kFreezeBit = 0;
    static auto& timer() noexcept { return Chip::timer1(); }
};

// `Chip` as in hal/stm32f4/chip.hpp; `Port` has a static function gpio() that yields the port of
// the six lines.
template <class Chip, class Port, class Pace = Timer8Pace<Chip>>
class DmaPulsePlayer {
public:
    // Gives the lines to the port, sets timers and stream up and starts them on silence.
    // Precondition: the clocks of DMA2 and both timers are on. `timer_hz` and `gate_hz` are what the
    // pace's timer and timer 2 count. `moved`: the last run ended amid motion, which counts as an
    // underrun.
    void start(std::uint32_t timer_hz, std::uint32_t gate_hz, bool moved = false) noexcept;

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
    // Whether a frame with edges may be on its way to the pins.
    bool moving() const noexcept { return has_edges_[0] || has_edges_[1]; }

    // The stream's interrupt. True where the servo tick is due. Context: the most urgent interrupt;
    // integers only.
    bool on_interrupt() noexcept;

    // Stops the stream at once with the steps low. Context: any; used by the fault handler.
    static void stop() noexcept;

private:
    using Half = std::array<std::uint32_t, kPulseTicksPerFrame>;
    static constexpr std::uint32_t kWords = 2 * kPulseTicksPerFrame;
    // Longest time from the first word of a frame to the last, in words: 1000 edges at some ten
    // instructions, and the interrupts of the serial port in between.
    static constexpr std::uint32_t kFillTime = 150;
    // The stream fetches a word ahead of its turn.
    static constexpr std::uint32_t kFetchedAhead = 4;

    // The stream in the flags registers, and its settings (RM0090 sections 10.5.1 to 10.5.5).
    // Streams 0 to 3 have the low registers, 4 to 7 the high ones.
    static constexpr std::array<unsigned, 4> kFlagPlaces{0, 6, 16, 22};
    static constexpr unsigned kFlagPlace = kFlagPlaces[Pace::kStream % 4];
    static constexpr std::uint32_t kFifoError = 1U << kFlagPlace;
    static constexpr std::uint32_t kDirectModeError = 4U << kFlagPlace;
    static constexpr std::uint32_t kTransferError = 8U << kFlagPlace;
    static constexpr std::uint32_t kHalfTransfer = 16U << kFlagPlace;
    static constexpr std::uint32_t kTransferComplete = 32U << kFlagPlace;
    static constexpr std::uint32_t kErrors = kDirectModeError | kTransferError;
    static constexpr std::uint32_t kAllFlags =
        kErrors | kFifoError | kHalfTransfer | kTransferComplete;
    static constexpr std::uint32_t kStreamEnable = 1U << 0U;
    static constexpr std::uint32_t kStreamSettings = Pace::kChannel << 25U |
                                                     3U << 16U    // most urgent stream
                                                     | 2U << 13U  // words from memory
                                                     | 2U << 11U  // words to the port
                                                     | 1U << 10U  // memory address goes on
                                                     | 1U << 8U   // round and round
                                                     | 1U << 6U   // memory to peripheral
                                                     | 1U << 4U | 1U << 3U | 1U << 2U | 1U << 1U;
    static constexpr std::uint32_t kTimerEnable = 1U << 0U;
    static constexpr std::uint32_t kOnePulse = 1U << 3U;
    static constexpr std::uint32_t kEnableIsOutput = 1U << 4U;      // of the gate, to ITR1
    static constexpr std::uint32_t kGatedByTimer2 = 1U << 4U | 5U;  // ITR1 is timer 2
    // The latest that the interrupt may come in motion, us after the change of half.
    static constexpr std::uint32_t kGateMargin = 20;
    // Which half plays is not known: both flags were up.
    static constexpr unsigned kUnknown = 2;
    static constexpr PulseLines kLines = 0x3F;
    static constexpr std::uint32_t kUpdateRequest = 1U << 8U;
    // A stream that is switched off finishes its word first: some 20 bus cycles.
    static constexpr unsigned kDisableRounds = 1000;

    static auto& stream() noexcept { return Chip::dma2().stream[Pace::kStream]; }
    static auto& flags() noexcept
    {
        return Pace::kStream < 4 ? Chip::dma2().lisr : Chip::dma2().hisr;
    }
    static auto& flag_clear() noexcept
    {
        return Pace::kStream < 4 ? Chip::dma2().lifcr : Chip::dma2().hifcr;
    }
    void start_stream() noexcept;
    // In two thirds of the time that fill() takes.
    static void silence(Half& half) noexcept { __builtin_memset(half.data(), 0, sizeof half); }
    // Words that are left of the half that plays; 0 where its end has come.
    static std::uint32_t words_left(unsigned playing) noexcept;
    static void begin_gate() noexcept;
    static bool gate_ended() noexcept { return (Chip::timer2().cr1.read() & kTimerEnable) == 0; }
    void apply_inversion() noexcept;
    void finish_half(unsigned playing) noexcept;
    void lose_place() noexcept;
    void fail() noexcept;

    std::array<Half, 2> halves_{};
    // Written by the servo tick, taken by the interrupt.
    std::array<std::atomic<bool>, 2> ready_{};
    // Whether the frame in this half has an edge.
    std::array<bool, 2> has_edges_{};
    std::atomic<bool> underrun_{false};
    std::atomic<unsigned> playing_{0};  // as the stream's flags say
    std::atomic<PulseLines> wanted_inversion_{0};
    // Lines whose pin is low where the line is high; what stop() needs in any context.
    static inline PulseLines inverted_{0};
};

template <class Chip, class Port, class Pace>
void DmaPulsePlayer<Chip, Port, Pace>::start(std::uint32_t timer_hz,
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
    timer.dier.write(kUpdateRequest);
    apply_inversion();
    for (unsigned pin = 0; pin < 6; ++pin) {
        set_pin(Port::gpio(), pin, PinMode::kOutput);
    }
    underrun_.store(moved, std::memory_order_relaxed);
    start_stream();
}

// The port keeps the logical levels; only the pins change.
template <class Chip, class Port, class Pace>
void DmaPulsePlayer<Chip, Port, Pace>::apply_inversion() noexcept
{
    const auto levels = static_cast<PulseLines>((Port::gpio().odr.read() ^ inverted_) & kLines);
    inverted_ = wanted_inversion_.load(std::memory_order_relaxed);
    const auto low = static_cast<PulseLines>(~unsigned{levels} & kLines);
    Port::gpio().bsrr.write(port_word(levels, low, inverted_));
}

template <class Chip, class Port, class Pace>
void DmaPulsePlayer<Chip, Port, Pace>::begin_gate() noexcept
{
    auto& gate = Chip::timer2();
    gate.cnt.write(0);
    gate.cr1.write(kOnePulse | kTimerEnable);
}

template <class Chip, class Port, class Pace>
void DmaPulsePlayer<Chip, Port, Pace>::start_stream() noexcept
{
    stop();
    for (unsigned half = 0; half < 2; ++half) {
        silence(halves_[half]);
        ready_[half].store(false, std::memory_order_relaxed);
        has_edges_[half] = false;
    }
    playing_.store(0, std::memory_order_relaxed);
    auto& dma = stream();
    flag_clear().write(kAllFlags);
    dma.par.write(Chip::bus_address(&Port::gpio().bsrr));
    dma.m0ar.write(Chip::bus_address(halves_.data()));
    dma.ndtr.write(kWords);
    dma.fcr.write(0);
    // The silence is in memory before the stream reads it.
    std::atomic_thread_fence(std::memory_order_release);
    dma.cr.write(kStreamSettings);
    dma.cr.write(kStreamSettings | kStreamEnable);
    begin_gate();
    Pace::timer().cr1.write(kTimerEnable);
}

template <class Chip, class Port, class Pace>
void DmaPulsePlayer<Chip, Port, Pace>::stop() noexcept
{
    Pace::timer().cr1.write(0);
    auto& dma = stream();
    dma.cr.write(kStreamSettings);
    for (unsigned round = 0; round < kDisableRounds && (dma.cr.read() & kStreamEnable) != 0;
         ++round) {
    }
    Port::gpio().bsrr.write(port_word(0, kStepLines, inverted_));
}

// The counter is that of both halves, and which of them plays is the flags' to say: at the end of
// the ring it may still stand at 0 when the first half plays.
template <class Chip, class Port, class Pace>
std::uint32_t DmaPulsePlayer<Chip, Port, Pace>::words_left(unsigned playing) noexcept
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

template <class Chip, class Port, class Pace>
bool DmaPulsePlayer<Chip, Port, Pace>::try_play(const PulseFrame& frame) noexcept
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
    Half& words = halves_[half];
    const PulseLines inverted = inverted_;
    if (inverted == 0) {
        for (const PulseEdge& edge : frame.edges) {
            words[edge.tick] = port_word(edge.raise, edge.lower, 0);
        }
    } else {
        for (const PulseEdge& edge : frame.edges) {
            words[edge.tick] = port_word(edge.raise, edge.lower, inverted);
        }
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

template <class Chip, class Port, class Pace>
bool DmaPulsePlayer<Chip, Port, Pace>::on_interrupt() noexcept
{
    const bool paused = gate_ended();
    begin_gate();
    const std::uint32_t raised = flags().read();
    flag_clear().write(raised & kAllFlags);
    if ((raised & kErrors) != 0 || (paused && moving())) {
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

template <class Chip, class Port, class Pace>
void DmaPulsePlayer<Chip, Port, Pace>::finish_half(unsigned playing) noexcept
{
    const unsigned played = 1U - playing;
    const bool was_moving = has_edges_[played];
    playing_.store(playing, std::memory_order_relaxed);
    if (was_moving) {
        silence(halves_[played]);
        has_edges_[played] = false;
    }
    ready_[played].store(false, std::memory_order_relaxed);
    if (was_moving && !ready_[playing].load(std::memory_order_acquire)) {
        fail();
    }
}

// Both flags: a whole half went by unserved, and the one that plays may be playing again.
template <class Chip, class Port, class Pace>
void DmaPulsePlayer<Chip, Port, Pace>::lose_place() noexcept
{
    if (moving()) {
        fail();
        return;
    }
    playing_.store(kUnknown, std::memory_order_relaxed);
    ready_[0].store(false, std::memory_order_relaxed);
    ready_[1].store(false, std::memory_order_relaxed);
}

template <class Chip, class Port, class Pace>
void DmaPulsePlayer<Chip, Port, Pace>::fail() noexcept
{
    stop();
    underrun_.store(true, std::memory_order_relaxed);
}

template <class Chip, class Port, class Pace>
void DmaPulsePlayer<Chip, Port, Pace>::clear_underrun() noexcept
{
    if (underrun()) {
        start_stream();
        underrun_.store(false, std::memory_order_relaxed);
    }
}

}  // namespace cusp::hal::stm32f4
