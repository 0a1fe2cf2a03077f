// A rolling hash of stretches, and the last tick at which each occurred.
#include "host_tools/judge/view/repetition_search.hpp"

#include <algorithm>

namespace cusp::view {

void RepetitionSearch::add(const std::array<std::uint64_t, kLinearAxes>& differences)
{
    Differences kept{};
    for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
        kept[axis] = static_cast<std::uint32_t>(std::min<std::uint64_t>(differences[axis], kHuge));
    }
    ticks_.push_back(kept);
}

bool RepetitionSearch::equal(std::size_t a, std::size_t b) const
{
    const Differences& at = ticks_[a];
    return at == ticks_[b] && std::find(at.begin(), at.end(), kHuge) == at.end();
}

std::vector<std::uint64_t> RepetitionSearch::hashes(std::size_t begin, std::size_t end) const
{
    constexpr std::uint64_t kBase = 0xD6E8FEB86659FD93U;
    const auto mixed = [this](std::size_t tick) {
        std::uint64_t sum = 0;
        for (const std::uint32_t difference : ticks_[tick]) {
            sum = (sum + difference) * 0xBF58476D1CE4E5B9U;
        }
        return sum;
    };
    std::uint64_t first_factor = 1;
    for (std::size_t k = 0; k < kShortest; ++k) {
        first_factor *= kBase;
    }
    std::vector<std::uint64_t> out;
    std::uint64_t hash = 0;
    for (std::size_t tick = begin; tick < end; ++tick) {
        hash = hash * kBase + mixed(tick);
        if (tick >= begin + kShortest) {
            hash -= first_factor * mixed(tick - kShortest);
        }
        if (tick + 1 >= begin + kShortest) {
            out.push_back(hash);
        }
    }
    return out;
}

std::vector<Repetition> RepetitionSearch::find(std::size_t begin, std::size_t end)
{
    const std::vector<std::uint64_t> hash_at = hashes(begin, end);
    std::vector<Repetition> found;
    std::size_t free_from = begin;  // end of the last repetition
    std::size_t tick = begin;
    const auto remember = [&](std::size_t from, std::size_t to) {
        for (std::size_t k = from; k < to && k - begin < hash_at.size(); ++k) {
            if (k % kStep == 0) {
                place_of(hash_at[k - begin]) = static_cast<std::uint32_t>(k);
            }
        }
    };
    while (tick - begin < hash_at.size()) {
        const std::size_t before = place_of(hash_at[tick - begin]);
        std::size_t count = 0;
        while (before != kNowhere && tick + count < end && equal(tick + count, before + count)) {
            ++count;
        }
        if (count < kShortest) {
            remember(tick, tick + 1);
            ++tick;
            continue;
        }
        const std::size_t distance = tick - before;
        std::size_t first = tick;
        while (first > free_from && first > distance && equal(first - 1, first - 1 - distance)) {
            --first;
        }
        found.push_back({first, tick + count - first, distance});
        remember(tick, tick + count);
        tick += count;
        free_from = tick;
    }
    return found;
}

}  // namespace cusp::view
