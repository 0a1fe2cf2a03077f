// Registers of a PIO block (RP2350's data sheet, section 11.7), its dividers and its cycles.
#include "tests/target/cosim/rp2350/pio_model.hpp"

#include <algorithm>
#include <utility>

namespace cusp::cosim::rp2350 {
namespace {

constexpr std::int64_t kFraction = 256;     // of a divisor
constexpr std::int64_t kSynchronisers = 2;  // cycles
constexpr std::uint32_t kFirstMachine = 0xC8;
constexpr std::uint32_t kMachineBytes = 0x18;
constexpr std::uint32_t kFirstStored = 0x128;
constexpr std::uint32_t kInterruptBits = 0xFFFF;

}  // namespace

PioModel::PioModel(Circuit& circuit, std::string name, Wiring wiring)
    : Model{circuit},
      name_{std::move(name)},
      wiring_{std::move(wiring)},
      machines_{PioMachine{*this, 0}, PioMachine{*this, 1}, PioMachine{*this, 2},
                PioMachine{*this, 3}}
{
}

void PioModel::reset()
{
    for (PioMachine& machine : machines_) {
        machine.reset();
    }
    paces_ = {};
    memory_ = {};
    out_ = directions_ = flags_ = bypass_ = overruns_ = flags_up_ = flags_down_ = 0;
    enabled_ = forced_ = {};
    on_their_way_.clear();
    synchronised_ = wiring_.levels();
    clock_changed();
    outputs_changed_ = interrupts_changed_ = true;
    settle();
}

void PioModel::clock_changed()
{
    cycle_since_ = cycle_now();
    since_ = circuit_.now;
    hz_ = std::max(1U, wiring_.clock_hz());
    plan();
}

std::int64_t PioModel::cycle_now() const
{
    const Picoseconds passed = circuit_.now - since_;
    const std::int64_t hz = hz_;
    // Rounded, since time_of() rounds down.
    const Picoseconds rest = passed % kSecond;
    return cycle_since_ + passed / kSecond * hz +
           (rest / 1000 * (hz / 1000) + kMicrosecond / 2) / kMicrosecond;
}

Picoseconds PioModel::time_of(std::int64_t cycle) const
{
    const std::int64_t cycles = cycle - cycle_since_;
    const std::int64_t hz = hz_;
    constexpr Picoseconds kNanoseconds = kSecond / 1000;
    return since_ + cycles / hz * kSecond +
           cycles % hz * kNanoseconds / std::max<std::int64_t>(1, hz / 1000);
}

std::int64_t PioModel::divisor(std::uint32_t clkdiv)
{
    const std::int64_t whole = clkdiv >> 16U;
    return whole == 0 ? 65536 * kFraction : whole * kFraction + (clkdiv >> 8U & 255U);
}

std::int64_t PioModel::cycle_of_tick(unsigned machine) const
{
    return paces_[machine].start +
           paces_[machine].tick * divisor(machines_[machine].clkdiv) / kFraction;
}

// The first tick of the divider that comes after a cycle.
std::int64_t PioModel::next_tick(unsigned machine, std::int64_t after) const
{
    const std::int64_t by = divisor(machines_[machine].clkdiv);
    const std::int64_t passed = after - paces_[machine].start;
    return passed < 0 ? 0 : ((passed + 1) * kFraction + by - 1) / by;
}

void PioModel::enable(unsigned machine, bool on)
{
    Pace& pace = paces_[machine];
    if (pace.on == on) {
        return;
    }
    pace.on = on;
    // A delay that was cut short goes on from there.
    const std::int64_t next = next_tick(machine, cycle_now());
    pace.tick = on ? next + pace.tick : std::max<std::int64_t>(0, pace.tick - next);
}

void PioModel::control(std::uint32_t value)
{
    if ((value >> 16U) != 0) {
        forbid("other blocks are started with it, which is not modelled");
    }
    for (unsigned i = 0; i < kMachines; ++i) {
        if ((value >> (4 + i) & 1U) != 0) {
            machines_[i].restart();
            paces_[i].asleep = false;
            paces_[i].tick = paces_[i].on ? next_tick(i, cycle_now()) : 0;
        }
        const std::int64_t now = cycle_now();
        if ((value >> (8 + i) & 1U) != 0) {
            const std::int64_t left = paces_[i].on ? paces_[i].tick - next_tick(i, now) : 0;
            paces_[i].start = now;
            paces_[i].tick = paces_[i].on ? 1 + std::max<std::int64_t>(0, left) : paces_[i].tick;
        }
        enable(i, (value >> i & 1U) != 0);
    }
}

std::uint32_t PioModel::pins() const
{
    while (!on_their_way_.empty() && on_their_way_.front().cycle + kSynchronisers <= cycle_) {
        synchronised_ = on_their_way_.front().levels;
        on_their_way_.pop_front();
    }
    return bypass_ == 0 ? synchronised_ : (synchronised_ & ~bypass_) | (wiring_.levels() & bypass_);
}

void PioModel::inputs_changed()
{
    const std::uint32_t latest =
        on_their_way_.empty() ? synchronised_ : on_their_way_.back().levels;
    const std::uint32_t levels = wiring_.levels();
    if (latest == levels) {
        return;
    }
    on_their_way_.push_back({cycle_now(), levels});
    wake(cycle_now() + kSynchronisers - 1);
    plan();
}

void PioModel::write_pins(std::uint32_t mask, std::uint32_t levels)
{
    const std::uint32_t before = std::exchange(out_, (out_ & ~mask) | levels);
    outputs_changed_ = outputs_changed_ || before != out_;
}

void PioModel::write_directions(std::uint32_t mask, std::uint32_t directions)
{
    const std::uint32_t before = std::exchange(directions_, (directions_ & ~mask) | directions);
    outputs_changed_ = outputs_changed_ || before != directions_;
}

void PioModel::write_flag(unsigned number, bool on)
{
    (on ? flags_up_ : flags_down_) |= 1U << number;
}

// Those that wait for something look again at their first tick after this cycle.
void PioModel::wake(std::int64_t after)
{
    for (unsigned i = 0; i < kMachines; ++i) {
        if (paces_[i].asleep) {
            paces_[i].asleep = false;
            paces_[i].tick = paces_[i].on ? next_tick(i, after) : 0;
        }
    }
}

void PioModel::happen()
{
    cycle_ = cycle_now();
    for (unsigned i = 0; i < kMachines; ++i) {
        Pace& pace = paces_[i];
        if (!pace.on || pace.asleep || cycle_of_tick(i) > cycle_) {
            continue;
        }
        const std::uint32_t ticks = machines_[i].tick();
        pace.asleep = ticks == 0;
        pace.tick += ticks;
    }
    settle();
}

// After the instructions of a cycle, or after a write.
void PioModel::settle()
{
    const std::uint32_t flags = (flags_ & ~flags_down_) | flags_up_;
    flags_up_ = flags_down_ = 0;
    const bool flags_changed = std::exchange(flags_, flags) != flags;
    const bool fifos_changed = std::exchange(fifos_changed_, false);
    if (std::exchange(outputs_changed_, false)) {
        wiring_.outputs_changed();
    }
    if (flags_changed || fifos_changed) {
        wake(cycle_now());
    }
    if (fifos_changed) {
        wiring_.requests_changed();
    }
    if (flags_changed || fifos_changed || std::exchange(interrupts_changed_, false)) {
        update_lines();
    }
    plan();
}

void PioModel::update_lines()
{
    for (unsigned i = 0; i < 2; ++i) {
        const bool raised = enabled_[i] != 0 && (raw_interrupts() & enabled_[i]) != 0;
        circuit_.set_line(wiring_.interrupt + i, raised || forced_[i] != 0);
    }
}

void PioModel::plan()
{
    std::int64_t first = -1;
    for (unsigned i = 0; i < kMachines; ++i) {
        if (paces_[i].on && !paces_[i].asleep) {
            const std::int64_t cycle = cycle_of_tick(i);
            first = first < 0 ? cycle : std::min(first, cycle);
        }
    }
    due_ = first < 0 ? kNever : std::max(circuit_.now, time_of(first));
    circuit_.next_event = 0;
}

void PioModel::send(unsigned machine, std::uint32_t word)
{
    PioMachine& it = machines_[machine];
    if (!it.push_sent(word)) {
        overruns_ |= 1U << (16 + machine);
        forbid("a word for state machine " + std::to_string(machine) + " finds its FIFO full");
        return;
    }
    const Pace& pace = paces_[machine];
    // Amid a delay the OSR is filled, so that the OUT behind it does not wait.
    if (pace.on && !pace.asleep && pace.tick > next_tick(machine, cycle_now())) {
        it.refill();
    }
    fifos_changed_ = true;
    settle();
}

std::uint32_t PioModel::receive(unsigned machine)
{
    std::uint32_t word = 0;
    if (!machines_[machine].pop_received(word)) {
        overruns_ |= 1U << (8 + machine);
        forbid("a word of state machine " + std::to_string(machine) + " is read that is not there");
    }
    fifos_changed_ = true;
    settle();
    return word;
}

std::uint32_t PioModel::raw_interrupts() const
{
    std::uint32_t raw = flags_ << 8U;
    for (unsigned i = 0; i < kMachines; ++i) {
        raw |= machines_[i].received() != 0 ? 1U << i : 0U;
        raw |= machines_[i].sent_full() ? 0U : 16U << i;
    }
    return raw;
}

std::uint32_t PioModel::levels_of_fifos() const
{
    std::uint32_t value = 0;
    for (unsigned i = 0; i < kMachines; ++i) {
        value |= static_cast<std::uint32_t>(machines_[i].sent() | machines_[i].received() << 4U)
                 << 8 * i;
    }
    return value;
}

std::uint32_t PioModel::states_of_fifos() const
{
    std::uint32_t value = 0;
    for (unsigned i = 0; i < kMachines; ++i) {
        const PioMachine& machine = machines_[i];
        value |= (machine.sent() == 0 ? 1U << 24U : 0U) << i;
        value |= (machine.sent_full() ? 1U << 16U : 0U) << i;
        value |= (machine.received() == 0 ? 1U << 8U : 0U) << i;
        value |= (machine.received_full() ? 1U : 0U) << i;
    }
    return value;
}

std::uint32_t PioModel::debug() const
{
    std::uint32_t value = overruns_;
    for (unsigned i = 0; i < kMachines; ++i) {
        value |= (machines_[i].starved ? 1U << 24U : 0U) << i;
        value |= (machines_[i].choked ? 1U : 0U) << i;
    }
    return value;
}

std::uint32_t PioModel::read_machine(std::uint32_t offset)
{
    const PioMachine& machine = machines_[(offset - kFirstMachine) / kMachineBytes];
    switch ((offset - kFirstMachine) % kMachineBytes) {
        case 0x00:
            return machine.clkdiv;
        case 0x04:
            return machine.execctrl | (machine.latched() && machine.waits() ? 1U << 31U : 0U);
        case 0x08:
            return machine.shiftctrl();
        case 0x0C:
            return machine.address();
        case 0x10:
            return machine.current();
        default:
            return machine.pinctrl;
    }
}

void PioModel::write_machine(std::uint32_t offset, std::uint32_t value)
{
    const unsigned number = (offset - kFirstMachine) / kMachineBytes;
    PioMachine& machine = machines_[number];
    Pace& pace = paces_[number];
    switch ((offset - kFirstMachine) % kMachineBytes) {
        case 0x00: {
            const std::int64_t now = cycle_now();
            const std::int64_t left = pace.on ? pace.tick - next_tick(number, now) : 0;
            machine.clkdiv = value;
            pace.start = pace.on ? now : pace.start;
            pace.tick = pace.on ? 1 + std::max<std::int64_t>(0, left) : pace.tick;
            break;
        }
        case 0x04:
            if ((value >> 17U & 1U) != 0) {
                forbid("OUT_STICKY is not modelled");
            }
            machine.execctrl = value & ~(1U << 31U);
            break;
        case 0x08: {
            constexpr std::uint32_t kJoins = 3U << 30U | 3U << 14U;
            if (pace.on && ((machine.shiftctrl() ^ value) & kJoins) != 0 &&
                (machine.sent() != 0 || machine.received() != 0)) {
                forbid("FIFOs are joined otherwise while their machine takes words from them");
            }
            machine.write_shiftctrl(value);
            break;
        }
        case 0x10:
            cycle_ = cycle_now();
            machine.force(static_cast<std::uint16_t>(value));
            pace.asleep = false;
            pace.tick = pace.on ? next_tick(number, cycle_) : 0;
            break;
        case 0x14:
            machine.pinctrl = value;
            break;
        default:
            forbid("a register to be read is written, " + hexadecimal(offset));
    }
}

std::uint32_t PioModel::read(std::uint32_t offset)
{
    if (offset >= 0x20 && offset < 0x30) {
        return receive((offset - 0x20) / 4);
    }
    if (offset >= kFirstMachine && offset < kFirstStored) {
        return read_machine(offset);
    }
    if (offset >= kFirstStored && offset < kFirstStored + 0x40) {
        return machines_[(offset - kFirstStored) / 16].stored((offset - kFirstStored) / 4 % 4);
    }
    if (offset >= 0x170 && offset < 0x188) {
        const unsigned line = (offset - 0x170) / 12;
        const unsigned which = (offset - 0x170) % 12 / 4;
        return which == 0   ? enabled_[line]
               : which == 1 ? forced_[line]
                            : (raw_interrupts() & enabled_[line]) | forced_[line];
    }
    switch (offset) {
        case 0x00: {
            std::uint32_t on = 0;
            for (unsigned i = 0; i < kMachines; ++i) {
                on |= (paces_[i].on ? 1U : 0U) << i;
            }
            return on;
        }
        case 0x04:
            return states_of_fifos();
        case 0x08:
            return debug();
        case 0x0C:
            return levels_of_fifos();
        case 0x30:
            return flags_;
        case 0x38:
            return bypass_;
        case 0x3C:
            return out_;
        case 0x40:
            return directions_;
        case 0x44:
            return 1U << 28U | 32U << 16U | kMachines << 8U | 4U;
        case 0x168:
            return 0;
        case 0x16C:
            return raw_interrupts();
        default:
            forbid("a register is read that is not modelled, " + hexadecimal(offset));
            return 0;
    }
}

void PioModel::write(std::uint32_t offset, std::uint32_t value)
{
    if (offset >= 0x10 && offset < 0x20) {
        send((offset - 0x10) / 4, value);
        return;
    }
    if (offset >= 0x48 && offset < kFirstMachine) {
        memory_[(offset - 0x48) / 4] = static_cast<std::uint16_t>(value);
    } else if (offset >= kFirstMachine && offset < kFirstStored) {
        write_machine(offset, value);
    } else if (offset >= kFirstStored && offset < kFirstStored + 0x40) {
        machines_[(offset - kFirstStored) / 16].stored((offset - kFirstStored) / 4 % 4) = value;
    } else if (offset >= 0x170 && offset < 0x188 && (offset - 0x170) % 12 < 8) {
        const unsigned line = (offset - 0x170) / 12;
        ((offset - 0x170) % 12 == 0 ? enabled_ : forced_)[line] = value & kInterruptBits;
        interrupts_changed_ = true;
    } else if (offset == 0x00) {
        control(value);
    } else if (offset == 0x08) {
        overruns_ &= ~value;
        for (unsigned i = 0; i < kMachines; ++i) {
            machines_[i].starved = machines_[i].starved && (value >> (24 + i) & 1U) == 0;
            machines_[i].choked = machines_[i].choked && (value >> i & 1U) == 0;
        }
    } else if (offset == 0x30 || offset == 0x34) {
        (offset == 0x34 ? flags_up_ : flags_down_) |= value & 0xFFU;
    } else if (offset == 0x38) {
        bypass_ = value;
    } else if (offset != 0x168 || value != 0) {
        forbid("a register is written that is not modelled, " + hexadecimal(offset));
    }
    settle();
}

}  // namespace cusp::cosim::rp2350
