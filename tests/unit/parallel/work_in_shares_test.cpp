// Shares that give halves away: each number once, the same order of what they return for any number of
// threads, the first exception.
#include "host_tools/cam/finishing/work_in_shares.hpp"

#include <numeric>
#include <stdexcept>
#include <string>

#include "host_tools/base/parallel/parallel.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::finishing;

namespace {

std::vector<Share> shares_of(std::size_t count, std::size_t each)
{
    std::vector<Share> out(count);
    for (std::size_t k = 0; k < count; ++k) {
        out[k].resize(each);
        std::iota(out[k].begin(), out[k].end(), k * each);
    }
    return out;
}

// A drop named after a number.
ReachableHeight::Drops drop_of(std::size_t k)
{
    ReachableHeight::Drops out;
    out.any[k] = {};
    return out;
}

}  // namespace

TEST_GROUP(WorkInShares){void teardown() override{parallel::set_threads(4);
}
}
;

TEST(WorkInShares, CallsEachNumberOnceAndReturnsInOneOrder)
{
    constexpr std::size_t kNumbers = 5 * 40;
    std::vector<std::uint64_t> order_before;
    for (const int threads : {1, 2, 4}) {
        parallel::set_threads(threads);
        std::vector<int> calls(kNumbers);
        std::vector<std::uint64_t> known(kNumbers, kNumbers);
        const auto drops = work_in_shares(shares_of(5, 40), [&](OpenShare& share) {
            const ReachableHeight::Drops begun = share.take_known();
            std::size_t first = kNumbers;
            std::size_t done = 0;
            while (const std::optional<std::size_t> k = share.next()) {
                if (done++ == 0) {
                    first = *k;
                    known[*k] = begun.any.empty() ? kNumbers : begun.any.begin()->first;
                }
                ++calls[*k];
                // The third share is long.
                if (*k / 40 == 2 && done % 4 == 0 && share.left() > 1) {
                    share.give_half(drop_of(first));
                }
            }
            return drop_of(first);
        });
        CHECK(calls == std::vector<int>(kNumbers, 1));
        std::vector<std::uint64_t> order;
        for (const ReachableHeight::Drops& some : drops) {
            LONGS_EQUAL(1, some.any.size());
            order.push_back(some.any.begin()->first);
        }
        CHECK(order.size() > 8);
        CHECK(order_before.empty() || order == order_before);
        order_before = order;
        // 80 to 83 are done, then the later half of 84 to 119 is given.
        LONGS_EQUAL(80, known[102]);
        LONGS_EQUAL(kNumbers, known[80]);
    }
}

TEST(WorkInShares, ThrowsTheFirstExceptionInTheOrderOfTheShares)
{
    for (const int threads : {1, 2, 4}) {
        parallel::set_threads(threads);
        std::string said;
        try {
            work_in_shares(shares_of(6, 10), [](OpenShare& share) {
                while (const std::optional<std::size_t> k = share.next()) {
                    if (*k % 10 == 5 && *k > 20) {
                        throw std::runtime_error(std::to_string(*k));
                    }
                }
                return ReachableHeight::Drops{};
            });
        } catch (const std::runtime_error& error) {
            said = error.what();
        }
        STRCMP_EQUAL("25", said.c_str());
    }
}
