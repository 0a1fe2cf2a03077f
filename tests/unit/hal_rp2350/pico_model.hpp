// A model of the parts of the RP2350 that the drivers touch, register by register: channel 0 of the DMA, the first state
// machine of PIO0, pins and pads, UART0, the flash behind the boot ROM, the clocks, USB. The model behaves as the data sheet
// describes, and counts accesses that it forbids.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "hal/rp2350/boot_rom.hpp"
#include "hal/rp2350/chip_registers.hpp"
#include "tests/support/pin_change.hpp"

namespace cusp::test {

// A register that reports each access to the model.
class PicoWord {
public:
    std::uint32_t read();
    void write(std::uint32_t value);
    // The value of the register; reading it is not reported.
    std::uint32_t value{0};
};

// The state machine: the instructions that the player's program uses (11.4).
class MachineModel {
public:
    void execute(std::uint32_t instruction);
    // One cycle of its clock.
    void run_cycle();

    bool on{false};
    std::uint32_t pins{0};        // levels, by the pins' numbers
    std::uint32_t directions{0};  // 1: driven
    std::deque<std::uint32_t> queue;
    unsigned pc{0};
    std::uint32_t violations{0};
    const hal::rp2350::Pio<PicoWord>* pio{nullptr};

private:
    void out(std::uint32_t instruction);

    std::uint32_t x_{0xDEADBEEF};
    std::uint32_t osr_{0};
    std::uint32_t isr_{0};
    unsigned delay_{0};
};

class PicoModel {
public:
    PicoModel();
    ~PicoModel();
    PicoModel(const PicoModel&) = delete;
    PicoModel& operator=(const PicoModel&) = delete;

    // Ten cycles of the state machine, and what the channel brings meanwhile.
    void run_microsecond();
    std::uint64_t now() const { return now_; }
    bool interrupt_pending() const { return (dma.raised.value & dma.enabled_0.value) != 0; }
    void raise_bus_error() { dma.channel[0].ctrl.value |= 1U << 31U; }
    // Levels of all pins, each by what has it.
    std::uint32_t levels() const;

    std::vector<PinChange> changes;  // of the pins that are watched
    std::uint32_t watched{0x3FFFFFFF};
    std::uint32_t violations{0};
    MachineModel machine;

    bool crystal_works{true};
    bool multipliers_work{true};

    // Bytes from and to the serial line.
    std::deque<std::uint32_t> uart_in;  // as DR gives them
    std::deque<std::uint8_t> uart_out;

    // Flash: after this many pages and erasures the power fails; nothing more is written.
    std::int64_t power_left{1000000};
    std::map<std::uint32_t, std::uint8_t> flash;  // by offset; not there: erased
    void erase_flash(std::uint32_t offset, std::uint32_t size);
    void program_flash(std::uint32_t offset, const hal::rp2350::FlashPage& page);
    std::uint32_t read_memory(std::uint32_t address);

    std::uint32_t bus_address(const volatile void* memory);
    std::uint32_t on_read(PicoWord& word);
    void on_write(PicoWord& word, std::uint32_t value);

    hal::rp2350::Clocks<PicoWord> clocks{};
    hal::rp2350::PowerSequence<PicoWord> power_sequence{};
    hal::rp2350::Resets<PicoWord> resets{};
    hal::rp2350::PinFunctions<PicoWord> functions{};
    hal::rp2350::Pads<PicoWord> pads{};
    hal::rp2350::Crystal<PicoWord> crystal{};
    hal::rp2350::Multiplier<PicoWord> core_multiplier{};
    hal::rp2350::Multiplier<PicoWord> usb_multiplier{};
    hal::rp2350::Uart<PicoWord> uart0{};
    hal::rp2350::Pwm<PicoWord> pwm{};
    hal::rp2350::Watchdog<PicoWord> watchdog{};
    hal::rp2350::PowerManager<PicoWord> power{};
    hal::rp2350::Ticks<PicoWord> ticks{};
    hal::rp2350::Dma<PicoWord> dma{};
    hal::rp2350::UsbMemory<PicoWord> usb_memory{};
    hal::rp2350::Usb<PicoWord> usb{};
    hal::rp2350::Pio<PicoWord> pio0{};
    hal::rp2350::CorePins<PicoWord> core_pins{};
    hal::cortex_m::InterruptController<PicoWord> interrupts{};

    static PicoModel* current;

private:
    bool write_dma(PicoWord& word, std::uint32_t value);
    bool write_pio(PicoWord& word, std::uint32_t value);
    bool write_pins(PicoWord& word, std::uint32_t value);
    bool write_usb(PicoWord& word, std::uint32_t value);
    void write_clock(PicoWord& word);
    void feed();
    void note_pins();

    std::uint64_t now_{0};
    std::vector<const volatile void*> addresses_;
    bool busy_{false};
    std::uint32_t left_{0};
    std::uint32_t fetched_{0};
    std::uint32_t last_levels_{0};
};

// The drivers' template argument Chip in the tests.
struct PicoChip {
    using Word = PicoWord;
    static auto& clocks() { return PicoModel::current->clocks; }
    static auto& power_sequence() { return PicoModel::current->power_sequence; }
    static auto& resets() { return PicoModel::current->resets; }
    static auto& functions() { return PicoModel::current->functions; }
    static auto& pads() { return PicoModel::current->pads; }
    static auto& crystal() { return PicoModel::current->crystal; }
    static auto& core_multiplier() { return PicoModel::current->core_multiplier; }
    static auto& usb_multiplier() { return PicoModel::current->usb_multiplier; }
    static auto& uart0() { return PicoModel::current->uart0; }
    static auto& pwm() { return PicoModel::current->pwm; }
    static auto& watchdog() { return PicoModel::current->watchdog; }
    static auto& power() { return PicoModel::current->power; }
    static auto& ticks() { return PicoModel::current->ticks; }
    static auto& dma() { return PicoModel::current->dma; }
    static auto& usb_memory() { return PicoModel::current->usb_memory; }
    static auto& usb() { return PicoModel::current->usb; }
    static auto& pio0() { return PicoModel::current->pio0; }
    static auto& core_pins() { return PicoModel::current->core_pins; }
    static auto& interrupts() { return PicoModel::current->interrupts; }
    static void erase_flash(std::uint32_t offset, std::uint32_t size)
    {
        PicoModel::current->erase_flash(offset, size);
    }
    static void program_flash(std::uint32_t offset, const hal::rp2350::FlashPage& page)
    {
        PicoModel::current->program_flash(offset, page);
    }
    static std::uint32_t read_memory(std::uint32_t address)
    {
        return PicoModel::current->read_memory(address);
    }
    static std::uint32_t bus_address(const volatile void* memory)
    {
        return PicoModel::current->bus_address(memory);
    }
};

}  // namespace cusp::test
