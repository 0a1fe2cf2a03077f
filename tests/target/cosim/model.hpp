// Model: a block of the chip that the core reaches through registers; and what all blocks share.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace cusp::cosim {

using Picoseconds = std::int64_t;
inline constexpr Picoseconds kMicrosecond = 1'000'000;
inline constexpr Picoseconds kMillisecond = 1'000 * kMicrosecond;
inline constexpr Picoseconds kSecond = 1'000 * kMillisecond;
inline constexpr Picoseconds kNever = std::numeric_limits<Picoseconds>::max();

// An action of a driver that the reference manual forbids. Each kind is kept once, with its count.
class Violations {
public:
    void add(Picoseconds now, const std::string& what);
    std::uint64_t count() const { return count_; }
    const std::vector<std::string>& list() const { return list_; }

private:
    std::vector<std::string> list_;
    std::vector<std::string> kinds_;
    std::uint64_t count_{0};
};

// Memory that the core and the DMA controllers reach.
struct MemoryArea {
    std::uint32_t start{0};
    std::vector<std::uint8_t> bytes;
    bool dma{true};  // whether the DMA controllers reach it too
    bool executes{false};
    bool writable{true};
};

// The view that every block of the chip has of the rest.
struct Circuit {
    Picoseconds now{0};
    Picoseconds next_event{0};  // 0: to be looked for anew
    Violations violations;
    std::array<bool, 96> interrupt_lines{};
    std::array<bool, 96> interrupt_edges{};  // lines that have risen: pending though they fell
    bool interrupts_changed{false};
    bool nmi{false};
    std::vector<MemoryArea> memories;

    void violate(const std::string& what) { violations.add(now, what); }
    void set_line(unsigned number, bool level)
    {
        if (interrupt_lines[number] != level) {
            interrupt_lines[number] = level;
            interrupt_edges[number] = interrupt_edges[number] || level;
            interrupts_changed = true;
            next_event = 0;
        }
    }
    // Place of a word on the bus that the DMA controllers see; null where none is.
    std::uint8_t* dma_memory(std::uint32_t address, std::uint32_t size);
};

class Model {
public:
    explicit Model(Circuit& circuit) : circuit_{circuit} {}
    Model(const Model&) = delete;
    Model& operator=(const Model&) = delete;
    virtual ~Model() = default;

    // Registers, by their offset in the block.
    virtual std::uint32_t read(std::uint32_t offset) = 0;
    virtual void write(std::uint32_t offset, std::uint32_t value) = 0;

    // When something happens next by itself, and that it happens: circuit_.now is that time. A model that
    // sets due_ sets circuit_.next_event to 0, too.
    Picoseconds due() const { return due_; }
    virtual void happen() {}

    // As after power-up.
    virtual void reset() = 0;

protected:
    Circuit& circuit_;
    Picoseconds due_{kNever};
};

// "0x40020818"
std::string hexadecimal(std::uint32_t value);

}  // namespace cusp::cosim
