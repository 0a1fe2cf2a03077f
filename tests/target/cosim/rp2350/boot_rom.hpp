// BootRom: the boot ROM's table of functions, and the flash that some of them erase and program.
#pragma once

#include "tests/target/cosim/rp2350/facet.hpp"

namespace cusp::cosim::rp2350 {

class BootRom {
public:
    static constexpr std::uint32_t kFlashStart = 0x10000000;
    static constexpr std::uint32_t kSector = 4096;
    static constexpr std::uint32_t kRomBytes = 0x8000;
    // Code that hangs goes round in the last page.
    static constexpr std::uint32_t kCircles = kRomBytes - 1024;
    // Registers that are not on the chip: by them the functions reach this model.
    static constexpr std::uint32_t kGate = 0xF0000000;
    struct Wiring {
        std::function<bool()> has_power_for_write;
        std::function<void()> reboot;
        std::function<const std::uint8_t*(std::uint32_t address, std::uint32_t size)> memory;
    };
    BootRom(Circuit& circuit, std::uint32_t flash_bytes, Wiring wiring);

    static std::vector<std::uint8_t> code();
    // Where the image's vectors are. Throws std::runtime_error if the boot ROM would not start it.
    std::uint32_t vectors() const;
    // As after a reset: the flash can be read.
    void reset();
    Model& gate() { return gate_; }

    // As the core sees it: while it can't be read, rubbish.
    std::vector<std::uint8_t>& view() { return view_; }
    void load(const std::vector<std::uint8_t>& image);
    bool readable() const { return readable_; }

    void set_times(Picoseconds erase, Picoseconds word) { erase_time_ = erase, word_time_ = word; }
    std::uint64_t erases() const { return erases_; }
    std::uint64_t words() const { return words_; }

private:
    std::uint32_t call(unsigned function);
    std::uint32_t look_up(std::uint32_t code, std::uint32_t mask) const;
    void erase();
    void program();
    bool may_write(std::uint32_t place, std::uint32_t size, std::uint32_t unit);
    void show();

    Circuit& circuit_;
    Wiring wiring_;
    Facet gate_;
    std::vector<std::uint8_t> flash_, view_;
    std::array<std::uint32_t, 4> arguments_{};
    std::uint32_t result_{0};
    bool readable_{true}, connected_{false}, stale_{false};
    Picoseconds busy_until_{0};
    Picoseconds erase_time_{400 * kMillisecond};
    Picoseconds word_time_{47 * kMicrosecond};
    std::uint64_t erases_{0}, words_{0};
};

}  // namespace cusp::cosim::rp2350
