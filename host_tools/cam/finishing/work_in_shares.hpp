// Shares of work that several threads do, and that are divided where they turn out long.
//
//     const auto drops = work_in_shares(shares, [&](OpenShare& share) {
//         Search search{...};
//         search.begin_with(share.take_known());
//         while (const auto k = share.next()) {
//             search.look_at(*k);
//             if (search.took_long() && share.left() > 1) {
//                 share.give_half(search.drops());  // to another call of this, on any thread
//             }
//         }
//         return search.take_drops();
//     });
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "host_tools/cam/finishing/reachable_height.hpp"

namespace cusp::finishing {

using Share = std::vector<std::size_t>;

// A share under work.
class OpenShare {
public:
    using Give = std::function<void(Share half, ReachableHeight::Drops known)>;
    OpenShare(Share numbers, ReachableHeight::Drops known, Give give)
        : numbers_{std::move(numbers)}, known_{std::move(known)}, give_{std::move(give)}
    {
    }

    // The drops given with it.
    ReachableHeight::Drops take_known() { return std::move(known_); }
    // In the order of the share.
    std::optional<std::size_t> next();
    std::size_t left() const { return numbers_.size() - done_; }
    // The later half of what is left becomes a share of its own.
    void give_half(ReachableHeight::Drops known);

private:
    Share numbers_;
    ReachableHeight::Drops known_;
    Give give_;
    std::size_t done_{};
};

// Calls work() for each share and each half given, several at once: no thread has to wait long for
// the last one. Returns what these calls return; the order does not depend on the number of
// threads, if where a share is divided does not. If several bodies throw, it rethrows the first
// exception in that order.
std::vector<ReachableHeight::Drops> work_in_shares(
    const std::vector<Share>& shares,
    const std::function<ReachableHeight::Drops(OpenShare&)>& work);

}  // namespace cusp::finishing
