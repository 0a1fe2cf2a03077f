// Stations from the path: rows at three places of a cell, and what is kept for all between.
#pragma once

#include "firmware/base/machine_limits.hpp"
#include "firmware/base/span.hpp"
#include "firmware/base/static_vector.hpp"
#include "firmware/planner/input_shaper.hpp"
#include "firmware/planner/law_path.hpp"
#include "firmware/planner/station.hpp"

namespace cusp::planner {

// A joint of two blocks, or several, as the axis filters feel it: shares of the axes' limits.
struct LawJoint {
    std::int64_t first;         // path units from the start of the stretch
    std::int64_t at;            // the last of them
    LaneVec always;             // of the jerk
    LaneVec jump;               // of the jerk, times v^2, with its sign
    LaneVec loose;              // the same of several, whose signs are not known
    LaneVec turn;               // of the jerk, times v
    LaneVec turn_acceleration;  // of the acceleration, times v
    float window;               // s, of the axis filters
    float cap;                  // squared speed, for which filters and shaper stay near the path
    float turned;               // sum of |dP/ds| that they turn by
};

// One of two blocks, as it is read.
struct ReadJoint : LawJoint {
    LaneVec change;  // of the jerk, times v^3: not through the filters
};

// How a stretch starts or ends: at a corner that overlaps in time both sides may share the jerk.
struct StopChoice {
    float time;   // s, of the element at most
    float share;  // of the axes' jerk, in (0, 1]
};

inline constexpr std::size_t kMostJoints = 32;  // that a station is given
inline constexpr float kLongestElement = 0.5F;  // mm
inline constexpr float kReach = 1.1F;           // of the filters' window in travel
inline constexpr unsigned kReachTicks = 3;      // on top of the filters

// Context: main loop.
class StationMaker {
public:
    void set_limits(const MachineLimits& limits) noexcept;
    // The shaper behind the axis filters. Its length counts for caps on both sides of a place.
    void set_shaper(const InputShaper& shaper) noexcept
    {
        shaper_length_ = shaper.length;
        shaper_square_ = shaper.square;
        shaper_mean_time_ = shaper.mean_time;
    }
    float shaper_length() const noexcept { return shaper_length_; }

    // The squared speed at which filters and shaper leave a turn, with a bend beside it, by no more
    // than they may.
    float cap_of_turn(const LawBlock& block, float turned, float bend) const noexcept;

    // mm of travel, no less than what the filters feel in a time: a speed, and what it may gain.
    float way_of_joints(float time, float speed) const noexcept;

    // The joint at the end of a block that another follows.
    ReadJoint joint(const LawPath& path, const PathCursor& before) const noexcept;

    // The cell between two places, path units from the start of the stretch.
    //
    //   cursor  near `from`; then at `to`.
    //   joints  those within reach of the filters.
    //   speed   mm/s, the most that is expected there.
    Station make(const LawPath& path,
                 PathCursor& cursor,
                 std::int64_t from,
                 std::int64_t to,
                 Span<const LawJoint> joints,
                 float speed) const noexcept;

    // The element that starts or ends at a place of rest, up to the first joint that counts.
    //
    //   cursor  its block.
    //   rest    path units from the start of the stretch.
    //   at_end  it ends there, else it starts there.
    //   most    mm, that it may be long.
    StopElement element(const LawPath& path,
                        PathCursor cursor,
                        std::int64_t rest,
                        bool at_end,
                        const StopChoice& choice,
                        float most) const noexcept;

private:
    // Of the jumps of curvature of joints in order, an axis a lane.
    struct JumpSums {
        LaneVec run;   // all so far
        LaneVec high;  // greatest and least of that
        LaneVec low;
        LaneVec magnitudes;
        float window;  // s, the longest
    };
    void feel_joints(Station& station,
                     Span<const LawJoint> joints,
                     float speed,
                     float second) const noexcept;
    KeptShares kept_at(const Station& station,
                       Span<const LawJoint> joints,
                       float speed,
                       float second) const noexcept;
    void keep_turns(KeptShares& kept,
                    Span<const LawJoint* const> joints,
                    float speed,
                    float second) const noexcept;
    void keep_jumps(KeptShares& kept, const JumpSums& sums, float speed) const noexcept;
    float smooth_length(const LawPath& path,
                        PathCursor cursor,
                        std::int64_t rest,
                        bool at_end,
                        float jerk,
                        float most) const noexcept;
    MachineLimits limits_{};
    LaneVec inverse_jerk_{};
    LaneVec inverse_acceleration_{};
    float greatest_jerk_{0};
    float greatest_acceleration_{0};
    float shaper_length_{0};     // s
    float shaper_square_{0};     // s^2
    float shaper_mean_time_{0};  // s
};

}  // namespace cusp::planner
