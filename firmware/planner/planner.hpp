// The planner: moves become blocks with geometry, speed limits and an always feasible way to stop.
//
// Main loop side: push() a Move where has_room() says that one is taken; close() when no further
// move is at hand; work() puts them on the path. The interpolator reads the queue from the servo tick;
// while it reads, speeds are only raised.
//
//   Move -> runs of short lines to arcs (line_smoother) -> corners to curves (corner_blender)
//        -> blocks (block_maker) -> junctions and limits (junction, speed_limit)
//        -> intervals (interval_builder) -> envelope (look_ahead)
#pragma once

#include <optional>

#include "firmware/base/axis.hpp"
#include "firmware/base/machine_limits.hpp"
#include "firmware/path/move.hpp"
#include "firmware/planner/block_maker.hpp"
#include "firmware/planner/corner_blender.hpp"
#include "firmware/planner/input_shaper.hpp"
#include "firmware/planner/interval_builder.hpp"
#include "firmware/planner/junction.hpp"
#include "firmware/planner/line_smoother.hpp"
#include "firmware/planner/path_queue.hpp"

namespace cusp::planner {

// Context: main loop.
class Planner {
public:
    // The queue must outlive the planner. It may lie in memory of its own: it is most of what the
    // firmware keeps, and no DMA reads it.
    Planner(PathQueue& queue, const MachineLimits& limits) noexcept : queue_{queue}, builder_{queue}
    {
        set_limits(limits);
    }
    Planner(const Planner&) = delete;
    Planner& operator=(const Planner&) = delete;

    // Precondition: empty().
    void set_limits(const MachineLimits& limits) noexcept;
    const MachineLimits& limits() const noexcept { return limits_; }

    // The input shaper behind the axis filters; none by default. The interpolator must be reset.
    // Precondition: empty(), shaper.ticks <= kMostShaperTicks.
    void set_shaper(const InputShaper& shaper) noexcept;
    const InputShaper& shaper() const noexcept { return shaper_; }

    // Discards all moves; the next starts at `at`. The interpolator must be reset with it.
    void reset(Position at) noexcept;

    // Works on the moves so far, as far as there is room for their blocks. `late`: the next move is
    // late, so if the path could end soon, the known part of a run of lines is planned instead of
    // waiting for longer arcs.
    void work(bool late = false) noexcept;

    // True if push() takes another move.
    bool has_room() const noexcept;

    // Takes a move for work(). Precondition: has_room(), and move.start == tail(). A move of no
    // length is dropped.
    void push(const path::Move& move) noexcept;

    // No move follows for now: work() ends the path in a stop.
    void close() noexcept;

    // True if every move is played to its end.
    bool empty() const noexcept;

    // End of the last pushed move.
    Position tail() const noexcept { return tail_; }

    std::uint32_t free_blocks() const noexcept { return queue_.free_blocks(); }

    PathQueue& queue() noexcept { return queue_; }

    // Length of the filter on the travel along the path, servo ticks.
    std::uint32_t path_filter() const noexcept { return path_filter_; }

private:
    struct FilterChoice {
        AxisFilter filter;
        float deviation;    // mm
        float centripetal;  // mm/s^2, most that leaves no more than the deviation
    };
    FilterChoice filter_for(float tolerance) const noexcept;
    float window_of(AxisFilter filter) const noexcept;
    void spread_bend(const Vec3f& curvature) noexcept;
    // The next stretch of the last block, and what it allows.
    struct StretchAhead {
        explicit StretchAhead(const Block& block) noexcept : reader{block, 0} {}
        StretchReader reader;
        Stretch stretch{};
        Allowance allowance{};
    };
    void go_on() noexcept;
    bool waits() const noexcept;
    bool path_is_short() const noexcept;
    bool next_move() noexcept;
    bool next_smoothed(path::Move& move) noexcept;
    void start() noexcept;
    void add_block(const Block& block) noexcept;
    void read_stretch() noexcept;
    void join(const EndGeometry& after,
              const Block& block,
              const Stretch& first,
              const Allowance& of_first) noexcept;
    Allowance allowance_of(const Block& block, const Stretch& part) const noexcept;
    void add_stretch() noexcept;
    JunctionShare share_of(const Junction& junction,
                           std::size_t earlier,
                           float distance,
                           float fastest) const noexcept;
    void add_recent(const Junction& junction, float speed) noexcept;
    void apply_junction_limits(const PathDerivatives& coming) noexcept;
    PathDerivatives bounds_behind(float distance) const noexcept;
    void age_bounds(const PathDerivatives& passed, float length) noexcept;
    void end_in_stop(const CornerOverlap& overlap) noexcept;
    CornerOverlap overlap_at_corner(const EndGeometry& after, const Block& block) const noexcept;

    struct RecentJunction {
        Junction junction;
        float speed;     // mm/s, that it may be passed at
        float distance;  // mm, back from the end of the path
    };
    static constexpr std::size_t kRecentJunctions = 16;
    // Bounds over a bent stretch of the path so far.
    struct RecentBend {
        PathDerivatives derivatives;
        float distance;  // mm, from its end to the end of the path
    };
    static constexpr std::size_t kRecentBends = 6;

    MachineLimits limits_{};
    InputShaper shaper_{};
    float greatest_acceleration_{1};  // of any axis
    float least_filter_{1};           // ticks of the first axis filter
    std::uint32_t path_filter_{1};
    PathQueue& queue_;
    IntervalBuilder builder_;
    BlockMaker maker_;
    Position tail_{};
    LineSmoother smoother_;
    CornerBlender blender_;
    path::Move move_{};                  // being cut into blocks
    FilterChoice choice_{};              // for it
    std::optional<path::Move> waiting_;  // until the run of lines before it is done
    bool close_requested_{false};
    bool flushing_{false};
    // Intervals of the last block: next to add, count, and the end of the last one, path units.
    std::uint8_t next_stretch_{0};
    std::uint8_t stretches_{0};
    std::uint32_t stretch_end_{0};
    // The next to add, where there is one: reckoned once, also where there is no room for it yet.
    std::optional<StretchAhead> ahead_;
    bool within_move_{false};  // a block of move_ is on the path
    // The moves so far make no further one, and all made are on the path: until another comes there is
    // nothing to do.
    bool starved_{false};
    // The end of the path so far, where it does not stop there.
    std::optional<EndGeometry> end_;
    AxisFilter end_filter_{};
    float end_length_{0};  // mm, without a junction
    float end_left_{0};    // mm, part of the tolerance not used by its path
    float end_speed_{0};   // mm/s, the most that its last stretch allows
    // Since the path stopped last, the newest at the back.
    StaticVector<RecentJunction, kRecentJunctions> junctions_;
    StaticVector<RecentBend, kRecentBends> bends_;
};

}  // namespace cusp::planner
