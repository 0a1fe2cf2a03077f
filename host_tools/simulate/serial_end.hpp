// SerialEnd: the virtual controller's end of its line, whoever is at the other: a pseudo-terminal
// or a TCP port that senders come to and leave.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hal/posix/descriptor_link.hpp"
#include "hal/posix/endpoints.hpp"

namespace cusp::simulate {

class SerialEnd {
public:
    // Throws InputError where the place can't be opened.
    explicit SerialEnd(const std::string& pty_link);
    explicit SerialEnd(const hal::TcpAddress& address);

    // Looks who came and who left. Returns whether somebody has just come.
    bool look();
    bool has_peer() const { return has_peer_; }

    // What arrived since.
    std::string read();
    // Hands on as much as is taken; keeps the rest for the next time.
    void write(const std::string& bytes);

    // Pulls the plug: the terminal is gone, the socket closed; and puts it back.
    void unplug();
    void plug();

    // To wait on; -1 where there is nothing to wait for.
    int descriptor() const;
    // What a sender opens.
    std::string name() const;

private:
    bool accept_sender();

    std::string pty_link_;
    std::optional<hal::PseudoTerminal> terminal_;
    std::optional<hal::TcpListener> listener_;
    hal::Descriptor next_;  // a sender that came while there is one
    unsigned next_looks_{0};
    hal::DescriptorLink link_;
    std::string waiting_;
    bool has_peer_{false};
    bool plugged_{true};
};

}  // namespace cusp::simulate
