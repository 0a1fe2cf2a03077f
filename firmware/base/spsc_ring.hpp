// SpscRing<T, N>: a queue between one producer and one consumer, an interrupt on either side.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace cusp {

// Context: push from one context, pop from one other; neither waits.
template <class T, std::uint32_t N>
class SpscRing {
    static_assert(N != 0 && (N & (N - 1)) == 0, "the size of a ring is a power of two");

public:
    static constexpr std::uint32_t capacity() noexcept { return N; }

    // False, and nothing added, where it is full.
    bool try_push(const T& value) noexcept
    {
        const std::uint32_t head = head_.load(std::memory_order_relaxed);
        if (head - tail_.load(std::memory_order_acquire) == N) {
            return false;
        }
        elements_[head & (N - 1)] = value;
        head_.store(head + 1, std::memory_order_release);
        return true;
    }

    // False, and nothing written, where it is empty.
    bool try_pop(T& value) noexcept
    {
        const std::uint32_t tail = tail_.load(std::memory_order_relaxed);
        if (tail == head_.load(std::memory_order_acquire)) {
            return false;
        }
        value = elements_[tail & (N - 1)];
        tail_.store(tail + 1, std::memory_order_release);
        return true;
    }

    // The element at `place`, which counts all that were pushed, or the oldest one left where that is
    // gone; moves the place past it. False where there is none. Context: one that may interrupt the
    // consumer, never the other way round.
    bool try_peek(std::uint32_t& place, T& value) const noexcept
    {
        const std::uint32_t tail = tail_.load(std::memory_order_relaxed);
        place = static_cast<std::int32_t>(tail - place) > 0 ? tail : place;
        if (place == head_.load(std::memory_order_acquire)) {
            return false;
        }
        value = elements_[place & (N - 1)];
        ++place;
        return true;
    }

    std::uint32_t size() const noexcept
    {
        return head_.load(std::memory_order_acquire) - tail_.load(std::memory_order_acquire);
    }
    bool empty() const noexcept { return size() == 0; }

    // Context: consumer.
    void clear() noexcept
    {
        tail_.store(head_.load(std::memory_order_acquire), std::memory_order_release);
    }

private:
    std::array<T, N> elements_{};
    std::atomic<std::uint32_t> head_{0};
    std::atomic<std::uint32_t> tail_{0};
};

}  // namespace cusp
