// EdgePlayer: plays pulse frames edge by edge from an interrupt, for QEMU, which models no DMA.
//
// Each interrupt writes one edge to the port's set/reset register, as the DMA of the real board
// would, and records its tick and the levels of the six lines in the trace. Two paces:
//   stretched  each interrupt requests the next one: run time is not real time, ticks are in the
//              trace; the player waits for a missing frame
//   real       timer 2 makes each edge due at its tick; a missing frame is an underrun
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "hal/contract/board.hpp"
#include "hal/stm32f4/chip.hpp"
#include "hal/stm32f4/step_ports.hpp"

namespace cusp::hal::qemu {

// `Table` has kLines (hal/stm32f4/step_ports.hpp), on one port; `Trace` has note(tick, levels),
// called for each edge, in order.
template <class Chip, class Table, class Trace>
class EdgePlayer {
public:
    Trace& trace() noexcept { return trace_; }

    // `real_pace` as above. Precondition: nothing is in flight.
    void start(bool real_pace) noexcept;

    // See hal/contract/board.hpp.
    bool try_play(const PulseFrame& frame) noexcept;
    bool underrun() const noexcept { return underrun_.load(std::memory_order_relaxed); }
    void clear_underrun() noexcept { underrun_.store(false, std::memory_order_relaxed); }
    void invert(PulseLines lines) noexcept { inverted_ = lines; }

    // Nothing is in flight.
    bool silent() const noexcept
    {
        return !ready_[0].load(std::memory_order_acquire) &&
               !ready_[1].load(std::memory_order_acquire);
    }
    // Frames and silences of a frame's length that have been played at the real pace; wraps.
    std::uint32_t frames() const noexcept { return frames_played_.load(std::memory_order_relaxed); }
    bool real_pace() const noexcept { return real_pace_; }
    // True if try_play() would take a frame.
    bool has_room() const noexcept { return !ready_[filling_].load(std::memory_order_acquire); }

    // The interrupt. True where the servo tick is due.
    bool on_interrupt() noexcept;

    static void stop() noexcept { write_lines(0, kStepLines & Ports::kAllLines); }

private:
    // QEMU's timers 2 to 5 count nanoseconds.
    static constexpr std::uint32_t kNanosecondsPerTick = 1000;
    static constexpr std::uint32_t kLeastWait = 100;

    using Ports = stm32f4::StepPorts<Table>;
    static_assert(Ports::kCount == 1);
    static void write_lines(PulseLines raise, PulseLines lower) noexcept
    {
        const stm32f4::PinLevels levels = stm32f4::pin_levels(raise, lower, inverted_);
        Chip::port(Ports::kLetters[0]).bsrr.write(Ports::template word<0>(levels.up, levels.down));
    }
    void ask_again() noexcept;
    std::int32_t until_due() const noexcept;  // ns
    bool finish_frame() noexcept;
    std::uint32_t next_tick() const noexcept;

