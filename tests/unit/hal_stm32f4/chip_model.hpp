// A model of the parts of the STM32F405 that the drivers touch, register by register: timer 8,
// stream 1 of DMA2, port C, the flash and its data cache, the clocks. The model behaves as the
// reference manual describes, and counts accesses that the manual forbids.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "hal/stm32f4/registers.hpp"
#include "tests/support/pin_change.hpp"

namespace cusp::test {

// A register that reports each access to the model.
class ModelWord {
public:
    std::uint32_t read();
    void write(std::uint32_t value);
    // The value of the register; reading it is not reported.
    std::uint32_t value{0};
};

class ChipModel {
public:
    ChipModel();
    ~ChipModel();
    ChipModel(const ChipModel&) = delete;
    ChipModel& operator=(const ChipModel&) = delete;

    // One microsecond: the timer's update, the word it asks for, the flags.
    void run_microsecond();
    std::uint64_t now() const { return now_; }
    bool interrupt_pending() const;
    void raise_transfer_error();

    // Every change of the port's levels, in order.
    std::vector<PinChange> changes;
    // Accesses that the manual forbids: the stream's registers while it runs, flags left set at its
    // start, flash writes without unlocking, programming what is not erased.
    std::uint32_t violations{0};

    // Which of the clocks start; and that the core never runs from a clock that is off, nor faster
    // than the flash's wait states allow, is among the violations.
    bool crystal_works{false};
    bool multiplier_works{false};
    std::uint32_t crystal_hz{8000000};  // what timer 11 measures

    // Flash: after this many words and erasures the power fails; nothing more is written.
    std::int64_t power_left{1000000};
    std::map<std::uint32_t, std::uint32_t> flash_words;  // not there: erased
    std::uint32_t read_memory(std::uint32_t address);
    void write_memory(std::uint32_t address, std::uint32_t value);

    std::uint32_t bus_address(const volatile void* memory);
    std::uint32_t on_read(ModelWord& word);
    void on_write(ModelWord& word, std::uint32_t value);

    hal::stm32f4::Rcc<ModelWord> rcc{};
    hal::stm32f4::Flash<ModelWord> flash{};
    hal::stm32f4::Power<ModelWord> power{};
    hal::stm32f4::Gpio<ModelWord> port_c{};
    hal::stm32f4::Dma<ModelWord> dma2{};
    hal::stm32f4::Timer<ModelWord> timer8{};
    hal::stm32f4::Timer<ModelWord> timer2{};
    hal::stm32f4::Timer<ModelWord> timer11{};
    hal::stm32f4::Debug<ModelWord> debugger{};
    hal::stm32f4::Usart<ModelWord> usart1{};

    static ChipModel* current;

private:
    void write_port(std::uint32_t word);
    void write_stream_control(std::uint32_t value);
    void write_flash_control(std::uint32_t value);
    void write_flash_access(std::uint32_t value);
    void write_clock_control(std::uint32_t value);
    void write_clock_choice(std::uint32_t value);
    std::uint32_t word_of_memory(std::uint32_t index) const;
    bool spend_power();
    bool gate_open();
    void capture();

    std::uint64_t now_{0};
    std::vector<const volatile void*> addresses_;
    std::uint32_t start_count_{0};
    std::uint32_t fetched_{0};
    std::map<std::uint32_t, std::uint32_t> cached_;  // flash words in the data cache
    std::uint32_t keys_{0};
    std::uint32_t busy_reads_{0};
};

// The drivers' template argument Chip in the tests.
struct ModelChip {
    using Word = ModelWord;
    static auto& rcc() { return ChipModel::current->rcc; }
    static auto& flash() { return ChipModel::current->flash; }
    static auto& power() { return ChipModel::current->power; }
    static auto& port(char /*letter*/) { return ChipModel::current->port_c; }
    static auto& dma2() { return ChipModel::current->dma2; }
    static auto& timer8() { return ChipModel::current->timer8; }
    static auto& timer2() { return ChipModel::current->timer2; }
    static auto& timer11() { return ChipModel::current->timer11; }
    static auto& debug() { return ChipModel::current->debugger; }
    static auto& usart1() { return ChipModel::current->usart1; }
    static std::uint32_t bus_address(const volatile void* memory)
    {
        return ChipModel::current->bus_address(memory);
    }
    static std::uint32_t read_memory(std::uint32_t address)
    {
        return ChipModel::current->read_memory(address);
    }
    static void write_memory(std::uint32_t address, std::uint32_t value)
    {
        ChipModel::current->write_memory(address, value);
    }
};

}  // namespace cusp::test
