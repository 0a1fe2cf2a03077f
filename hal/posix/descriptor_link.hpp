// DescriptorLink: the serial line of a controller over a pseudo-terminal, a socket, a pipe or a
// file.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "hal/contract/board.hpp"
#include "hal/posix/descriptor.hpp"

namespace cusp::hal {

// The contract's ByteLink over a descriptor, which it makes non-blocking. Without a descriptor, or
// once the other end is gone, nothing is read and written bytes are dropped, as on an open
// line.
class DescriptorLink {
public:
    DescriptorLink() = default;
    explicit DescriptorLink(Descriptor descriptor);

    bool try_read(std::uint8_t& byte) noexcept;
    // Scans the bytes that a try_read() has brought in.
    bool try_scan(std::uint8_t& byte) noexcept;
    bool overrun() noexcept { return false; }  // the kernel holds the sender back
    std::uint32_t write_room() const noexcept;
    void write(Span<const std::uint8_t> bytes) noexcept;

    // Sends the bytes that the kernel did not take at once. write() does so as well.
    void flush() noexcept;

    // The other end hung up since the last connect(): for a socket or a file this is final.
    bool lost() const noexcept { return lost_; }
    int descriptor() const noexcept { return descriptor_.number(); }
    // Bytes wait to be flushed.
    bool pending() const noexcept { return !outgoing_.empty(); }

    void connect(Descriptor descriptor);
    void disconnect() noexcept;

    // True if a hang-up is final: not for the controller's end of a pseudo-terminal, where another
    // sender may open the other end.
    void survive_hang_up(bool survive) noexcept { survives_ = survive; }

private:
    static constexpr std::uint32_t kRoom = 16 * 1024;

    void fill() noexcept;

    Descriptor descriptor_;
    std::array<std::uint8_t, 4096> incoming_{};
    std::uint32_t read_{0};
    std::uint32_t filled_{0};
    std::uint32_t scanned_{0};
    std::string outgoing_;
    bool lost_{false};
    bool survives_{false};
};

static_assert(is_byte_link<DescriptorLink>());

}  // namespace cusp::hal
