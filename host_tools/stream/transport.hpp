// Transport: bytes to and from a controller, over whatever it is connected by.
#pragma once

#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace cusp::stream {

// The controller can't be reached any more. The text says how that showed.
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

    // Hands over as much as is taken at once. Returns how many bytes that was.
    virtual std::size_t write(std::string_view bytes) = 0;

    // What has arrived; waits for the first byte up to `timeout`.
    virtual std::string read(std::chrono::milliseconds timeout) = 0;
};

// Opens a port for this program alone.
//
//   port  "tcp:HOST:PORT"; a pseudo-terminal or a link to one; or a serial device
//   baud  of a serial device
//
// Throws InputError where it can't be opened.
std::unique_ptr<Transport> open_transport(const std::string& port, int baud);

}  // namespace cusp::stream
