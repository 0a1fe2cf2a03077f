// DmaModel: a DMA controller with its eight streams, in direct mode.
#pragma once

#include <functional>

#include "tests/target/cosim/model.hpp"

namespace cusp::cosim {

class DmaModel final : public Model {
public:
    // Peripherals that the controller reaches: a word read or written at an address.
    struct Port {
        std::function<std::uint32_t(std::uint32_t)> read;
        std::function<void(std::uint32_t, std::uint32_t)> write;
    };
    // `interrupts`: the number of each stream's interrupt.
    DmaModel(Circuit& circuit, std::string name, std::array<unsigned, 8> interrupts, Port port);

    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override;
    void reset() override;
    void happen() override;

    // A peripheral asks this stream for one item, by this channel. False where nobody serves it.
    bool request(unsigned stream, unsigned channel);
    // Called when a stream is switched on: who waits for it may ask now.
    void set_start_listener(std::function<void()> listener) { started_ = std::move(listener); }
    // True if a stream is switched on for a channel.
    bool serves(unsigned stream, unsigned channel) const;

private:
    struct Stream {
        std::uint32_t cr{0}, ndtr{0}, par{0}, m0ar{0}, m1ar{0}, fcr{0x21};
        std::uint32_t size{0};  // NDTR when it was switched on
        std::uint32_t left{0};  // items until the end
        std::uint32_t prefetched{0};
        Picoseconds stops_at{kNever};
        Picoseconds reloaded_at{-kSecond};  // a ring began anew
    };
    bool reloads(const Stream& stream) const;
    void write_stream(unsigned index, std::uint32_t offset, std::uint32_t value);
    void write_settings(unsigned index, std::uint32_t value);
    void start(unsigned index);
    void fetch(unsigned index);
    void count_item(unsigned index);
    void raise(unsigned index, std::uint32_t flag);
    void update_line(unsigned index);
    void complain(unsigned index, const std::string& what);

    std::string name_;
    std::array<unsigned, 8> interrupts_;
    Port port_;
    std::array<Stream, 8> streams_;
    std::function<void()> started_;
    std::array<std::uint32_t, 8> flags_{};  // of each stream, in its lowest place
};

}  // namespace cusp::cosim
