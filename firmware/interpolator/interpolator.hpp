// The interpolator: the path ahead becomes one set point a servo tick.
//
//   own time of the plan: slower for a hold or an override (time_warp)
//   travel along the path by the plan (law_player)
//   position on the block
//   axis filters: two short moving averages an axis, for jumps of direction and curvature
//   input shaper: against vibration, where the settings ask for it
//
// Fixed work a tick, integers and float only.
#pragma once

#include "firmware/base/static_vector.hpp"
#include "firmware/interpolator/box_filter.hpp"
#include "firmware/interpolator/law_player.hpp"
#include "firmware/interpolator/shaper_filter.hpp"
#include "firmware/interpolator/time_warp.hpp"
#include "firmware/planner/planner.hpp"

namespace cusp::interpolator {

// Context: servo tick, but for reset(), set_... and hold(), resume(): main loop, any time (reset:
// at rest only).
class Interpolator {
public:
    explicit Interpolator(planner::Planner& planner) noexcept;
    Interpolator(const Interpolator&) = delete;
    Interpolator& operator=(const Interpolator&) = delete;

    // Starts at rest at `at`, filters empty, the shaper that of the planner. The planner must have
    // been reset with it.
    void reset(Position at) noexcept;

    // The next set point, machine nanometres.
    Position tick() noexcept;

    // True if nothing moves: all filters are empty.
    bool at_rest() const noexcept { return at_rest_; }

    // Feed hold: slows down on the path to a stop; at_rest() is true when it is complete.
    void hold() noexcept { holding_ = true; }
    void resume() noexcept { holding_ = false; }
    bool holding() const noexcept { return holding_; }
    // The same, as long as the servo tick says so. Context: servo tick.
    void brake(bool on) noexcept { braking_ = on; }

    // Per cent of the programmed feed, 10 to 200, and of rapids, 25 to 100.
    void set_feed_override(unsigned percent) noexcept;
    void set_rapid_override(unsigned percent) noexcept;

    // Line of the program that the tool is on; the last one while it rests at an end.
    std::uint32_t executing_line() const noexcept { return line_; }

    // The power of the move that executing_line() names; set points reach that move smoothing_ticks() later.
    path::LaserPower power() const noexcept { return power_; }
    unsigned smoothing_ticks() const noexcept
    {
        return (axis_filter_.first + axis_filter_.second - 1U) / 2U + shaper_ticks_;
    }

    // Speed along the path in this tick, mm/s.
    float speed() const noexcept;

    Position position() const noexcept { return position_; }

    // Path ahead that is planned for sure, mm: where this is short and nothing is to come, the planner
    // should be closed. Context: main loop.
    float path_ahead() const noexcept { return queue_.plans().certain_way().length; }

private:
    static constexpr std::uint32_t kMaxAxisFilter =
        22;  // of the first; the second is one or two ticks long
    static constexpr std::uint32_t kMaxSecondFilter = 2;
    // Both sum up steps of at most 2000 mm/s.
    static_assert(kMaxAxisFilter * kMaxSecondFilter * 2000.0F * kPathUnitsPerTick < 2147483648.0F);

    // A stretch of path from stop to stop that is played. Two overlap at a corner that may be cut.
    struct Track {
        LawPlayer player;
        std::uint32_t block{0};   // that the tool is on, as counted by the queue
        std::uint32_t offset{0};  // path units into it
        PathOffset place{};       // relative to its start
        bool at_stop{false};      // that block begins the next stretch
    };
    void set_axis_filter(planner::AxisFilter filter) noexcept;
    float own_time() noexcept;
    float rate_of(const planner::LawCell& cell) const noexcept;
    void look_ahead() noexcept;
    void add_start(const WarpBounds& rest, float whole) noexcept;
    void add_ahead(const planner::LawCell& cell, const WarpBounds& bounds) noexcept;
    PathOffset play(float time) noexcept;
    bool begin_next() noexcept;
    void begin_cell(const planner::LawCell& next, const planner::PackedBounds& bounds) noexcept;
    // The cell that the leading track plays, or has played last.
    const planner::LawCell& cell() const noexcept { return leading_->player.cell(); }
    float time_to_next() noexcept;
    void change_track() noexcept;
    PathOffset travel(Track& track, std::uint32_t along) noexcept;
    PathOffset pass_blocks(Track& track, std::uint32_t offset) noexcept;
    bool filters_drained() const noexcept;
    bool takes_filter_of(std::uint32_t block) noexcept;
    bool find_next(std::uint32_t& block) const noexcept;
    void drop_passed_blocks() noexcept;
    // Between two cells the tool moves, too.
    bool moves() const noexcept
    {
        return !leading_->player.needs_cell() || !trailing_->player.needs_cell() ||
               cell().piece != planner::LawPiece::kStop;
    }

    planner::Planner& planner_;
    planner::PathQueue& queue_;
    Track* leading_{nullptr};  // of tracks_
    Track* trailing_{nullptr};
    std::array<float, path::kMoveKinds> overrides_{1, 1, 1};  // by kind
    Position position_{};
    PerAxis<ExactDivision> axis_division_{};
    std::int32_t along_{0};  // path units travelled in this tick
    std::uint32_t line_{0};
    unsigned shaper_ticks_{0};  // half the length of the shaper's response
    path::LaserPower power_;
    planner::AxisFilter axis_filter_{};
    bool holding_{false};
    bool braking_{false};
    bool at_rest_{true};
    bool slowed_{false};  // by an override
    bool passed_{false};  // a block, in this tick
    RunningSum<PathOffset, kMaxSecondFilter> second_;
    RunningSum<PathOffset, kMaxAxisFilter> first_;
    TimeWarp warp_;
    // The plan ahead, in pieces of a tick or more, and what is known of the last of them.
    static constexpr std::size_t kMostAhead = 32;
    StaticVector<WarpBounds, kMostAhead> ahead_;
    planner::PackedBounds before_{};   // of the cell before the one that is played
    planner::PackedBounds playing_{};  // of that
    planner::PackedBounds trailing_bounds_{};
    float least_rate_{1};  // wanted ahead
    // Then what is large: what the tick reads above stays within reach of an offset.
    std::array<Track, 2> tracks_;
    ShaperFilter shaper_;
};

}  // namespace cusp::interpolator
