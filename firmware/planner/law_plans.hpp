// LawPlans: plans of the time law on their way from the main loop to the servo tick.
//
// A plan is a run of cells: those that are played in any case, then the way to rest in case that no
// other plan follows in time. After the former the tick goes on with the next plan if it is there;
// else it plays this one to its end, and the next plan is refused: the path goes on from rest.
// Held by tests/unit/planner/law_plans_test.cpp.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "firmware/planner/law_bounds.hpp"

namespace cusp::planner {

class LawPlans {
public:
    // Context: main loop.
    // Cells that find room; 0 where no further plan does.
    std::uint32_t room() const noexcept
    {
        const bool is_full = load(published_) - load(begun_) >= kPlans - 1;
        return is_full ? 0 : kCells - (end_ - load(at_));
    }
    // A cell of the next plan. One that starts from rest has a kStart first. Precondition: room().
    void add(const LawCell& cell, const WarpBounds& bounds) noexcept;
    void add(const LawCell& cell) noexcept { add(cell, WarpBounds{}); }
    // The next plan is whole; its first cells, > 0, are certain. False: the tick is on its way to
    // rest, and the plan doesn't start from there.
    bool publish(std::uint32_t certain) noexcept;
    // True if the tick is on its way to rest, or there, within a stretch.
    bool starves() const noexcept { return load(resting_) == load(published_); }
    // The certain cells that the tick has yet to begin.
    struct Way {
        float length;  // mm
        float time;    // s, at least
    };
    Way certain_way() const noexcept;
    // Precondition: no tick.
    void clear() noexcept;

    // Context: servo tick, which interrupts the main loop, and is not interrupted by it.
    // The next cell to be played. False: the tool is at rest, and no plan starts from there.
    bool next(LawCell& cell) noexcept;
    // The cell that look(0) gives is played from now on, and its place is free. Precondition: it gave
    // one.
    void pass() noexcept;

    // The cell that is played after `ahead` others. False: the tool is at rest then. What is asked for
    // is decided: a plan that comes later does not change it.
    bool look(std::uint32_t ahead, const LawCell*& cell, const PackedBounds*& bounds) noexcept;

    // True if it depends on a plan that may come what the next cell is.
    bool chooses() const noexcept { return run_count_ == 0; }

private:
    static constexpr std::uint32_t kCells = 128;
    static constexpr std::uint32_t kPlans = 4;

    struct Plan {
        std::uint32_t begin;
        std::uint32_t certain;  // end of what is certain
        std::uint32_t end;
        bool from_rest;
    };
    // Cells that are played for sure, one after the other.
    struct Run {
        std::uint32_t begin;
        std::uint32_t end;
    };
    using Counter = std::atomic<std::uint32_t>;
    static std::uint32_t load(const Counter& counter) noexcept { return counter.load(); }
    bool choose() noexcept;
    void drop_run() noexcept;

    std::array<LawCell, kCells> cells_{};
    std::array<PackedBounds, kCells> bounds_{};
    std::array<Plan, kPlans> plans_{};
    std::uint32_t end_{0};         // cells
    std::uint32_t plan_begin_{0};  // of the plan that is being added
    Counter published_{0};         // plans
    Counter begun_{0};             // by the tick
    Counter at_{0};                // the cell after the one that is played
    Counter resting_{kNone};       // the number of the plan that did not come in time, if any
    // Chosen by the tick, not yet played; the first may be empty.
    static constexpr std::uint32_t kRuns = 2 * kPlans;
    static constexpr std::uint32_t kNone = 0xFFFFFFFF;
    std::array<Run, kRuns> runs_{};
    std::uint32_t run_count_{0};
    bool rests_{true};  // after the last of them the tool is at rest
};

}  // namespace cusp::planner
