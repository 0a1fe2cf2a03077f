// Opens serial lines: new pseudo-terminals, TCP sockets, existing terminals and
// sockets.
//
// Errors are std::system_error whose text names the place.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/posix/descriptor.hpp"

namespace cusp::hal {

// The controller's end of a new pseudo-terminal, raw, with a symbolic link to the other end, which
// senders open as a serial port. The link is removed with it.
class PseudoTerminal {
public:
    //   link  replaced where it is a symbolic link already; anything else there is an error
    explicit PseudoTerminal(const std::string& link);
    PseudoTerminal(const PseudoTerminal&) = delete;
    PseudoTerminal& operator=(const PseudoTerminal&) = delete;
    ~PseudoTerminal();

    // A descriptor of the controller's end.
    Descriptor open_controller_end() const;
    // True if any process has the other end open.
    bool has_peer() const noexcept;
    const std::string& name() const noexcept { return name_; }

private:
    Descriptor master_;
    std::string link_;
    std::string name_;
};

struct TcpAddress {
    std::string host;
    std::string port;
};

// "HOST:PORT", "[IPV6]:PORT" or ":PORT" for all interfaces; none where it is no such thing.
std::optional<TcpAddress> parse_tcp_address(std::string_view text);

// Listens for one sender at a time.
class TcpListener {
public:
    explicit TcpListener(const TcpAddress& address);

    // The next sender, or a closed descriptor where none waits. Does not block.
    Descriptor accept_waiting() const;
    int descriptor() const noexcept { return socket_.number(); }
    // The port in use; the system chooses it where 0 was requested.
    std::uint16_t port() const;

private:
    Descriptor socket_;
};

Descriptor connect_tcp(const TcpAddress& address);

// The sender's end of a pseudo-terminal, or any terminal: raw, eight bits, nobody else's. The lock
// is flock(), and TIOCEXCL where it is no pseudo-terminal.
Descriptor open_terminal(const std::string& name);

}  // namespace cusp::hal
