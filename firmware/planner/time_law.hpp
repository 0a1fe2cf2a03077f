// TimeLaw: the fastest speeds along a stretch of path from stop to stop, window by window.
//
// Stations come in order while the path becomes known; a window of them is planned by Newton
// steps, a bounded number, and its first part becomes final. Each plan ends in a crawl, from which the
// tool can stop within kCrawlStop at any place that the stations behind the window describe, so a
// plan may be played to its end if no other comes.
//
//   add() ... add() end()      stations, as long as there is room
//   work()                     one Newton step a call, until nothing is left to do
//   accept()                   hands a plan over to the servo tick
//
// Source: docs/numerics.md, "The time law". Held by tests/unit/planner/time_law_test.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "firmware/base/machine_limits.hpp"
#include "firmware/planner/barrier.hpp"
#include "firmware/planner/law_plans.hpp"

namespace cusp::planner {

inline constexpr float kCrawlStop = 0.1F;  // mm

// Context: main loop.
class TimeLaw {
public:
    // Of the motion before the axis filters, less what rounding takes.
    void set_limits(const MachineLimits& limits) noexcept;

    // Time in which a station is to be passed, s: a quarter of the longest a/j.
    float station_time() const noexcept { return station_time_; }

    // The next stretch starts from rest.
    void begin(const StopElement& start) noexcept;

    bool has_room() const noexcept
    {
        return !ended_ && stations_ + 4 < window_.first_cell() + kStations;
    }

    // The next station; the first is shorter than 1.4 times the element. Precondition: has_room().
    void add(const Station& station) noexcept;

    // The last station is the last of the stretch, and shorter than 1.4 times the element.
    // Precondition: some were added.
    // The next stretch may begin `overlap` s before its end.
    void end(const StopElement& stop, float overlap = 0, bool disjoint = false) noexcept;

    enum class State : std::uint8_t {
        kWaits,    // for stations
        kWorks,    // a window is on its way
        kChecks,   // a window is planned: to be judged by accept() or retreat()
        kStays,    // it stays as the plan before it was, and a crawl: to be accepted
        kDone,     // all cells are final
        kBlocked,  // not even a crawl leads away from rest
    };
    State state() const noexcept { return state_; }

    // One Newton step of the window, or the next window where stations suffice.
    void work() noexcept;

    // No more stations come before a window is final: the next one begins with those that are there.
    // False: they are too few. Precondition: state() is kWaits.
    bool begin_short_window() noexcept;

    // Cells of the window that is to be judged.
    std::uint32_t first_cell() const noexcept { return window_.first_cell(); }
    std::uint32_t end_cell() const noexcept { return window_.end_cell(); }
    LawCell cell(std::uint32_t k) const noexcept
    {
        const Station& own = spline_.station(k);
        return {spline_.at_start(k), own.travel, LawPiece::kCell, own.kind, own.percent};
    }

    const Station& station(std::uint32_t k) const noexcept { return spline_.station(k); }

    // The window holds every limit: its plan is handed over, and its first part becomes final. If the
    // plan before it is on its way to rest already, the law rests().
    // Precondition: state() is kChecks or kStays, plans.room() >= plan_cells().
    void accept(LawPlans& plans) noexcept;
    // It does not: the window is planned again by a heavier barrier, which keeps farther from every
    // limit. The fourth time it stays as the plan before it was. Precondition: state() == kChecks.
    void retreat() noexcept;
    // Cells that accept() hands over, at most.
    std::uint32_t plan_cells() const noexcept { return open_end() - final_ + kCellsAtEnds; }

    // True once a plan is in force, and if it reaches the stop element at the end; else it ends in a
    // crawl.
    bool has_plan() const noexcept { return in_force_ > 0; }
    bool plans_the_end() const noexcept { return ended_ && in_force_ == stations_ + 2; }

    // No station comes in time, or the plan in force can't be continued: it is played to its end,
    // and the path goes on from there. Precondition: has_plan(), !plans_the_end().
    void rest() noexcept;
    bool rests() const noexcept { return rests_; }
    // Path units from the start of the stretch. Precondition: rests().
    std::int64_t place_of_rest() const noexcept;

    // Newton steps since set_limits(), for budgets.
    std::uint32_t steps() const noexcept { return steps_; }

private:
    static constexpr std::uint32_t kCellsAtEnds =
        3;  // both elements, or one and two from the crawl

    void begin_window(std::uint32_t least_behind) noexcept;
    void make_room_behind(std::uint32_t least_behind) noexcept;
    float crawl_within(float distance) const noexcept;
    float length_behind(std::uint32_t k) const noexcept;
    void restart() noexcept;
    void extend() noexcept;
    void start_near() noexcept;
    void ramp(std::uint32_t from, std::uint32_t to, float goal) noexcept;
    void restrict_crawl(const Station& station) noexcept;
    void restore() noexcept;
    std::uint32_t open_end() const noexcept
    {
        return window_.end_factor > 0 ? stations_ : planned_ - 2;
    }
    std::array<LawCell, 2> stop_from_crawl(std::uint32_t planned) const noexcept;
    std::uint32_t end_of_final() const noexcept;
    void add_stop(LawPlans& plans) const noexcept;
    void add_rest(LawPlans& plans) const noexcept;
    BarrierWeight weight() const noexcept;

    LawSpline spline_;
    std::array<float, kMostWindow> before_{};  // the window's coefficients before its first step
    LawWindow window_{1, 1, 0.0F, 0.0F};
    State state_{State::kDone};
    bool ended_{false};
    bool rests_{false};          // the plan ends before the stretch does
    bool extended_{false};       // the window has values
    bool begun_{false};          // and those that its steps start from
    std::uint8_t attempts_{0};   // at such values
    std::uint8_t step_{0};       // of the window
    std::uint8_t finishing_{0};  // of its last steps
    std::uint8_t retreats_{0};
    std::uint32_t stations_{0};  // added
    std::uint32_t planned_{0};   // coefficients that have a value
    std::uint32_t in_force_{0};  // those of the last plan accepted
    std::uint32_t final_{0};     // cells handed over that will be played
    std::uint32_t steps_{0};
    float mu_{0};
    float last_mu_{0};  // of the window
    float crawl_{0};
    LaneVec inverse_acceleration_{};
    float least_jerk_{1};  // mm/s^3, of any axis
    float greatest_crawl_{0};
    StopElement start_{};
    StopElement stop_{};
    float overlap_{0};
    bool disjoint_{false};
    float start_factor_{0};  // of the coefficient beyond the start to its neighbour
    float end_factor_{0};
    float station_time_{0};
};

}  // namespace cusp::planner
