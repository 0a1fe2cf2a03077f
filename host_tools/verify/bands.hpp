// Splits the columns of a grid among the processor's cores.
#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>
#include <vector>

namespace cusp::verify {

// Calls work(begin, end, number of the band) for disjoint ranges that cover [0, count), each in a
// thread of its own. `work` must not throw.
template <class Work>
void for_each_band(std::size_t count, Work work)
{
    const std::size_t bands = std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1,
                                                      std::max<std::size_t>(1, count));
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < bands; ++k) {
        threads.emplace_back(work, count * k / bands, count * (k + 1) / bands, k);
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
}

inline std::size_t band_count(std::size_t count)
{
    return std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1,
                                   std::max<std::size_t>(1, count));
}

}  // namespace cusp::verify
