// Waiting, reading and writing on a descriptor.
#include "host_tools/controller/stream/descriptor_transport.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace cusp::stream {
namespace {

bool is_passing(int error) { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

[[noreturn]] void lose(int error)
{
    throw LinkLost{error == 0 ? std::string{"the other end closed the line"}
                              : std::string{"the line failed: "} + std::strerror(error)};
}

}  // namespace

DescriptorTransport::DescriptorTransport(hal::Descriptor descriptor)
    : descriptor_{std::move(descriptor)}
{
    const int flags = ::fcntl(descriptor_.number(), F_GETFL);
    ::fcntl(descriptor_.number(), F_SETFL, flags | O_NONBLOCK);
}

std::size_t DescriptorTransport::write(std::string_view bytes)
{
    ssize_t sent = ::send(descriptor_.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == ENOTSOCK) {
        sent = ::write(descriptor_.number(), bytes.data(), bytes.size());
    }
    if (sent < 0 && !is_passing(errno)) {
        lose(errno);
    }
    return sent < 0 ? 0 : static_cast<std::size_t>(sent);
}

std::string DescriptorTransport::read(std::chrono::milliseconds timeout)
{
    pollfd state{descriptor_.number(), POLLIN, 0};
    if (::poll(&state, 1, static_cast<int>(timeout.count())) <= 0) {
        return {};
    }
    std::array<char, 4096> bytes{};
    const ssize_t count = ::read(descriptor_.number(), bytes.data(), bytes.size());
    if (count > 0) {
        return {bytes.data(), static_cast<std::size_t>(count)};
    }
    if (count == 0 || !is_passing(errno)) {
        // A pseudo-terminal without its controller reads as EIO, or as nothing from then on.
        lose(count == 0 || errno == EIO ? 0 : errno);
    }
    return {};
}

}  // namespace cusp::stream
