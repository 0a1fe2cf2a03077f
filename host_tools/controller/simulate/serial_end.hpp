// SerialEnd: the virtual controller's end of its line: a pseudo-terminal or a TCP port that senders
// open and close.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hal/posix/descriptor_link.hpp"
#include "hal/posix/endpoints.hpp"

namespace cusp::simulate {

class SerialEnd {
public:
    // Throws InputError if the port cannot be opened.
    explicit SerialEnd(const std::string& pty_link);
    explicit SerialEnd(const hal::TcpAddress& address);

    // Updates whether a sender is connected. Returns whether one has just connected.
    bool update_peer();
    bool has_peer() const { return has_peer_; }

    // Bytes received since the last call.
    std::string read();
    // Sends as much as is accepted; keeps the rest for the next call.
    void write(const std::string& bytes);

    // Removes the connection (the terminal, the socket), and restores it.
    void unplug();
    void plug();

    // To wait on; -1 if there is nothing to wait for.
    int descriptor() const;
    // The name that a sender opens.
    std::string name() const;

private:
    bool accept_sender();

    std::string pty_link_;
    std::optional<hal::PseudoTerminal> terminal_;
    std::optional<hal::TcpListener> listener_;
    hal::Descriptor next_;  // a sender that connected while there is one
    unsigned next_waits_{0};
    hal::DescriptorLink link_;
    std::string waiting_;
    bool has_peer_{false};
    bool plugged_{true};
};

}  // namespace cusp::simulate
