// UsbModel: the block OTG FS in device mode, by RM0090 section 34, packet by packet, and the wire to a
// host (usb_host.hpp). FIFOs hold words as the chip's do; a packet is there once all its words are.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "tests/target/cosim/model.hpp"
#include "tests/target/cosim/usb_device.hpp"

namespace cusp::cosim {

class UsbModel final : public Model, public UsbDevice {
public:
    struct Wiring {
        std::function<std::uint32_t()> clock_hz;  // must be 48 MHz
        std::function<bool()> pins_ready;
        bool overrides_session;  // GOTGCTL instead of NOVBUSSENS: the F446
        unsigned interrupt;
    };
    UsbModel(Circuit& circuit, Wiring wiring);

    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override;
    void reset() override;

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
    static constexpr unsigned kEndpoints = 4;
    static constexpr std::uint32_t kFifoWords = 320;
    struct Endpoint {
        std::uint32_t ctl{0}, intr{0}, tsiz{0};
        bool enabled{false};
        bool nak{true};
        bool data_one{false};
        std::deque<std::uint32_t> fifo;  // of an IN endpoint
    };
    struct Received {
        std::uint32_t status;
        std::vector<std::uint32_t> words;
        std::function<void()> popped;
    };
    bool answers(unsigned address) const;
    std::uint32_t device_read(std::uint32_t offset) const;
    void device_write(std::uint32_t offset, std::uint32_t value);
    void write_control(Endpoint& endpoint, unsigned number, bool in, std::uint32_t value);
    void write_fifo(unsigned number, std::uint32_t word);
    std::uint32_t pop_status();
    std::uint32_t pop_word();
    void flush(std::uint32_t value);
    std::uint32_t fifo_words(unsigned number) const;
    bool fits(std::size_t words) const;
    void push(unsigned kind,
              unsigned endpoint,
              const std::vector<std::uint8_t>& bytes,
              std::function<void()> popped);
    std::uint32_t status() const;
    std::uint32_t all_endpoints() const;
    void change();

    Wiring wiring_;
    std::uint32_t gotgctl_{0}, gahbcfg_{0}, gusbcfg_{0}, gintsts_{0}, gintmsk_{0}, gccfg_{0};
    std::uint32_t grxfsiz_{0}, pcgcctl_{0}, dcfg_{0}, dctl_{2}, diepmsk_{0}, doepmsk_{0},
        daintmsk_{0};
    std::array<std::uint32_t, kEndpoints> txf_{};
    std::array<Endpoint, kEndpoints> in_, out_;
    std::deque<Received> received_;
    std::vector<std::uint32_t> words_;  // of the entry that was popped, still to be read
    std::size_t word_{0};
    std::function<void()> popped_;
    bool suspended_{false};
    unsigned address_{0};  // that of DCFG, from the next status packet on (RM0090 section 34.17.5)
};

}  // namespace cusp::cosim
