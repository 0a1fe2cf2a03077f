// Non-blocking reads and writes.
#include "hal/posix/descriptor_link.hpp"

#include <cerrno>
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace cusp::hal {
namespace {

bool is_passing(int error) { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

// A write to a socket whose other end is gone must not raise SIGPIPE.
ssize_t write_quietly(int descriptor, const char* bytes, std::size_t size)
{
    const ssize_t sent = ::send(descriptor, bytes, size, MSG_NOSIGNAL);
    return sent < 0 && errno == ENOTSOCK ? ::write(descriptor, bytes, size) : sent;
}

}  // namespace

void Descriptor::close() noexcept
{
    if (number_ >= 0) {
        ::close(number_);
        number_ = -1;
    }
}

DescriptorLink::DescriptorLink(Descriptor descriptor) { connect(std::move(descriptor)); }

void DescriptorLink::connect(Descriptor descriptor)
{
    descriptor_ = std::move(descriptor);
    read_ = filled_ = scanned_ = 0;
    outgoing_.clear();
    lost_ = false;
    const int flags = ::fcntl(descriptor_.number(), F_GETFL);
    ::fcntl(descriptor_.number(), F_SETFL, flags | O_NONBLOCK);
}

void DescriptorLink::disconnect() noexcept
{
    descriptor_.close();
    read_ = filled_ = scanned_ = 0;
    outgoing_.clear();
    lost_ = true;
}

bool DescriptorLink::try_read(std::uint8_t& byte) noexcept
{
    if (read_ == filled_) {
        fill();
    }
    if (read_ == filled_) {
        return false;
    }
    byte = incoming_[read_];
    ++read_;
    return true;
}

bool DescriptorLink::try_scan(std::uint8_t& byte) noexcept
{
    scanned_ = scanned_ < read_ ? read_ : scanned_;
    if (scanned_ == filled_) {
        return false;
    }
    byte = incoming_[scanned_];
    ++scanned_;
    return true;
}

void DescriptorLink::fill() noexcept
{
    if (!descriptor_.is_open()) {
        return;
    }
    const ssize_t count = ::read(descriptor_.number(), incoming_.data(), incoming_.size());
    read_ = scanned_ = 0;
    filled_ = count > 0 ? static_cast<std::uint32_t>(count) : 0;
    if ((count == 0 || (count < 0 && !is_passing(errno))) && !survives_) {
        lost_ = true;
    }
}

std::uint32_t DescriptorLink::write_room() const noexcept
{
    return outgoing_.size() < kRoom ? kRoom - static_cast<std::uint32_t>(outgoing_.size()) : 0;
}

void DescriptorLink::write(Span<const std::uint8_t> bytes) noexcept
{
    CUSP_ASSERT(bytes.size() <= write_room());
    if (!descriptor_.is_open() || lost_) {
        return;
    }
    for (const std::uint8_t byte : bytes) {
        outgoing_.push_back(static_cast<char>(byte));
    }
    flush();
}

void DescriptorLink::flush() noexcept
{
    while (!outgoing_.empty() && descriptor_.is_open()) {
        const ssize_t sent =
            write_quietly(descriptor_.number(), outgoing_.data(), outgoing_.size());
        if (sent > 0) {
            outgoing_.erase(0, static_cast<std::size_t>(sent));
            continue;
        }
        if (sent < 0 && !is_passing(errno)) {
            outgoing_.clear();
            lost_ = lost_ || !survives_;
        }
        return;
    }
}

}  // namespace cusp::hal
