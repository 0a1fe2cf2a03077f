// The bus of an RP2350: which block lies where (data sheet, section 2.2), and what a reset does to it.
#include "tests/target/cosim/rp2350/rp2350_chip.hpp"

#include <algorithm>
#include <cstring>

namespace cusp::cosim::rp2350 {
namespace {

constexpr std::uint32_t kFlashBytes = 4U << 20U;
constexpr std::uint32_t kRam = 0x20000000;
constexpr std::uint32_t kRamBytes = 520U << 10U;
constexpr std::uint32_t kUsbMemory = 0x50100000;
constexpr std::uint32_t kCoreRegisters = 0xD0000000;
constexpr unsigned kDmaInterrupt = 10;
constexpr unsigned kUsbInterrupt = 14;
constexpr unsigned kPioInterrupt = 15;
constexpr unsigned kUartInterrupt = 33;
// Bits of RESETS.
enum Reset : int {
    kResetDma = 2,
    kResetFunctions = 6,
    kResetPads = 9,
    kResetPio0 = 11,
    kResetPllSystem = 14,
    kResetPllUsb = 15,
    kResetWidths = 16,
    kResetTimer0 = 23,
    kResetUart0 = 26,
    kResetUsb = 28
};

}  // namespace

Rp2350Chip::Rp2350Chip(std::uint32_t crystal_hz, const std::vector<std::uint8_t>& image)
{
    circuit_.memories.push_back(
        {kRam, std::vector<std::uint8_t>(kRamBytes, 0xA5), true, true, true});
    circuit_.memories.push_back({0, BootRom::code(), false, true, false});
    rom_ = std::make_unique<BootRom>(
        circuit_, kFlashBytes,
        BootRom::Wiring{[this] { return has_power_for_write(); },
                        [this] { watchdog_->write(0, 1U << 31U); },
                        [this](std::uint32_t address, std::uint32_t size) {
                            return circuit_.dma_memory(address, size);
                        }});
    rom_->load(image);
    clocks_ = std::make_unique<ClockTree>(circuit_, crystal_hz, [this] { clocks_changed(); });
    make_pio();
    make_blocks();
    make_core();
    pins_['P'] = gpio_.get();
    tick_line_ = kDmaInterrupt;
    reset(Start::kPowerUp);
    resets_ = 0;
}

void Rp2350Chip::make_core()
{
    CoreFacts facts;
    facts.cpu = UC_CPU_ARM_CORTEX_M33;
    facts.flash_start = BootRom::kFlashStart;
    facts.registers = {{0x40000000, 0x168000}, {0x50000000, 0x600000}, {kCoreRegisters, 0x1000},
                       {0xE0001000, 0x1000},   {0xE000E000, 0x1000},   {BootRom::kGate, 0x1000}};
    facts.id = 0x411FD210;
    facts.late_stores = false;
    facts.vectors = rom_->vectors();
    facts.circles = BootRom::kCircles;
    core_ = std::make_unique<CoreModel>(
        circuit_, facts, rom_->view(),
        CoreModel::Outside{
            [this](std::uint32_t address, unsigned size) { return read(address, size); },
            [this](std::uint32_t address, unsigned size, std::uint32_t value) {
                write(address, size, value);
            },
            [this](std::uint32_t address, unsigned, std::uint32_t) {
                circuit_.violate("a store where nothing can be written, " + hexadecimal(address));
            },
            [this] { happen_until_now(); },
            [this] {
                return must_stop() || watchdog_->bitten();
            }});
}

void Rp2350Chip::make_pio()
{
    for (unsigned i = 0; i < pio_.size(); ++i) {
        pio_[i] = std::make_unique<PioModel>(
            circuit_, "PIO" + std::to_string(i),
            PioModel::Wiring{[this] { return clocks_->system_hz(); },
                             [this] { return gpio_ ? gpio_->levels() : 0U; },
                             [this] {
                                 if (gpio_) {
                                     gpio_->look();
                                 }
                             },
                             [this] {
                                 if (dma_) {
                                     dma_->look();
                                 }
                             },
                             kPioInterrupt + 2 * i});
        active_.push_back(pio_[i].get());
    }
    std::array<GpioModel::Driver, 3> drivers;
    for (unsigned i = 0; i < pio_.size(); ++i) {
        drivers[i] = {[this, i] { return pio_[i]->out(); },
                      [this, i] {
                          return pio_[i]->directions();
                      }};
    }
    gpio_ = std::make_unique<GpioModel>(circuit_, drivers, [this] {
        for (const auto& block : pio_) {
            block->inputs_changed();
        }
    });
}

void Rp2350Chip::add(std::uint32_t address, const std::string& name, Model& model, int reset)
{
    blocks_[address] = {&model, name, reset};
}

void Rp2350Chip::make_blocks()
{
    const auto system = [this] {
        return clocks_->system_hz();
    };
    dma_ = std::make_unique<DmaChannels>(
        circuit_, DmaChannels::Wiring{
                      system, [this](unsigned request) { return asks(request); },
                      [this](std::uint32_t at, unsigned size) { return read_by_dma(at, size); },
                      [this](std::uint32_t at, unsigned size, std::uint32_t value) {
                          write_by_dma(at, size, value);
                      },
                      kDmaInterrupt});
    uart_ = std::make_unique<UartModel>(
        circuit_, UartModel::Wiring{[this] { return clocks_->peripheral_hz(); },
                                    [this] {
                                        constexpr unsigned kUart = GpioModel::kUartFunction;
                                        return gpio_->ready(0, kUart, false) &&
                                               gpio_->ready(1, kUart, true);
                                    },
                                    [this] { dma_->look(); }, kUartInterrupt});
    watchdog_ = std::make_unique<Watchdog>(circuit_, [this] { return clocks_->tick_hz(4); });
    timer_ = std::make_unique<Timer0>(circuit_, [this] { return clocks_->tick_hz(2); });
    widths_ = std::make_unique<PulseWidths>(circuit_, system);
    usb_ = std::make_unique<UsbController>(
        circuit_, UsbController::Wiring{[this] { return clocks_->usb_hz(); }, kUsbInterrupt});
    host_ = std::make_unique<UsbHost>(circuit_, *usb_);
    for (Model* const model :
         {static_cast<Model*>(dma_.get()), static_cast<Model*>(uart_.get()),
          static_cast<Model*>(watchdog_.get()), static_cast<Model*>(timer_.get()),
          static_cast<Model*>(host_.get())}) {
        active_.push_back(model);
    }
    facets_.push_back(std::make_unique<Facet>(
        circuit_,
        [this](std::uint32_t offset) {
            return offset == 0 ? resets_word_ : offset == 8 ? ~resets_word_ & 0x1FFFFFFFU : 0U;
        },
        [this](std::uint32_t offset, std::uint32_t value) {
            if (offset == 0) {
                write_resets(value);
            }
        },
        [] {}));
    // Rows of the chip's own number.
    facets_.push_back(std::make_unique<Facet>(
        circuit_, [](std::uint32_t offset) { return 0x5A3C0000U + offset * 0x1357U; },
        [this](std::uint32_t, std::uint32_t) { circuit_.violate("OTP: written"); }, [] {}));
    // Of the power manager only what it tells of the last reset of the whole chip: the power came.
    facets_.push_back(std::make_unique<Facet>(
        circuit_, [](std::uint32_t offset) { return offset == 0x2C ? 1U << 16U : 0U; },
        [this](std::uint32_t, std::uint32_t) {
            circuit_.violate("POWMAN: written, which is not modelled");
        },
        [] {}));
    add(0x40100000, "POWMAN", *facets_[2]);
    add(0x40020000, "RESETS", *facets_[0]);
    add(0x40130000, "OTP", *facets_[1]);
    add(0x40010000, "CLOCKS", clocks_->generators());
    add(0x40018000, "PSM", watchdog_->sequencer());
    add(0x40028000, "IO_BANK0", gpio_->functions(), kResetFunctions);
    add(0x40038000, "PADS_BANK0", gpio_->pads(), kResetPads);
    add(0x40048000, "XOSC", clocks_->crystal());
    add(0x40050000, "PLL_SYS", clocks_->pll(0), kResetPllSystem);
    add(0x40058000, "PLL_USB", clocks_->pll(1), kResetPllUsb);
    add(0x40070000, "UART0", *uart_, kResetUart0);
    add(0x400A8000, "PWM", *widths_, kResetWidths);
    add(0x400B0000, "TIMER0", *timer_, kResetTimer0);
    add(0x400D8000, "WATCHDOG", *watchdog_);
    add(0x400E8000, "ROSC", clocks_->ring());
    add(0x40108000, "TICKS", clocks_->ticks());
    add(0x50000000, "DMA", *dma_, kResetDma);
    add(0x50110000, "USB", *usb_, kResetUsb);
    for (unsigned i = 0; i < pio_.size(); ++i) {
        add(0x50200000 + i * 0x100000, "PIO" + std::to_string(i), *pio_[i],
            kResetPio0 + static_cast<int>(i));
    }
}

void Rp2350Chip::clocks_changed()
{
    for (const auto& block : pio_) {
        if (block) {
            block->clock_changed();
        }
    }
    if (watchdog_) {
        watchdog_->look_again();
    }
}

void Rp2350Chip::write_resets(std::uint32_t value)
{
    const std::uint32_t before = resets_word_;
    resets_word_ = value & 0x1FFFFFFFU;
    for (const auto& [address, block] : blocks_) {
        if (block.reset >= 0 && (resets_word_ & ~before) >> block.reset % 32 & 1U) {
            block.model->reset();
        }
    }
}

void Rp2350Chip::reset_blocks(Start start)
{
    static_cast<void>(start);
    clocks_->reset();
    resets_word_ = 0x1FFFFFFF;
    gpio_->reset();
    for (const auto& block : pio_) {
        block->reset();
    }
    dma_->reset();
    uart_->reset();
    watchdog_->reset();
    timer_->reset();
    widths_->reset();
    usb_->reset();
    rom_->reset();
    paced_ = true;
}

bool Rp2350Chip::asks(unsigned request) const
{
    constexpr unsigned kPerBlock = 8;
    if (request < kPerBlock * pio_.size()) {
        const PioModel& block = *pio_[request / kPerBlock];
        const unsigned machine = request % 4;
        const bool sends = request % kPerBlock < 4;
        return sends ? paced_ && block.wants(machine) : block.offers(machine);
    }
    return request == 28 ? uart_->wants() : request == 29 && uart_->offers();
}

auto Rp2350Chip::block_of(std::uint32_t address, const char* what) -> Block*
{
    // Blocks on the slow bus are 32 KB apart, those on the fast one 64 KB.
    const std::uint32_t base = address & (address >= 0x50000000 ? 0xFFFF0000 : 0xFFFF8000);
    const auto found = blocks_.find(base);
    if (found == blocks_.end()) {
        circuit_.violate(std::string{what} + " where no register is modelled, " +
                         hexadecimal(address));
        return nullptr;
    }
    if (in_reset(found->second.reset)) {
        circuit_.violate(found->second.name + ": " + what + " in its reset, " +
                         hexadecimal(address));
        return nullptr;
    }
    return &found->second;
}

std::uint32_t Rp2350Chip::read(std::uint32_t address, unsigned size)
{
    if (address >= kUsbMemory && address < kUsbMemory + 0x1000 && !in_reset(kResetUsb)) {
        return usb_->read_memory(address - kUsbMemory, size);
    }
    if (size != 4 && address < 0xE000E000) {
        circuit_.violate("a register is read by " + std::to_string(size) + " bytes, " +
                         hexadecimal(address));
    }
    if (address >= BootRom::kGate) {
        return rom_->gate().read(address - BootRom::kGate);
    }
    if (address >= 0xE000E000) {
        return core_->read(address - 0xE000E000);
    }
    if (address >= kCoreRegisters) {
        return address < 0xE0000000 ? gpio_->core().read(address - kCoreRegisters) : 0U;
    }
    Block* const block = block_of(address, "read");
    return block == nullptr ? 0U : block->model->read(address & 0xFFFU);
}

void Rp2350Chip::write(std::uint32_t address, unsigned size, std::uint32_t value)
{
    if (address >= kUsbMemory && address < kUsbMemory + 0x1000 && !in_reset(kResetUsb)) {
        usb_->write_memory(address - kUsbMemory, size, value);
        return;
    }
    if (size != 4 && address < 0xE000E000) {
        circuit_.violate("a register is written by " + std::to_string(size) + " bytes, " +
                         hexadecimal(address));
    }
    if (address >= BootRom::kGate) {
        rom_->gate().write(address - BootRom::kGate, value);
        return;
    }
    if (address >= 0xE000E000) {
        core_->write(address - 0xE000E000, value);
        return;
    }
    if (address >= kCoreRegisters) {
        gpio_->core().write(address - kCoreRegisters, value);
        return;
    }
    Block* const block = block_of(address, "write");
    if (block == nullptr) {
        return;
    }
    const std::uint32_t offset = address & 0xFFFU;
    // Aliases that turn bits over, set them, clear them.
    switch (address >> 12U & 3U) {
        case 0:
            block->model->write(offset, value);
            break;
        case 1:
            block->model->write(offset, block->model->read(offset) ^ value);
            break;
        case 2:
            block->model->write(offset, block->model->read(offset) | value);
            break;
        default:
            block->model->write(offset, block->model->read(offset) & ~value);
    }
}

std::uint32_t Rp2350Chip::read_by_dma(std::uint32_t address, unsigned size)
{
    std::uint32_t value = 0;
    if (const std::uint8_t* const from = circuit_.dma_memory(address, size); from != nullptr) {
        std::memcpy(&value, from, size);
    } else {
        value = read(address, size);
    }
    return value;
}

void Rp2350Chip::write_by_dma(std::uint32_t address, unsigned size, std::uint32_t value)
{
    if (std::uint8_t* const to = circuit_.dma_memory(address, size); to != nullptr) {
        std::memcpy(to, &value, size);
    } else if (address >= kCoreRegisters) {
        circuit_.violate("DMA: no way to " + hexadecimal(address));
    } else {
        write(address, size, value);
    }
}

int Rp2350Chip::spindle_output() const
{
    for (unsigned pin = 0; pin < GpioModel::kPins; ++pin) {
        if (gpio_->given_to(pin) == static_cast<int>(GpioModel::kPwmFunction)) {
            return static_cast<int>(pin % 16);
        }
    }
    return -1;
}

std::uint32_t Rp2350Chip::spindle_duty(unsigned channel) const
{
    const int output = spindle_output();
    return output < 0 || channel != 1 ? 0U : widths_->duty_ppm(static_cast<unsigned>(output));
}

std::uint32_t Rp2350Chip::spindle_hz() const
{
    const int output = spindle_output();
    return output < 0 ? 0U : widths_->pulses_hz(static_cast<unsigned>(output));
}

std::vector<ChipUnderTest::Duty> Rp2350Chip::take_spindle_changes()
{
    std::vector<Duty> changes;
    for (const PulseWidths::Change& change : widths_->take_changes()) {
        if (static_cast<int>(change.output) == spindle_output()) {
            changes.push_back({change.time, 1, change.ppm});
        }
    }
    return changes;
}

// A frame behind, the words that wait in the queue and the one that plays; and the state machine's tick from
// where it takes a word to where that is at the pins.
Picoseconds Rp2350Chip::frame_delay() const { return 1009 * kMicrosecond + kMicrosecond / 10; }

}  // namespace cusp::cosim::rp2350
