// Time on the chip, and the reads and writes of the core.
#include "tests/target/cosim/chip_under_test.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace cusp::cosim {
namespace {

constexpr std::uint32_t kUsb = 0x50000000;
bool is_usb(std::uint32_t address) { return address >= kUsb && address < kUsb + 0x5000; }

constexpr unsigned kPulseInterrupts[] = {57, 68};  // DMA2 streams 1 and 5

}  // namespace

ChipUnderTest::ChipUnderTest(const ChipKind& kind, const std::vector<std::uint8_t>& image)
    : kind_{kind}
{
    circuit_.memories.push_back(
        {0x20000000, std::vector<std::uint8_t>(kind.ram_bytes, 0xA5), true});
    if (kind.coupled_bytes != 0) {
        circuit_.memories.push_back(
            {0x10000000, std::vector<std::uint8_t>(kind.coupled_bytes, 0xA5), false});
    }
    clocks_ = std::make_unique<ClockModel>(circuit_, kind.clocks);
    flash_ = std::make_unique<FlashModel>(circuit_, *clocks_, kind.flash_bytes);
    if (image.size() > kind.flash_bytes) {
        throw std::runtime_error{"the image is larger than the flash"};
    }
    std::copy(image.begin(), image.end(), flash_->bytes().begin());
    make_blocks();
    make_timers();
    make_serial();
    make_usb();
    core_ = std::make_unique<CoreModel>(
        circuit_, flash_->bytes(),
        CoreModel::Outside{
            [this](std::uint32_t address, unsigned size) { return read(address, size); },
            [this](std::uint32_t address, unsigned size, std::uint32_t value) {
                write(address, size, value);
            },
            [this](std::uint32_t address, unsigned size, std::uint32_t value) {
                store_flash(address, size, value);
            },
            [this] { happen_until_now(); },
            [this] {
                return circuit_.now >= end_ || circuit_.now < flash_->busy_until() ||
                       watchdog_->bitten() || !powered_ || exhausted();
            }});
    add(0xE000E000, "core", *core_, [] { return true; });
    blocks_[0xE000E400] = blocks_[0xE000EC00] = blocks_[0xE000E000];
    reset(ClockModel::ResetCause::kPowerUp);
    resets_ = 0;
}

void ChipUnderTest::add(std::uint32_t address,
                        const std::string& name,
                        Model& model,
                        std::function<bool()> clocked)
{
    blocks_[address] = {&model, name, std::move(clocked)};
}

PortModel& ChipUnderTest::port(char letter)
{
    const auto found = ports_.find(letter);
    if (found == ports_.end()) {
        throw std::runtime_error{std::string{"the chip has no port "} + letter};
    }
    return *found->second;
}

void ChipUnderTest::add_drive(const std::string& name, const std::vector<Place>& wires)
{
    const auto wire = [this, &wires](std::size_t place) {
        return BusDriveModel::Wire{port(wires[place].port), wires[place].pin};
    };
    if (wires.size() == 1) {
        drives_.push_back(std::make_unique<DriveModel>(circuit_, name, wire(0).port, wire(0).pin));
    } else {
        drives_.push_back(
            std::make_unique<BusDriveModel>(circuit_, name, wire(0), wire(1), wire(2), wire(3)));
    }
    active_.push_back(drives_.back().get());
}

void ChipUnderTest::add_spindle(vfd::Protocol protocol, unsigned usart, char letter, unsigned pin)
{
    constexpr std::uint32_t kBaud = 19200;
    spindle_ = std::make_unique<SpindleModel>(circuit_, *usarts_.at(usart - 1), port(letter), pin,
                                              protocol, kBaud);
    active_.push_back(spindle_.get());
}

auto ChipUnderTest::block_of(std::uint32_t address, unsigned size, const char* what) -> Block*
{
    const auto found = blocks_.find(address & ~(kBlock - 1));
    if (found == blocks_.end()) {
        circuit_.violate(std::string{what} + " where no register is, " + hexadecimal(address));
        return nullptr;
    }
    if (size != 4) {
        circuit_.violate(found->second.name + ": " + what + " of " + std::to_string(size) +
                         " bytes");
    }
    if (!found->second.clocked()) {
        circuit_.violate(found->second.name + ": " + what + " without its clock, " +
                         hexadecimal(address));
        return nullptr;
    }
    return &found->second;
}

bool ChipUnderTest::usb_on(std::uint32_t address, unsigned size)
{
    constexpr unsigned kUsbClock = 7;
    const bool on = clocks_->ahb2_on(kUsbClock);
    if (size != 4 || !on) {
        circuit_.violate("USB: access of " + std::to_string(size) + " bytes, its clock is " +
                         (on ? "on, " : "off, ") + hexadecimal(address));
    }
    return on;
}

std::uint32_t ChipUnderTest::read(std::uint32_t address, unsigned size)
{
    constexpr std::uint32_t kDebug = 0xE0042000;
    if (address >= kDebug && address < kDebug + 0x10) {
        return address == kDebug + 8 ? freeze_1_ : address == kDebug + 12 ? freeze_2_ : 0;
    }
    if (is_usb(address)) {
        return usb_on(address, size) ? usb_->read(address - kUsb) : 0;
    }
    constexpr std::uint32_t kNumber = 0x1FFF7A10;  // the chip's own
    if (address >= kNumber && address < kNumber + 12) {
        return 0x10203040 + address;
    }
    Block* const block = block_of(address, size, "read");
    const bool core = address >= 0xE0000000;
    return block == nullptr ? 0 : block->model->read(address & (core ? 0xFFFU : kBlock - 1));
}

