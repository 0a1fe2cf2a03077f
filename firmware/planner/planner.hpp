// The planner: moves become blocks with geometry, speed limits and an always feasible way to stop.
//
// Main loop side: push() a Move where has_room() says that one is taken; close() when no further
// move is at hand; work() puts them on the path. The interpolator reads the queue from the servo tick;
// while it reads, only more is planned.
//
//   Move -> runs of short lines to arcs (line_smoother) -> corners to curves (corner_blender)
//        -> blocks (block_maker) -> stretches from stop to stop -> plans (stretch_planner)
#pragma once

#include <optional>

#include "firmware/base/axis.hpp"
#include "firmware/base/machine_limits.hpp"
#include "firmware/path/move.hpp"
#include "firmware/planner/block_maker.hpp"
#include "firmware/planner/corner_blender.hpp"
#include "firmware/planner/corner_overlap.hpp"
#include "firmware/planner/input_shaper.hpp"
#include "firmware/planner/line_smoother.hpp"
#include "firmware/planner/path_queue.hpp"
#include "firmware/planner/stretch_planner.hpp"

namespace cusp::planner {

// Context: main loop.
class Planner {
public:
    // The queue must outlive the planner. It may lie in memory of its own: it is most of what the
    // firmware keeps, and no DMA reads it.
    Planner(PathQueue& queue, const MachineLimits& limits) noexcept : queue_{queue}, law_{queue}
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
    // waiting for longer arcs. A bounded step: false once nothing is to do without news.
    bool work(bool late = false) noexcept;

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

    // Per cent of the programmed feed; what is planned already keeps its own.
    void set_feed_override(unsigned percent) noexcept { law_.set_percent(percent); }

private:
    struct FilterChoice {
        AxisFilter filter;
        float departure;    // mm, left to the path
        float centripetal;  // mm/s^2, the most at which the filters leave the path by their part
    };
    FilterChoice filter_for(float tolerance) const noexcept;
    bool go_on() noexcept;
    bool path_is_short() const noexcept;
    bool next_move() noexcept;
    bool next_smoothed(path::Move& move) noexcept;
    void start() noexcept;
    void add_block(Block& block) noexcept;
    void join(const EndGeometry& after, const Block& block) noexcept;
    bool must_stop(const EndGeometry& after, const Block& block) const noexcept;
    CornerOverlap overlap_at_corner(const EndGeometry& after, const Block& block) const noexcept;
    void end_in_stop(const CornerOverlap& overlap) noexcept;

    MachineLimits limits_{};
    InputShaper shaper_{};
    float greatest_acceleration_{1};  // of any axis
    float whole_acceleration_{1};     // of all together
    float least_filter_{1};           // ticks of the first axis filter
    PathQueue& queue_;
    StretchPlanner law_;
    BlockMaker maker_;
    Position tail_{};
    LineSmoother smoother_;
    CornerBlender blender_;
    path::Move move_{};                  // being cut into blocks
    FilterChoice choice_{};              // for it
    std::optional<path::Move> waiting_;  // until the run of lines before it is done
    bool close_requested_{false};
    bool flushing_{false};
    bool within_move_{false};  // a block of move_ is on the path
    // The end of the path so far, where it does not stop there.
    std::optional<EndGeometry> end_;
    float end_length_{0};  // mm, from the last stop
    float end_deviation_{
        0};  // mm, that is left to a corner there, the path's own departure included
    float end_departure_{0};  // mm
    path::PathLean end_lean_{};
};

}  // namespace cusp::planner
