// SerialTransport: a controller on a serial device, through libserialport.
#pragma once

#include <memory>

#include "host_tools/controller/stream/transport.hpp"

struct sp_port;

namespace cusp::stream {

class SerialTransport : public Transport {
public:
    // Eight bits, no parity, no flow control, DTR on, locked against other programs. Throws
    // InputError.
    SerialTransport(const std::string& device, int baud);

    std::size_t write(std::string_view bytes) override;
    std::string read(std::chrono::milliseconds timeout) override;

private:
    struct Closer {
        void operator()(sp_port* port) const;
    };
    std::unique_ptr<sp_port, Closer> port_;
    std::string device_;
};

}  // namespace cusp::stream
