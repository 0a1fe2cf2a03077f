// ReceivedBytes: a ring that an interrupt fills and the main loop reads, with the servo tick's scan ahead of it: the
// receiving half of a ByteLink (hal/contract/board.hpp).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "firmware/base/span.hpp"

namespace cusp::hal {

// `kSize` is a power of two.
template <std::uint32_t kSize>
class ReceivedBytes {
    static_assert((kSize & (kSize - 1)) == 0);

public:
    // Bytes that put() takes. Context: the interrupt.
    std::uint32_t room() const noexcept
    {
        return kSize -
               (head_.load(std::memory_order_relaxed) - read_.load(std::memory_order_acquire));
    }
    // Precondition: bytes.size() <= room(). Context: the interrupt.
    void put(Span<const std::uint8_t> bytes) noexcept
    {
        std::uint32_t head = head_.load(std::memory_order_relaxed);
        for (const std::uint8_t byte : bytes) {
            bytes_[head % kSize] = byte;
            ++head;
        }
        head_.store(head, std::memory_order_release);
    }

    // Everything was read.
    bool empty() const noexcept
    {
        return read_.load(std::memory_order_relaxed) == head_.load(std::memory_order_acquire);
    }
    bool try_read(std::uint8_t& byte) noexcept
    {
        if (empty()) {
            return false;
        }
        const std::uint32_t read = read_.load(std::memory_order_relaxed);
        byte = bytes_[read % kSize];
        read_.store(read + 1, std::memory_order_release);
        return true;
    }
    bool try_scan(std::uint8_t& byte) noexcept
    {
        const std::uint32_t read = read_.load(std::memory_order_relaxed);
        if (static_cast<std::int32_t>(read - scanned_) > 0) {
            scanned_ = read;
        }
        if (scanned_ == head_.load(std::memory_order_acquire)) {
            return false;
        }
        byte = bytes_[scanned_ % kSize];
        ++scanned_;
        return true;
    }

private:
    std::array<std::uint8_t, kSize> bytes_{};
    // These count bytes and wrap at 2^32.
    std::atomic<std::uint32_t> head_{0};  // by the interrupt
    std::atomic<std::uint32_t> read_{0};  // by the main loop
    std::uint32_t scanned_{0};            // by the servo tick
};

}  // namespace cusp::hal
