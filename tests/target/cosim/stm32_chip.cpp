// The reads and writes of an STM32F4's core, its resets and its faults.
#include "tests/target/cosim/stm32_chip.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace cusp::cosim {
namespace {

constexpr std::uint32_t kUsb = 0x50000000;
bool is_usb(std::uint32_t address) { return address >= kUsb && address < kUsb + 0x5000; }

constexpr unsigned kPulseInterrupts[] = {57, 68};  // DMA2 streams 1 and 5

CoreFacts core_facts(std::uint32_t flash_bytes)
{
    constexpr std::uint32_t kPage = 1024;
    CoreFacts facts;
    facts.registers = {{0x40000000, 0x28000}, {0x50000000, 0x5000}, {0x1FFF7000, 0x1000},
                       {0xE0001000, 0x1000},  {0xE000E000, 0x1000}, {0xE0042000, 0x1000}};
    facts.circles = facts.flash_start + flash_bytes - kPage;
    return facts;
}

}  // namespace

Stm32Chip::Stm32Chip(const ChipKind& kind, const std::vector<std::uint8_t>& image) : kind_{kind}
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
        circuit_, core_facts(kind.flash_bytes), flash_->bytes(),
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
                return must_stop() || circuit_.now < flash_->busy_until() || watchdog_->bitten();
            }});
    add(0xE000E000, "core", *core_, [] { return true; });
    blocks_[0xE000E400] = blocks_[0xE000EC00] = blocks_[0xE000E000];
    for (const auto& [letter, port] : ports_) {
        pins_[letter] = port.get();
    }
    tick_line_ = kPulseInterrupts[kind_.has_timer8 ? 0 : 1];
    reset(Start::kPowerUp);
    resets_ = 0;
}

void Stm32Chip::add(std::uint32_t address,
                    const std::string& name,
                    Model& model,
                    std::function<bool()> clocked)
{
    blocks_[address] = {&model, name, std::move(clocked)};
}

PortModel& Stm32Chip::port_model(char letter)
{
    const auto found = ports_.find(letter);
    if (found == ports_.end()) {
        throw std::runtime_error{std::string{"the chip has no port "} + letter};
    }
    return *found->second;
}

void Stm32Chip::add_drive(const std::string& name, const std::vector<Place>& wires)
{
    const auto wire = [this, &wires](std::size_t place) {
        return BusDriveModel::Wire{port_model(wires[place].port), wires[place].pin};
    };
    if (wires.size() == 1) {
        drives_.push_back(std::make_unique<DriveModel>(circuit_, name, wire(0).port, wire(0).pin));
    } else {
        drives_.push_back(
            std::make_unique<BusDriveModel>(circuit_, name, wire(0), wire(1), wire(2), wire(3)));
    }
    active_.push_back(drives_.back().get());
}

void Stm32Chip::add_spindle(vfd::Protocol protocol, unsigned usart, char letter, unsigned pin)
{
    constexpr std::uint32_t kBaud = 19200;
    spindle_ = std::make_unique<SpindleModel>(circuit_, *usarts_.at(usart - 1), port_model(letter),
                                              pin, protocol, kBaud);
    active_.push_back(spindle_.get());
}

auto Stm32Chip::block_of(std::uint32_t address, unsigned size, const char* what) -> Block*
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

bool Stm32Chip::usb_on(std::uint32_t address, unsigned size)
{
    constexpr unsigned kUsbClock = 7;
    const bool on = clocks_->ahb2_on(kUsbClock);
    if (size != 4 || !on) {
        circuit_.violate("USB: access of " + std::to_string(size) + " bytes, its clock is " +
                         (on ? "on, " : "off, ") + hexadecimal(address));
    }
    return on;
}

std::uint32_t Stm32Chip::read(std::uint32_t address, unsigned size)
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

void Stm32Chip::write(std::uint32_t address, unsigned size, std::uint32_t value)
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

void Stm32Chip::write_by_dma(std::uint32_t address, std::uint32_t value)
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

void Stm32Chip::store_flash(std::uint32_t address, unsigned size, std::uint32_t value)
{
    if (!has_power_for_write()) {
        // Amid the write: some of its bits are cleared. The engine still stores the word.
        torn_ = true;
        torn_place_ = address - 0x08000000;
        std::memcpy(&torn_word_, &flash_->bytes()[torn_place_], 4);
        torn_word_ &= value | 0x0F0F3355U;
        return;
    }
    flash_->store(address, size, value);
}

void Stm32Chip::reset_blocks(Start start)
{
    clocks_->note_reset(start == Start::kPowerUp    ? ClockModel::ResetCause::kPowerUp
                        : start == Start::kWatchdog ? ClockModel::ResetCause::kWatchdog
                                                    : ClockModel::ResetCause::kSoftware);
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
}

void Stm32Chip::freeze(bool on)
{
    timers_["TIM1"]->freeze(on && (freeze_2_ & 1U) != 0);
    if (kind_.has_timer8) {
        timers_["TIM8"]->freeze(on && (freeze_2_ & 2U) != 0);
    }
    timers_["TIM2"]->freeze(on && (freeze_1_ & 1U) != 0);
    watchdog_->freeze(on && (freeze_1_ >> 12U & 1U) != 0);
}

void Stm32Chip::lose_power()
{
    if (torn_) {
        std::memcpy(&flash_->bytes()[torn_place_], &torn_word_, 4);
    }
    torn_ = false;
    freeze_1_ = freeze_2_ = 0;
    for (const auto& usart : usarts_) {
        usart->unplug();
    }
}

std::vector<ChipUnderTest::Duty> Stm32Chip::take_spindle_changes()
{
    std::vector<Duty> changes;
    for (const TimerModel::DutyChange& change : timers_.at("TIM3")->take_duty_changes()) {
        changes.push_back({change.time, change.channel + 1, change.ppm});
    }
    return changes;
}

}  // namespace cusp::cosim
