// EdgeMarks: which pulse ticks have edges, where it pays to know.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace cusp::pulse {

// Bits of the pulse ticks of a frame and of what hangs over it. Desktop processors take longer to
// guess which ticks have edges than to keep this; microcontrollers do not, and keep nothing.
template <bool kKept, std::size_t kTicks>
class EdgeMarks {
public:
    void mark(std::int32_t) noexcept {}
    template <class Act>
    void take(std::uint32_t, Act) noexcept
    {
    }
};

template <std::size_t kTicks>
class EdgeMarks<true, kTicks> {
public:
    // Precondition: 0 <= tick < kTicks.
    void mark(std::int32_t tick) noexcept
    {
        const auto at = static_cast<std::uint32_t>(tick);
        words_[at / kBits] |= std::uint64_t{1} << at % kBits;
    }

    // Calls act(tick) for all ticks marked below `end`, in their order, and forgets these; the later
    // ones become ticks from 0 on.
    template <class Act>
    void take(std::uint32_t end, Act act) noexcept
    {
        const std::uint32_t whole = end / kBits;
        const std::uint32_t part = end % kBits;
        for (std::uint32_t word = 0; word < whole; ++word) {
            take_word(word, words_[word], act);
        }
        if (part != 0) {
            take_word(whole, words_[whole] & ((std::uint64_t{1} << part) - 1), act);
        }
        for (std::uint32_t word = 0; word < words_.size(); ++word) {
            const std::uint64_t first = at(word + whole) >> part;
            words_[word] = part == 0 ? first : first | at(word + whole + 1) << (kBits - part);
        }
    }

private:
    static constexpr std::uint32_t kBits = 64;

    std::uint64_t at(std::uint32_t word) const noexcept
    {
        return word < words_.size() ? words_[word] : 0;
    }
    template <class Act>
    static void take_word(std::uint32_t word, std::uint64_t bits, Act act) noexcept
    {
        for (; bits != 0; bits &= bits - 1) {
            act(kBits * word + static_cast<std::uint32_t>(__builtin_ctzll(bits)));
        }
    }

    std::array<std::uint64_t, (kTicks + kBits - 1) / kBits> words_{};
};

}  // namespace cusp::pulse
