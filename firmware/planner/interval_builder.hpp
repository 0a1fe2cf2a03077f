// IntervalBuilder: turns speed limits along the path into limits along the *unfiltered* path.
//
// The interpolator plans speeds at a point that runs ahead of the tool by up to one path filter.
// For a limit V to hold where the tool is, it must hold over half a filter of travel, V filter/2,
// on either side: every limit is spread that far, back over intervals not yet published and forward
// over those to come. Proof: docs/numerics.md, "Spreading limits".
#pragma once

#include "firmware/base/static_vector.hpp"
#include "firmware/planner/corner_overlap.hpp"
#include "firmware/planner/junction.hpp"
#include "firmware/planner/path_queue.hpp"

namespace cusp::planner {

class IntervalBuilder {
public:
    explicit IntervalBuilder(PathQueue& queue) noexcept : queue_{queue} {}

    // Greatest travel times, s, over which limits, feeds and junctions are spread.
    struct Reach {
        float limit;
        float feed;
        float junction;
    };
    void set_reach(const Reach& reach) noexcept { reach_ = reach; }

    // Intervals that append() may need at most, splits included.
    static constexpr std::uint32_t kMostPerAppend = 12;

    // Adds a stretch at the end of the path.
    void append(std::uint32_t length, const Allowance& allowance, path::MoveKind kind) noexcept;

    // Spreads the limit of a junction, `distance` mm before the end of the path so far.
    void add_junction(const JunctionShare& junction, float distance) noexcept;

    // The path stops at its end: all of it may be published, and no limit is spread over the stop.
    void stop(const CornerOverlap& overlap) noexcept;

    // Publishes what no later limit can reach. If the queue is too short for that, slows the path
    // down until it is not.
    void publish(bool queue_full) noexcept;

    void clear() noexcept;

private:
    struct Carry {
        float distance;  // mm, still to come
        Allowance allowance;
        bool feed_alone;  // allows all but faster feeds
    };
    static constexpr std::uint32_t kCarries = 8;

    void restrict_end(std::uint32_t at, float reached, const Allowance& allowance) noexcept;
    template <class Binds>
    void spread_back(float distance, const Allowance& allowance, Binds binds_on) noexcept;
    void spread_back(float distance, const Allowance& allowance) noexcept;
    void spread_feed_back(float distance, float squared_feed) noexcept;
    void carry(float distance, const Allowance& allowance, bool feed_alone = false) noexcept;
    template <class Keep>
    void keep_carries(Keep keep) noexcept;
    void merge_closest_carries() noexcept;
    void travel(float distance) noexcept;
    void append_piece(std::uint32_t length,
                      const Allowance& allowance,
                      path::MoveKind kind) noexcept;
    void publish_to(std::uint32_t end) noexcept;
    void refresh_time(Interval& interval) noexcept;
    void restrict(Interval& interval, const Allowance& allowance) noexcept;

    PathQueue& queue_;
    Reach reach_{};
    StaticVector<Carry, kCarries> carries_;  // in rising order of distance
    float greatest_feed_{0};                 // squared; no interval not published has a greater one
    std::uint64_t pending_time_{0};          // of the intervals not published, units of 0.1 us
};

}  // namespace cusp::planner
