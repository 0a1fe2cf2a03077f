// Transport: bytes to and from a controller, over any kind of connection.
#pragma once

#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace cusp::stream {

// The controller can no longer be reached. The text names the failure.
class LinkLost : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// Errors: read() and write() throw LinkLost.
class Transport {
public:
    Transport() = default;
    Transport(const Transport&) = delete;
    Transport& operator=(const Transport&) = delete;
    virtual ~Transport() = default;

    // Writes as many bytes as are accepted at once. Returns their number.
    virtual std::size_t write(std::string_view bytes) = 0;

    // Bytes that have arrived; waits for the first one up to `timeout`.
    virtual std::string read(std::chrono::milliseconds timeout) = 0;
};

// Opens a port exclusively.
//
// port  "tcp:HOST:PORT"; "usb:NAME", as pick_usb_port() has it; a pseudo-terminal or a link to one;
//       or a serial device
// baud  of a serial device
//
// Errors: InputError if it cannot be opened.
std::unique_ptr<Transport> open_transport(const std::string& port, int baud);

}  // namespace cusp::stream