void ChipUnderTest::write(std::uint32_t address, unsigned size, std::uint32_t value)
{
    if (address == 0xE0042008 || address == 0xE004200C) {
        (address == 0xE0042008 ? freeze_1_ : freeze_2_) = value;
        return;
    }
    if (is_usb(address)) {
        if (usb_on(address, size)) {
            usb_->write(address - kUsb, value);
        }
        return;
    }
    Block* const block = block_of(address, size, "write");
    if (block == nullptr) {
        return;
    }
    const bool core = address >= 0xE0000000;
    block->model->write(address & (core ? 0xFFFU : kBlock - 1), value);
    if (clocks_->changes() != clock_changes_) {
        clock_changes_ = clocks_->changes();
        for (const auto& timer : timers_) {
            timer.second->look_again();
        }
    }
}

void ChipUnderTest::write_by_dma(std::uint32_t address, std::uint32_t value)
{
    const char letter = static_cast<char>('A' + (address - 0x40020000) / kBlock);
    if (address >= 0x40020000 && ports_.count(letter) != 0) {
        if (!clocks_->ahb1_on(static_cast<unsigned>(letter - 'A'))) {
            circuit_.violate(std::string{"port "} + letter + ": DMA writes without its clock");
            return;
        }
        ports_[letter]->write_by_dma(address & (kBlock - 1), value);
        return;
    }
    write(address, 4, value);
}

void ChipUnderTest::store_flash(std::uint32_t address, unsigned size, std::uint32_t value)
{
    if (writes_left_ == 0) {
        // Amid the write: some of its bits are cleared. The engine still stores the word.
        powered_ = false;
        torn_place_ = address - 0x08000000;
        std::memcpy(&torn_word_, &flash_->bytes()[torn_place_], 4);
        torn_word_ &= value | 0x0F0F3355U;
        return;
    }
    writes_left_ -= writes_left_ > 0 ? 1 : 0;
    flash_->store(address, size, value);
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
    const bool line = circuit_.interrupt_lines[kPulseInterrupts[kind_.has_timer8 ? 0 : 1]];
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
        if (circuit_.interrupts_changed || watchdog_->bitten()) {
            return;
        }
    }
}

void ChipUnderTest::run(Picoseconds time, const std::function<bool()>& until)
{
    end_ = circuit_.now + time;
    while (circuit_.now < end_ && powered_ && !exhausted()) {
        if (watchdog_->bitten()) {
            reset(ClockModel::ResetCause::kWatchdog);
        } else if (core_->reset_wanted()) {
            reset(ClockModel::ResetCause::kSoftware);
        }
        const bool stalled = circuit_.now < flash_->busy_until();
        if (held_ || core_->locked_up() || stalled) {
            circuit_.interrupts_changed = false;
            advance(stalled && !held_ ? std::min(end_, flash_->busy_until()) : end_);
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

void ChipUnderTest::reset(ClockModel::ResetCause cause)
{
    ++resets_;
    clocks_->note_reset(cause);
    clocks_->reset();
    flash_->reset();
    watchdog_->reset();
    dma1_->reset();
    dma2_->reset();
    for (const auto& usart : usarts_) {
        usart->reset();
    }
    usb_->reset();
    for (const auto& timer : timers_) {
        timer.second->reset();
    }
    for (const auto& port : ports_) {
        port.second->reset();
    }
    circuit_.interrupt_lines = {};
    core_->reset();
}

void ChipUnderTest::stop_core(bool debugger)
{
    held_ = true;
    if (debugger) {
        timers_["TIM1"]->freeze((freeze_2_ & 1U) != 0);
        if (kind_.has_timer8) {
            timers_["TIM8"]->freeze((freeze_2_ & 2U) != 0);
        }
        timers_["TIM2"]->freeze((freeze_1_ & 1U) != 0);
        watchdog_->freeze((freeze_1_ >> 12U & 1U) != 0);
    }
}

void ChipUnderTest::go_on()
{
    held_ = false;
    for (const auto& timer : timers_) {
        timer.second->freeze(false);
    }
    watchdog_->freeze(false);
}

void ChipUnderTest::hang_main_loop()
{
    while (!core_->in_thread()) {
        run(kMicrosecond);
    }
    core_->hang();
}

void ChipUnderTest::stop_pace() { timers_.at(kind_.has_timer8 ? "TIM8" : "TIM1")->freeze(true); }

void ChipUnderTest::power_cycle()
{
    for (MemoryArea& area : circuit_.memories) {
        std::fill(area.bytes.begin(), area.bytes.end(), std::uint8_t{0x5A});
    }
    if (!powered_) {
        std::memcpy(&flash_->bytes()[torn_place_], &torn_word_, 4);
    }
    powered_ = true;
    writes_left_ = -1;
    freeze_1_ = freeze_2_ = 0;
    held_ = false;
    for (const auto& usart : usarts_) {
        usart->unplug();
    }
    for (const auto& drive : drives_) {
        drive->reset();
    }
    reset(ClockModel::ResetCause::kPowerUp);
}

}  // namespace cusp::cosim
