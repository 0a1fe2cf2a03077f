// UsbDevice: a device at the other end of a host's wire, packet by packet.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace cusp::cosim {

// The answer of a device to a token of the host.
enum class Handshake : std::uint8_t { kAck, kNak, kStall, kNone };

class UsbDevice {
public:
    UsbDevice() = default;
    UsbDevice(const UsbDevice&) = delete;
    UsbDevice& operator=(const UsbDevice&) = delete;
    virtual ~UsbDevice() = default;

    // The device's pull-up is on.
    virtual bool attached() const = 0;
    virtual void bus_reset() = 0;
    virtual void suspend() = 0;
    virtual void resume() = 0;
    virtual Handshake setup(unsigned address, const std::array<std::uint8_t, 8>& bytes) = 0;
    // `data_one`: the packet is DATA1. A packet that the device has had already is taken and dropped.
    virtual Handshake out(unsigned address,
                          unsigned endpoint,
                          const std::vector<std::uint8_t>& bytes,
                          bool data_one) = 0;
    virtual Handshake in(unsigned address,
                         unsigned endpoint,
                         std::vector<std::uint8_t>& bytes,
                         bool& data_one) = 0;
    // A packet of an IN endpoint waits to be fetched.
    virtual bool has_packet(unsigned endpoint) const = 0;
    // Called where the device may answer otherwise than before.
    void set_listener(std::function<void()> listener) { listener_ = std::move(listener); }

protected:
    void answers_otherwise() const
    {
        if (listener_) {
            listener_();
        }
    }

private:
    std::function<void()> listener_;
};

}  // namespace cusp::cosim
