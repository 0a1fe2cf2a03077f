// Connection of senders, one at a time.
#include "host_tools/controller/simulate/serial_end.hpp"

#include <algorithm>
#include <system_error>

#include "host_tools/base/input_error/input_error.hpp"

namespace cusp::simulate {
namespace {

// Output beyond this is lost if nobody reads it, as on a serial line.
constexpr std::size_t kMostWaiting = 1 << 20;

}  // namespace

SerialEnd::SerialEnd(const std::string& pty_link) : pty_link_{pty_link}
{
    link_.survive_hang_up(true);
    plug();
}

SerialEnd::SerialEnd(const hal::TcpAddress& address)
try : listener_{address} {
} catch (const std::system_error& error) {
    throw InputError{"can't listen on " + std::string{error.what()}};
}

void SerialEnd::plug()
{
    plugged_ = true;
    if (pty_link_.empty() || terminal_) {
        return;
    }
    try {
        terminal_.emplace(pty_link_);
    } catch (const std::system_error& error) {
        throw InputError{"can't make a pseudo-terminal at " + std::string{error.what()}};
    }
    link_.connect(terminal_->open_controller_end());
}

void SerialEnd::unplug()
{
    plugged_ = false;
    has_peer_ = false;
    waiting_.clear();
    link_.disconnect();
    terminal_.reset();
}

bool SerialEnd::update_peer()
{
    if (!plugged_) {
        return false;
    }
    const bool had_peer = has_peer_;
    if (terminal_) {
        has_peer_ = terminal_->has_peer();
    } else {
        if (link_.lost() || link_.descriptor() < 0) {
            has_peer_ = false;
            link_.disconnect();
        }
        return accept_sender();
    }
    if (!has_peer_) {
        waiting_.clear();
    }
    return has_peer_ && !had_peer;
}

// A sender may reconnect before its hang-up is detected, so a new connection waits a little. A
// second sender is refused.
bool SerialEnd::accept_sender()
{
    constexpr unsigned kPatience = 200;  // calls of update_peer()
    hal::Descriptor sender = listener_->accept_waiting();
    if (sender.is_open()) {
        next_ = std::move(sender);
        next_waits_ = 0;
    }
    if (!has_peer_) {
        waiting_.clear();
    }
    if (next_.is_open() && !has_peer_) {
        link_.connect(std::move(next_));
        next_ = {};
        has_peer_ = true;
        return true;
    }
    if (next_.is_open() && ++next_waits_ > kPatience) {
        next_ = {};
    }
    return false;
}

std::string SerialEnd::read()
{
    std::string bytes;
    std::uint8_t byte = 0;
    while (link_.try_read(byte)) {
        bytes.push_back(static_cast<char>(byte));
    }
    return bytes;
}

void SerialEnd::write(const std::string& bytes)
{
    if (!has_peer_) {
        return;
    }
    waiting_ += bytes;
    if (waiting_.size() > kMostWaiting) {
        waiting_.clear();
    }
    link_.flush();
    const std::size_t count = std::min<std::size_t>(waiting_.size(), link_.write_room());
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): text as bytes.
    const auto* data = reinterpret_cast<const std::uint8_t*>(waiting_.data());
    link_.write(Span<const std::uint8_t>{data, count});
    waiting_.erase(0, count);
}

int SerialEnd::descriptor() const
{
    if (listener_ && !has_peer_) {
        return listener_->descriptor();
    }
    // Without a sender the controller's end of a terminal always reads as hung up.
    return has_peer_ ? link_.descriptor() : -1;
}

std::string SerialEnd::name() const
{
    return listener_ ? "port " + std::to_string(listener_->port()) : pty_link_;
}

}  // namespace cusp::simulate
