// One place of choice for each plan: the end of its certain cells.
#include "firmware/planner/law_plans.hpp"

#include "firmware/base/assert.hpp"
#include "firmware/base/path_units.hpp"

namespace cusp::planner {

void LawPlans::add(const LawCell& cell, const WarpBounds& bounds) noexcept
{
    CUSP_ASSERT(end_ - load(at_) < kCells);
    cells_[end_ % kCells] = cell;
    bounds_[end_ % kCells] = PackedBounds{bounds};
    ++end_;
}

// The tick may choose at any time: either it sees the plan, or it has said before that it rests.
bool LawPlans::publish(std::uint32_t certain) noexcept
{
    const std::uint32_t number = load(published_);
    const bool from_rest = cells_[plan_begin_ % kCells].piece == LawPiece::kStart;
    CUSP_ASSERT(certain > 0 && certain <= end_ - plan_begin_);
    plans_[number % kPlans] = {plan_begin_, plan_begin_ + certain, end_, from_rest};
    published_.store(number + 1);
    if (!from_rest && load(resting_) == number) {
        published_.store(number);
        end_ = plan_begin_;
        return false;
    }
    plan_begin_ = end_;
    return true;
}

LawPlans::Way LawPlans::certain_way() const noexcept
{
    Way way{0, 0};
    const std::uint32_t at = load(at_);
    const std::uint32_t published = load(published_);
    const std::uint32_t begun = load(begun_);
    for (std::uint32_t n = begun - (begun > 0 ? 1 : 0); n != published; ++n) {
        const Plan& plan = plans_[n % kPlans];
        const bool is_played = at - plan.begin < kCells;
        for (std::uint32_t i = is_played ? at : plan.begin;
             i - plan.begin < plan.certain - plan.begin; ++i) {
            way.length += static_cast<float>(cells_[i % kCells].travel) / kPathUnitsPerMillimetre;
            way.time += bounds_[i % kCells].unpacked().time;
        }
    }
    return way;
}

void LawPlans::clear() noexcept
{
    end_ = 0;
    plan_begin_ = 0;
    published_.store(0);
    begun_.store(0);
    at_.store(0);
    resting_.store(kNone);
    run_count_ = 0;
    runs_ = {};
    rests_ = true;
}

bool LawPlans::next(LawCell& cell) noexcept
{
    const LawCell* ahead = nullptr;
    const PackedBounds* bounds = nullptr;
    if (!look(0, ahead, bounds)) {
        return false;
    }
    cell = *ahead;
    pass();
    return true;
}

void LawPlans::pass() noexcept
{
    std::uint32_t& at = runs_[0].begin;
    ++at;
    at_.store(at);
    drop_run();
}

// A run that is played goes.
void LawPlans::drop_run() noexcept
{
    if (run_count_ > 0 && runs_[0].begin == runs_[0].end) {
        for (std::uint32_t i = 1; i < run_count_; ++i) {
            runs_[i - 1] = runs_[i];
        }
        --run_count_;
    }
}

bool LawPlans::look(std::uint32_t ahead, const LawCell*& cell, const PackedBounds*& bounds) noexcept
{
    for (std::uint32_t i = 0;; ++i) {
        if (i == run_count_ && (run_count_ == kRuns || !choose())) {
            return false;
        }
        const std::uint32_t count = runs_[i].end - runs_[i].begin;
        if (ahead < count) {
            cell = &cells_[(runs_[i].begin + ahead) % kCells];
            bounds = &bounds_[(runs_[i].begin + ahead) % kCells];
            return true;
        }
        ahead -= count;
    }
}

// Adds the next plan, or the end of the last, to what is played. False: neither.
bool LawPlans::choose() noexcept
{
    const std::uint32_t number = load(begun_);
    const Plan& next = plans_[number % kPlans];
    if (number != load(published_) && next.from_rest == rests_) {
        runs_[run_count_] = {next.begin, next.certain};
        ++run_count_;
        rests_ = next.certain == next.end;
        begun_.store(number + 1);
        return true;
    }
    if (rests_) {
        return false;
    }
    const Plan& last = plans_[(number - 1) % kPlans];
    runs_[run_count_] = {last.certain, last.end};
    ++run_count_;
    resting_.store(number);
    rests_ = true;
    return true;
}

}  // namespace cusp::planner
