// UsbHost: the host at the other end of the plug: control transfers one by one, as it is told, and the bytes
// of the serial port in packets that the device takes or refuses.
#pragma once

#include <array>
#include <deque>

#include "tests/target/cosim/line_model.hpp"
#include "tests/target/cosim/model.hpp"
#include "tests/target/cosim/usb_device.hpp"

namespace cusp::cosim {

class UsbHost final : public Model, public LineModel {
public:
    UsbHost(Circuit& circuit, UsbDevice& device);

    struct Request {
        std::array<std::uint8_t, 8> setup;
        std::vector<std::uint8_t> data;  // to the device
    };
    struct Result {
        std::string stage;  // ack, stall, none, late
        std::vector<std::uint8_t> data;
    };
    // `run` lets the chip's time pass. Answers of up to 50 ms are waited for.
    Result control(const Request& request, const std::function<void(Picoseconds)>& run);
    // The SETUP packet alone: the transfer is given up.
    void begin_only(const Request& request);
    // One packet of another endpoint than 0, for whoever is the host in this one's place: ack, late where the device
    // has or takes none now, stall, none.
    std::string give(unsigned endpoint, const std::vector<std::uint8_t>& packet);
    Result fetch(unsigned endpoint);

    void plug();
    void unplug();
    void suspend();
    void resume();
    void set_address(unsigned address) { address_ = address; }
    // A program holds the port open, or not: bytes move or wait.
    void open(bool on);
    bool plugged() const { return plugged_; }

    // LineModel
    void send(const std::string& bytes) override;
    void set_receiver(std::function<void(char)> receiver) override
    {
        receiver_ = std::move(receiver);
    }
    std::size_t waiting() const override { return outgoing_.size(); }
    bool quiet() const override { return outgoing_.empty() && !device_.has_packet(kBulk); }
    void set_instant(bool on) override { slot_ = on ? 0 : kSlot; }
    void set_mute(bool on) override;
    std::uint64_t lost() const override { return 0; }

    // Model
    std::uint32_t read(std::uint32_t) override { return 0; }
    void write(std::uint32_t, std::uint32_t) override {}
    void reset() override {}
    void happen() override;

private:
    static constexpr unsigned kBulk = 1;
    static constexpr std::size_t kPacket = 64;
    static constexpr Picoseconds kSlot = 50 * kMicrosecond;

    void plan();
    bool send_packet();
    bool fetch_packet();
    Handshake wait(const std::function<Handshake()>& token,
                   const std::function<void(Picoseconds)>& run);
    Result read_data(unsigned length, const std::function<void(Picoseconds)>& run);

    UsbDevice& device_;
    std::function<void(char)> receiver_;
    std::deque<std::uint8_t> outgoing_;
    // A host's driver gets bytes once its buffer is full or a packet is short.
    static constexpr std::size_t kBuffer = 2 * kPacket;
    std::vector<std::uint8_t> buffer_;
    unsigned address_{0};
    bool plugged_{false}, open_{false}, mute_{false}, asleep_{false}, working_{false};
    std::array<bool, 4> out_one_{}, in_one_{};  // of each endpoint: the next packet is DATA1
    bool refused_{false};                       // both ways: until the device changes
    Picoseconds slot_{kSlot};
    Picoseconds last_{0};
    Picoseconds suspend_at_{kNever};
};

}  // namespace cusp::cosim
