// PioPulsePlayer: plays pulse frames by PIO and DMA, so that no interrupt makes a step.
//
// A state machine takes one word a microsecond (hal/rp2350/pulse_program.hpp). A channel of the DMA feeds it from one of
// two halves, a frame each; while one plays, the servo tick fills the other. Where no frame is ready, or a frame has no
// edge, the channel plays one and the same word instead.
//
// At the end of a frame the interrupt starts the channel anew, while the state machine's queue still holds the last
// eight words. If it does not come in time (the core is halted, locked up or handles faults) the state machine finds no
// word and lowers the steps by itself: no word is played twice. If the next frame is missing during motion, or the queue
// has run empty, that is an underrun: the channel is not started anew.
//
// Never tried on silicon. tests/unit/hal_rp2350 runs it against a model of the channel, the state machine and the pins.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "firmware/base/pulse_frame.hpp"
#include "hal/contract/board.hpp"
#include "hal/rp2350/chip_registers.hpp"
#include "hal/rp2350/gp_pins.hpp"
#include "hal/rp2350/pulse_program.hpp"

namespace cusp::hal::rp2350 {

// `Chip` as in hal/rp2350/rp2350.hpp; `Table` has kLines.
template <class Chip, class Table>
class PioPulsePlayer {
public:
    // Sets channel and state machine up and starts them on silence. Precondition: PIO0 and DMA are out of reset.
    // `moved`: the last run ended amid motion, which counts as an underrun.
    void start(std::uint32_t core_hz, bool moved = false) noexcept;

    // Drives the lines low, as `inverted` says, before start(). Uses no statics.
    static void rest(PulseLines inverted) noexcept;

    // See hal/contract/board.hpp; takes the frame and drops it after an underrun.
    bool try_play(const PulseFrame& frame) noexcept;
    bool underrun() const noexcept { return underrun_.load(std::memory_order_relaxed); }
    void clear_underrun() noexcept;
    void invert(PulseLines lines) noexcept
    {
        wanted_inversion_.store(lines, std::memory_order_relaxed);
    }
    // True if a frame with edges may be on its way to the pins.
    bool moving() const noexcept
    {
        return playing_edges_ || (ready_.load(std::memory_order_relaxed) && next_edges_);
    }

    // The channel's interrupt. True where the servo tick is due. Context: the most urgent interrupt; integers only.
    bool on_interrupt() noexcept;

    // Takes the pins from the state machine at once, with the steps low. Context: any; used by the fault handler.
    static void stop() noexcept;

private:
    using Words = PulseWords<Table>;
    using Half = std::array<std::uint32_t, kPulseTicksPerFrame>;

    // 12.6.10: words, by the requests of the first state machine's queue; it calls no other channel.
    static constexpr unsigned kChannel = 0;
    static constexpr std::uint32_t kChannelBit = 1U << kChannel;
    static constexpr std::uint32_t kFixedWord = 1U << 0U | 1U << 1U | 2U << 2U | kChannel << 13U;
    static constexpr std::uint32_t kWords = kFixedWord | 1U << 4U;
    static constexpr std::uint32_t kBusError = 1U << 31U;
    static constexpr std::uint32_t kErrorsSeen = 3U << 29U;  // written, they end the error
    static constexpr unsigned kAbortRounds = 1000;
    // Words that are left where the interrupt comes in time; one may be played before the channel brings the next.
    static constexpr std::uint32_t kLeastQueued = 2;
    static constexpr std::uint32_t kMachineOn = 1U << 0U;

    static auto& channel() noexcept { return Chip::dma().channel[kChannel]; }
    static auto& machine() noexcept { return Chip::pio0().machine[0]; }
    static std::uint32_t queued() noexcept { return Chip::pio0().flevel.read() & 0xFU; }

    static void give_pins_to(PinFunction function) noexcept;
    void set_machine_up() noexcept;
    void start_stream() noexcept;
    static void begin(const volatile std::uint32_t* words, std::uint32_t settings) noexcept
    {
        channel().ctrl.write(settings);
        channel().count.write(kPulseTicksPerFrame);
        channel().read_addr_start.write(Chip::bus_address(words));
    }
    void begin_silence() noexcept { begin(&silence_, kFixedWord); }
    void fill(Half& half, const PulseFrame& frame) noexcept;
    void fail() noexcept;

