// FlashModel: the flash and its controller: keys, programming, erasing, and the stalls of both.
#pragma once

#include "tests/target/cosim/clock_model.hpp"
#include "tests/target/cosim/model.hpp"

namespace cusp::cosim {

class FlashModel final : public Model {
public:
    FlashModel(Circuit& circuit, ClockModel& clocks, std::uint32_t size);

    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override;
    void reset() override;

    // A store of the core to the array itself.
    void store(std::uint32_t address, std::uint32_t size, std::uint32_t value);
    // While the controller is busy the core, which runs from the flash, is stalled.
    Picoseconds busy_until() const { return busy_until_; }

    std::vector<std::uint8_t>& bytes() { return bytes_; }
    // The slowest of the data sheet by default; 0: none.
    void set_times(Picoseconds erase, Picoseconds program)
    {
        erase_time_ = erase;
        program_time_ = program;
    }
    // The two sectors that may be erased and programmed: by default those behind the first.
    void set_free_sectors(unsigned first) { first_free_ = first; }
    std::uint64_t erases() const { return erases_; }
    std::uint64_t words() const { return words_; }

private:
    void command(std::uint32_t value);

    ClockModel& clocks_;
    std::vector<std::uint8_t> bytes_;
    std::uint32_t acr_{0}, sr_{0}, cr_{0x80000000};
    std::uint32_t key_{0};
    Picoseconds busy_until_{0};
    Picoseconds erase_time_{800 * kMillisecond};
    Picoseconds program_time_{16 * kMicrosecond};
    unsigned first_free_{1};
    std::uint64_t erases_{0};
    std::uint64_t words_{0};
};

}  // namespace cusp::cosim
