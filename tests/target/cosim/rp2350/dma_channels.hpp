// DmaChannels: the DMA controller's sixteen channels: pacing by requests and by its timers, chains, rings, interrupts.
#pragma once

#include <functional>

#include "tests/target/cosim/model.hpp"

namespace cusp::cosim::rp2350 {

class DmaChannels final : public Model {
public:
    struct Wiring {
        std::function<std::uint32_t()> clock_hz;
        std::function<bool(unsigned request)> asks;
        std::function<std::uint32_t(std::uint32_t address, unsigned size)> read;
        std::function<void(std::uint32_t address, unsigned size, std::uint32_t value)> write;
        unsigned interrupt;  // the first of four
    };
    DmaChannels(Circuit& circuit, Wiring wiring);

    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override;
    void reset() override;
    void happen() override;

    // What a block asks for has changed.
    void look();

private:
    static constexpr unsigned kChannels = 16;
    static constexpr unsigned kTimers = 4;
    struct Channel {
        std::uint32_t from{0}, to{0}, count{0}, reload{0}, ctrl{0};
        bool busy{false};
        Picoseconds done_at{kNever};  // of one without requests
    };
    unsigned request_of(const Channel& channel) const { return channel.ctrl >> 17U & 63U; }
    std::uint32_t read_channel(std::uint32_t offset) const;
    void write_channel(std::uint32_t offset, std::uint32_t value);
    void trigger(unsigned number, bool null);
    void move_one(unsigned number);
    void finish(unsigned number);
    void abort(std::uint32_t mask);
    std::uint32_t step(const Channel& channel, std::uint32_t address, bool write) const;
    void update_lines();
    void plan();
    void complain(unsigned number, const std::string& what);
    Picoseconds timer_period(unsigned timer) const;

    Wiring wiring_;
    std::array<Channel, kChannels> channels_{};
    std::array<std::uint32_t, kTimers> timers_{};
    std::array<Picoseconds, kTimers> timers_due_{};
    std::array<std::uint32_t, 4> enabled_{}, forced_{};
    std::uint32_t raised_{0};
    bool looking_{false}, again_{false};
};

}  // namespace cusp::cosim::rp2350
