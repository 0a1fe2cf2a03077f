// Splits the columns of a grid into bands for several threads.
#pragma once

#include <cstddef>

#include "host_tools/base/parallel/parallel.hpp"

namespace cusp::verify {

// Fixed, whatever the number of threads: results of a band may depend on where it begins.
inline constexpr std::size_t kBands = 8;

// Calls work(begin, end, number of the band) for disjoint ranges that cover [0, count), several at
// once.
template <class Work>
void for_each_band(std::size_t count, const Work& work)
{
    parallel::for_each(
        kBands, [&](std::size_t k) { work(count * k / kBands, count * (k + 1) / kBands, k); });
}

}  // namespace cusp::verify
