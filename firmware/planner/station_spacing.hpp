// StationSpacing: where the stations of a stretch of path stand: as far apart as the tool is
// expected to travel in a given time, closer near stops, and where feed or curvature jumps.
//
// The speed expected is a forward and a backward pass over bounds of the path's spans, with worst
// signs. It decides about the spacing alone; no limit rests on it. Stations depend on the path, never on
// how much of it was known when they were asked for.
// Source: docs/numerics.md, "The time law". Held by tests/unit/planner/station_spacing_test.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "firmware/base/static_vector.hpp"
#include "firmware/planner/station_maker.hpp"

namespace cusp::planner {

inline constexpr float kTinyBound = 1e-20F;
inline constexpr float kNegligibleTurn = 1e-5F;  // |dP/ds|

// Context: main loop.
class StationSpacing {
public:
    // The path must outlive it.
    explicit StationSpacing(LawPath& path) noexcept : path_{path} {}

    // `station_time`, s: in which a station is to be passed.
    void set_limits(const MachineLimits& limits, float station_time) noexcept;

    void set_shaper(const InputShaper& shaper) noexcept { maker_.set_shaper(shaper); }

    // From a place of rest on: that at which the path begins, or where a plan came to rest.
    //
    //   cursor  the block of the place.
    //   place   path units from the start of the stretch.
    void begin(const StopChoice& start, const PathCursor& cursor, std::int64_t place) noexcept;
    // How it ends. To be set before the path is closed.
    void set_stop(const StopChoice& stop) noexcept;

    // The element that the stretch starts with. False: more of the path is needed.
    bool start(StopElement& element) noexcept;

    // The next station. False: more of the path is needed, or finished().
    bool next(Station& station) noexcept;

    bool finished() const noexcept { return finished_; }
    // Precondition: finished().
    const StopElement& stop() const noexcept { return stop_; }

private:
    // A piece of path with constant bounds.
    struct PathSpan {
        std::int64_t begin;  // path units from the start of the stretch
        float length;        // mm
        float cap;           // squared speed
        float brake;         // mm/s^2, along the path
        float forward;       // squared speed at its start, from the stretch's start
        float expected;      // and from both sides
        bool is_mark;        // feed or curvature jumps at its start
        bool is_tentative;   // the end of the known path lowers it
    };
    // Turns so near to each other that they count as one.
    struct TurnGroup {
        std::int64_t first;  // path units from the start of the stretch
        std::int64_t last;
        float turned;  // sum of their |dP/ds|
    };
    static constexpr std::uint32_t kSpans = 128;
    static constexpr std::size_t kTurnGroups = 12;

    PathSpan& span(std::uint32_t i) noexcept { return spans_[i % kSpans]; }
    const PathSpan& span(std::uint32_t i) const noexcept { return spans_[i % kSpans]; }
    void read_spans() noexcept;
    bool read_one() noexcept;
    bool may_grow() const noexcept;
    void add_span(const Stretch& stretch, std::int64_t begin, const LawBlock& block) noexcept;
    void read_joint(const PathCursor& before) noexcept;
    void add_turn(std::int64_t at, float turned, float window) noexcept;
    float turned_near(std::int64_t at, float way) const noexcept;
    float speed_through(const ReadJoint& joint, float speed, float second) const noexcept;
    void collect_joints(std::int64_t until) noexcept;
    void collect_joints_of_block() noexcept;
    void add_joint(const LawJoint& joint) noexcept;
    void merge_nearest_joints() noexcept;
    void pass_backward() noexcept;
    void settle_stop() noexcept;
    float expected_at(std::int64_t at) const noexcept;
    float wanted_at(std::int64_t at) const noexcept;
    std::int64_t choose_end() const noexcept;
    bool knows_all() const noexcept;
    bool knows_enough() const noexcept;
    bool knows_next() const noexcept;
    bool knows_start() const noexcept;
    std::int64_t read_to() const noexcept { return read_.begin + read_offset_; }
    float reach_of_joints(float speed) const noexcept;
    void drop_joints() noexcept;

    LawPath& path_;
    StationMaker maker_;
    MachineLimits limits_{};
    float station_time_{0};
    float longest_{0};  // s, greatest a/j
    StopChoice start_choice_{};
    StopChoice stop_choice_{};
    StopElement start_{};
    StopElement stop_{};
    float start_jerk_{0};  // mm/s^3, along the path
    float stop_jerk_{0};
    std::array<PathSpan, kSpans> spans_{};
    std::uint32_t span_begin_{0};
    std::uint32_t span_end_{0};
    StaticVector<LawJoint, kMostJoints> joints_;  // around the next station
    PathCursor collected_{};                      // the block whose joints come next
    StaticVector<TurnGroup, kTurnGroups> turns_;  // the last ones that were read
    // The place on the path that is read next.
    PathCursor read_{};
    std::uint8_t read_stretch_{0};
    std::uint32_t read_offset_{0};  // path units into the block
    // Where the next station begins.
    PathCursor cursor_{};
    std::int64_t at_{0};
    std::int64_t rest_{0};       // where it began
    std::int64_t inner_end_{0};  // of the stop element at the end, once it is settled
    float last_{0};              // mm, length of the last cell
    bool mark_next_{false};      // the next span begins at a mark
    float entry_{kUnlimited};    // greatest squared speed at its start, by the joint there
    bool started_{false};
    bool stop_settled_{false};
    bool finished_{false};
};

}  // namespace cusp::planner
