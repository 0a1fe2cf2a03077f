// UsbController: the USB block as a device: its registers, its memory with the buffers' control words, and the wire.
#pragma once

#include "tests/target/cosim/rp2350/facet.hpp"
#include "tests/target/cosim/usb_device.hpp"

namespace cusp::cosim::rp2350 {

class UsbController final : public Model, public UsbDevice {
public:
    struct Wiring {
        std::function<std::uint32_t()> clock_hz;  // must be 48 MHz
        unsigned interrupt;
    };
    UsbController(Circuit& circuit, Wiring wiring);

    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override;
    void reset() override;

    // Its memory takes accesses of any width.
    std::uint32_t read_memory(std::uint32_t offset, unsigned size);
    void write_memory(std::uint32_t offset, unsigned size, std::uint32_t value);

    // UsbDevice
    bool attached() const override;
    void bus_reset() override;
    void suspend() override;
    void resume() override;
    Handshake setup(unsigned address, const std::array<std::uint8_t, 8>& bytes) override;
    Handshake out(unsigned address,
                  unsigned endpoint,
                  const std::vector<std::uint8_t>& bytes,
                  bool data_one) override;
    Handshake in(unsigned address,
                 unsigned endpoint,
                 std::vector<std::uint8_t>& bytes,
                 bool& data_one) override;
    bool has_packet(unsigned endpoint) const override;

private:
    static constexpr std::uint32_t kMemory = 4096;
    bool answers(unsigned address) const;
    std::uint32_t word(std::uint32_t offset) const;
    void set_word(std::uint32_t offset, std::uint32_t value);
    // Of an endpoint and a direction: the place of its control word, of its buffer's, and of the buffer.
    static std::uint32_t control_of(unsigned endpoint, bool in)
    {
        return 8 * endpoint + (in ? 0 : 4);
    }
    static std::uint32_t buffer_of(unsigned endpoint, bool in)
    {
        return 0x80 + 8 * endpoint + (in ? 0 : 4);
    }
    std::uint32_t data_of(unsigned endpoint, bool in) const;
    static std::uint32_t bit_of(unsigned endpoint, bool in)
    {
        return 1U << (2 * endpoint + (in ? 0 : 1));
    }
    bool enabled(unsigned endpoint, bool in) const;
    bool stalls(unsigned endpoint, bool in) const;
    bool available(unsigned endpoint, bool in) const;
    void complete(unsigned endpoint, bool in, std::uint32_t control);
    void check_control(std::uint32_t offset, std::uint32_t before, std::uint32_t after);
    std::uint32_t raw() const;
    void change();

    Wiring wiring_;
    std::array<std::uint8_t, kMemory> memory_{};
    std::uint32_t address_{0}, main_{4}, sie_ctrl_{0x8000}, sie_status_{0}, buff_status_{0},
        abort_{0}, abort_done_{0}, stall_arm_{0}, muxing_{1}, power_{0}, enabled_{0}, forced_{0};
    bool suspended_{false};
};

}  // namespace cusp::cosim::rp2350