    Trace trace_;
    std::array<PulseFrame, 2> frames_{};
    std::array<std::atomic<bool>, 2> ready_{};
    unsigned filling_{0};
    unsigned playing_{0};
    std::uint32_t next_edge_{0};
    std::uint64_t frame_start_{0};  // ticks since the first frame
    PulseLines levels_{0};
    std::atomic<bool> underrun_{false};
    static inline PulseLines inverted_{0};
    std::atomic<std::uint32_t> frames_played_{0};
    bool real_pace_{false};
    bool active_{false};            // a frame plays
    std::uint32_t frame_clock_{0};  // timer 5 at the start of the frame that plays
};

template <class Chip, class Table, class Trace>
void EdgePlayer<Chip, Table, Trace>::start(bool real_pace) noexcept
{
    constexpr std::uint32_t kUpdateInterrupt = 1U << 0U;
    constexpr std::uint32_t kEnable = 1U << 0U;
    real_pace_ = real_pace;
    stm32f4::enable_interrupt<Chip>(stm32f4::kTimer2Interrupt, stm32f4::kPlayerPriority);
    if (real_pace) {
        // QEMU 7.2: the period is right only where DIER and CR1 come first, ARR last, and PSC, CNT
        // and EGR are never written.
        Chip::timer5().cr1.write(kEnable);
        Chip::timer2().dier.write(kUpdateInterrupt);
        Chip::timer2().cr1.write(kEnable);
        frame_clock_ = Chip::timer5().cnt.read();
        ask_again();
    }
}

template <class Chip, class Table, class Trace>
bool EdgePlayer<Chip, Table, Trace>::try_play(const PulseFrame& frame) noexcept
{
    if (!has_room()) {
        return false;
    }
    if (underrun()) {
        return true;
    }
    // Only the edges that are there: a frame's room is 4000 bytes.
    auto& mine = frames_[filling_].edges;
    mine.clear();
    for (const PulseEdge& edge : frame.edges) {
        static_cast<void>(mine.try_push_back(edge));
    }
    ready_[filling_].store(true, std::memory_order_release);
    filling_ = 1U - filling_;
    if (!real_pace_) {
        ask_again();
    }
    return true;
}

template <class Chip, class Table, class Trace>
std::uint32_t EdgePlayer<Chip, Table, Trace>::next_tick() const noexcept
{
    const auto& edges = frames_[playing_].edges;
    return active_ && next_edge_ < edges.size() ? edges[next_edge_].tick : kPulseTicksPerFrame;
}

template <class Chip, class Table, class Trace>
void EdgePlayer<Chip, Table, Trace>::ask_again() noexcept
{
    if (!real_pace_) {
        constexpr unsigned kNumber = stm32f4::kTimer2Interrupt;
        Chip::interrupts().ispr[kNumber / 32].write(1U << kNumber % 32);
        return;
    }
    const std::int32_t wait = until_due();
    const bool late = wait < static_cast<std::int32_t>(kLeastWait);
    Chip::timer2().arr.write(late ? kLeastWait : static_cast<std::uint32_t>(wait));
}

template <class Chip, class Table, class Trace>
std::int32_t EdgePlayer<Chip, Table, Trace>::until_due() const noexcept
{
    const std::uint32_t due = frame_clock_ + next_tick() * kNanosecondsPerTick;
    return static_cast<std::int32_t>(due - Chip::timer5().cnt.read());
}

template <class Chip, class Table, class Trace>
bool EdgePlayer<Chip, Table, Trace>::on_interrupt() noexcept
{
    Chip::timer2().sr.write(0);
    if (!real_pace_) {
        active_ = ready_[playing_].load(std::memory_order_acquire);
    } else if (until_due() > static_cast<std::int32_t>(kLeastWait)) {
        // The short period that an edge just passed had asked for ended once more before the next
        // was set: nothing is due.
        ask_again();
        return false;
    }
    const auto& edges = frames_[playing_].edges;
    bool tick_due = false;
    if (active_ && next_edge_ < edges.size()) {
        const PulseEdge edge = edges[next_edge_];
        ++next_edge_;
        write_lines(edge.raise, edge.lower);
        levels_ = static_cast<PulseLines>((levels_ | edge.raise) & ~edge.lower);
        trace_.note(frame_start_ + edge.tick, levels_);
    } else {
        tick_due = finish_frame();
    }
    if (real_pace_ || ready_[playing_].load(std::memory_order_acquire)) {
        ask_again();
    }
    return tick_due;
}

template <class Chip, class Table, class Trace>
bool EdgePlayer<Chip, Table, Trace>::finish_frame() noexcept
{
    const bool played = active_;
    const bool was_moving = played && !frames_[playing_].edges.empty();
    if (played) {
        ready_[playing_].store(false, std::memory_order_release);
        playing_ = 1U - playing_;
        next_edge_ = 0;
        frame_start_ += kPulseTicksPerFrame;
    }
    if (!real_pace_) {
        return played;
    }
    frame_clock_ += kPulseTicksPerFrame * kNanosecondsPerTick;
    frames_played_.store(frames() + 1, std::memory_order_relaxed);
    active_ = ready_[playing_].load(std::memory_order_acquire);
    if (was_moving && !active_) {
        stop();
        underrun_.store(true, std::memory_order_relaxed);
    }
    return true;
}

}  // namespace cusp::hal::qemu
