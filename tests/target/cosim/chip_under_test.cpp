// Time on the chip: the core's, and that of the blocks while it sleeps.
#include "tests/target/cosim/chip_under_test.hpp"

#include <algorithm>

namespace cusp::cosim {

Pins& ChipUnderTest::port(char letter) const
{
    const auto found = pins_.find(letter);
    if (found == pins_.end()) {
        throw std::runtime_error{std::string{"the chip has no port "} + letter};
    }
    return *found->second;
}

bool ChipUnderTest::has_power_for_write()
{
    if (writes_left_ == 0) {
        powered_ = false;
        return false;
    }
    writes_left_ -= writes_left_ > 0 ? 1 : 0;
    return true;
}

void ChipUnderTest::find_next()
{
    Picoseconds first = kNever;
    for (const Model* const model : active_) {
        first = std::min(first, model->due());
    }
    circuit_.next_event = first;
}

// Each event happens at its own time; the core is a block ahead of them at most.
void ChipUnderTest::happen_until_now()
{
    const Picoseconds now = circuit_.now;
    for (;;) {
        Model* first = nullptr;
        Picoseconds due = kNever;
        for (Model* const model : active_) {
            if (model->due() < due) {
                due = model->due();
                first = model;
            }
        }
        if (first == nullptr || due > now) {
            circuit_.next_event = due;
            break;
        }
        circuit_.now = due;
        first->happen();
        listen_for_ticks();
    }
    circuit_.now = now;
}

void ChipUnderTest::listen_for_ticks()
{
    const bool line = circuit_.interrupt_lines[tick_line_];
    if (line && !pace_line_ && tick_listener_) {
        tick_listener_();
    }
    pace_line_ = line;
}

void ChipUnderTest::advance(Picoseconds to)
{
    circuit_.next_event = 0;
    while (circuit_.now < to) {
        if (circuit_.next_event == 0) {
            find_next();
        }
        circuit_.now = std::max(circuit_.now, std::min(to, circuit_.next_event));
        happen_until_now();
        if (circuit_.interrupts_changed || watchdog_bites()) {
            return;
        }
    }
}

void ChipUnderTest::run(Picoseconds time, const std::function<bool()>& until)
{
    end_ = circuit_.now + time;
    while (circuit_.now < end_ && powered_ && !exhausted()) {
        if (watchdog_bites()) {
            reset(Start::kWatchdog);
        } else if (core_->reset_wanted()) {
            reset(Start::kSoftware);
        }
        const Picoseconds stalled = stalled_until();
        if (held_ || core_->locked_up() || circuit_.now < stalled) {
            circuit_.interrupts_changed = false;
            advance(circuit_.now < stalled && !held_ ? std::min(end_, stalled) : end_);
            circuit_.interrupts_changed = true;
            continue;
        }
        if (circuit_.interrupts_changed) {
            core_->take_exception();
        }
        if (!core_->sleeping()) {
            core_->run();
            continue;
        }
        if (until && until()) {
            return;
        }
        if (!circuit_.interrupts_changed) {
            advance(end_);
        }
    }
}

void ChipUnderTest::reset(Start start)
{
    ++resets_;
    reset_blocks(start);
    circuit_.interrupt_lines = {};
    core_->reset();
}

void ChipUnderTest::stop_core(bool debugger)
{
    held_ = true;
    if (debugger) {
        freeze(true);
    }
}

void ChipUnderTest::go_on()
{
    held_ = false;
    freeze(false);
}

void ChipUnderTest::hang_main_loop()
{
    while (!core_->in_thread()) {
        run(kMicrosecond);
    }
    core_->hang();
}

void ChipUnderTest::power_cycle()
{
    for (MemoryArea& area : circuit_.memories) {
        if (area.writable) {
            std::fill(area.bytes.begin(), area.bytes.end(), std::uint8_t{0x5A});
        }
    }
    lose_power();
    powered_ = true;
    writes_left_ = -1;
    held_ = false;
    serial().unplug();
    reset(Start::kPowerUp);
    for (const auto& drive : drives_) {
        drive->reset();
    }
}

}  // namespace cusp::cosim
