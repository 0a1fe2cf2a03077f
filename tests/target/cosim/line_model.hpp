// LineModel: the other end of a line to the chip: the sender's; SerialLine: that of a serial port.
#pragma once

#include <functional>
#include <string>

namespace cusp::cosim {

class LineModel {
public:
    virtual ~LineModel() = default;

    virtual void send(const std::string& bytes) = 0;
    // Takes a byte that the chip has sent.
    virtual void set_receiver(std::function<void(char)> receiver) = 0;
    // Bytes that are still to be sent.
    virtual std::size_t waiting() const = 0;
    // True if no byte is on its way, to the chip or from it.
    virtual bool quiet() const = 0;
    // Without any time for a byte.
    virtual void set_instant(bool on) = 0;
    // The sender does not read.
    virtual void set_mute(bool on) = 0;
    // Bytes that the chip did not take.
    virtual std::uint64_t lost() const = 0;
};

class SerialLine : public LineModel {
public:
    virtual void set_sender_baud(std::uint32_t baud) = 0;
    // A byte came before the last one was fetched: it is lost, and the flag stays until it is read away.
    virtual void overrun() = 0;
    // A damaged byte arrives, as when the cable is pulled.
    virtual void damage() = 0;
    // The cable is pulled: what was on its way does not arrive.
    virtual void unplug() = 0;
};

}  // namespace cusp::cosim