    std::array<Half, 2> halves_{};
    volatile std::uint32_t silence_{0};
    // Written by the servo tick, taken by the interrupt.
    std::atomic<bool> ready_{false};
    bool next_edges_{false};
    std::atomic<unsigned> playing_half_{0};
    bool playing_edges_{false};
    std::atomic<bool> underrun_{false};
    std::atomic<PulseLines> wanted_inversion_{0};
    std::uint32_t divisor_{0};
    PulseLines lines_{0};  // at the end of the last frame taken
    // Lines whose pin is low where the line is high; what stop() needs in any context.
    static inline PulseLines inverted_{0};
};

template <class Chip, class Table>
void PioPulsePlayer<Chip, Table>::start(std::uint32_t core_hz, bool moved) noexcept
{
    divisor_ = core_hz / kProgramHz;
    inverted_ = wanted_inversion_.load(std::memory_order_relaxed);
    rest(inverted_);
    Chip::dma().enabled_0.write(kChannelBit);
    underrun_.store(moved, std::memory_order_relaxed);
    start_stream();
}

template <class Chip, class Table>
void PioPulsePlayer<Chip, Table>::give_pins_to(PinFunction function) noexcept
{
    for (const Pin pin : Table::kLines) {
        if (is_there(pin)) {
            set_pin_function<Chip>(pin, function, kPadOutput | kPadInput);
        }
    }
}

template <class Chip, class Table>
void PioPulsePlayer<Chip, Table>::rest(PulseLines inverted) noexcept
{
    auto& pins = Chip::core_pins();
    constexpr std::uint32_t kAll = Words::pins(Words::kAllLines);
    const std::uint32_t high = Words::pins(static_cast<PulseLines>(inverted & Words::kAllLines));
    pins.out_clear.write(kAll & ~high);
    pins.out_set.write(high);
    pins.enable_set.write(kAll);
    give_pins_to(PinFunction::kCore);
}

// 11.5: its levels are those of silence before it has the pins.
template <class Chip, class Table>
void PioPulsePlayer<Chip, Table>::set_machine_up() noexcept
{
    constexpr std::uint32_t kRestart = 1U << 4U | 1U << 8U;
    constexpr std::uint32_t kWrap = (kPulseProgram.size() - 1) << 12U;
    constexpr std::uint32_t kOutToTheRight = 1U << 19U;
    constexpr std::uint32_t kJoinedQueues = 1U << 30U;
    auto& pio = Chip::pio0();
    for (unsigned i = 0; i < kPulseProgram.size(); ++i) {
        pio.instr_mem[i].write(kPulseProgram[i]);
    }
    machine().clkdiv.write(divisor_ << 16U);
    machine().execctrl.write(kWrap);
    // A change of this bit empties the queue.
    machine().shiftctrl.write(kOutToTheRight);
    machine().shiftctrl.write(kOutToTheRight | kJoinedQueues);
    machine().pinctrl.write(Words::kPins << 20U | Words::kFirstPin);
    pio.ctrl.write(kRestart);
    pio.txf[0].write(silence_);
    for (const std::uint32_t instruction : {kOnesInstruction, kDirectionsInstruction,
                                            kPullInstruction, kOutInstruction, kBeginInstruction}) {
        machine().instr.write(instruction);
    }
}

template <class Chip, class Table>
void PioPulsePlayer<Chip, Table>::start_stream() noexcept
{
    constexpr unsigned kFillRounds = 1000;
    stop();
    lines_ = static_cast<PulseLines>((Words::lines(Chip::core_pins().out.read()) ^ inverted_) &
                                     Words::kAllLines);
    silence_ = Words::word(lines_, inverted_);
    ready_.store(false, std::memory_order_relaxed);
    next_edges_ = false;
    playing_edges_ = false;
    set_machine_up();
    Chip::dma().raised.write(kChannelBit);
    channel().write_addr.write(Chip::bus_address(&Chip::pio0().txf[0]));
    begin_silence();
    for (unsigned round = 0; round < kFillRounds && queued() < kLeastQueued; ++round) {
    }
    Chip::pio0().ctrl.write(kMachineOn);
    give_pins_to(PinFunction::kPio0);
}

// The core's levels first: the pins are its as soon as they are taken. Erratum E5: a channel is switched off before its
// transfer is given up.
template <class Chip, class Table>
void PioPulsePlayer<Chip, Table>::stop() noexcept
{
    auto& pins = Chip::core_pins();
    constexpr std::uint32_t kAll = Words::pins(Words::kAllLines);
    constexpr std::uint32_t kSteps = Words::pins(kStepLines & Words::kAllLines);
    const std::uint32_t inverted = Words::pins(static_cast<PulseLines>(inverted_ & kStepLines));
    const std::uint32_t high = (pins.in.read() & kAll & ~kSteps) | (inverted & kSteps);
    pins.out_clear.write(kAll & ~high);
    pins.out_set.write(high);
    give_pins_to(PinFunction::kCore);
    Chip::pio0().ctrl.write(0);
    channel().ctrl.write((kFixedWord & ~1U) | kErrorsSeen);
    Chip::dma().abort.write(kChannelBit);
    for (unsigned round = 0; round < kAbortRounds && (Chip::dma().abort.read() & kChannelBit) != 0;
         ++round) {
    }
}

template <class Chip, class Table>
bool PioPulsePlayer<Chip, Table>::try_play(const PulseFrame& frame) noexcept
{
    if (underrun()) {
        return true;
    }
    if (ready_.load(std::memory_order_relaxed)) {
        return false;
    }
    if (frame.edges.empty()) {
        if (!moving()) {
            inverted_ = wanted_inversion_.load(std::memory_order_relaxed);
        }
        silence_ = Words::word(lines_, inverted_);
    } else {
        fill(halves_[1U - playing_half_.load(std::memory_order_relaxed)], frame);
    }
    next_edges_ = !frame.edges.empty();
    ready_.store(true, std::memory_order_release);
    return true;
}

// The interrupt may come meanwhile: it then begins silence, or fails.
template <class Chip, class Table>
void PioPulsePlayer<Chip, Table>::fill(Half& half, const PulseFrame& frame) noexcept
{
    const PulseLines inverted = inverted_;
    PulseLines lines = lines_;
    std::uint32_t tick = 0;
    std::uint32_t word = Words::word(lines, inverted);
    for (const PulseEdge& edge : frame.edges) {
        for (; tick < edge.tick; ++tick) {
            half[tick] = word;
        }
        lines = static_cast<PulseLines>((lines | edge.raise) & ~unsigned{edge.lower});
        word = Words::word(lines, inverted);
    }
    for (; tick < half.size(); ++tick) {
        half[tick] = word;
    }
    lines_ = lines;
}

template <class Chip, class Table>
bool PioPulsePlayer<Chip, Table>::on_interrupt() noexcept
{
    Chip::dma().pending_0.write(kChannelBit);
    if (underrun()) {
        return false;
    }
    const bool ready = ready_.load(std::memory_order_acquire);
    const bool late = queued() < kLeastQueued;
    const bool error = (channel().ctrl.read() & kBusError) != 0;
    if (error || (playing_edges_ && (late || !ready))) {
        fail();
        return true;
    }
    playing_edges_ = ready && next_edges_;
    if (playing_edges_) {
        const unsigned half = 1U - playing_half_.load(std::memory_order_relaxed);
        begin(halves_[half].data(), kWords);
        playing_half_.store(half, std::memory_order_relaxed);
    } else {
        begin_silence();
    }
    ready_.store(false, std::memory_order_relaxed);
    return true;
}

// The words in the queue still play; then the state machine lowers the steps.
template <class Chip, class Table>
void PioPulsePlayer<Chip, Table>::fail() noexcept
{
    playing_edges_ = false;
    ready_.store(false, std::memory_order_relaxed);
    underrun_.store(true, std::memory_order_relaxed);
}

template <class Chip, class Table>
void PioPulsePlayer<Chip, Table>::clear_underrun() noexcept
{
    if (underrun()) {
        start_stream();
        underrun_.store(false, std::memory_order_relaxed);
    }
}

}  // namespace cusp::hal::rp2350
