// One place of choice for each plan: the end of its certain cells.
#include "firmware/planner/law_plans.hpp"

#include "firmware/base/assert.hpp"

namespace cusp::planner {

void LawPlans::add(const LawCell& cell) noexcept
{
    CUSP_ASSERT(end_ - load(at_) < kCells);
    cells_[end_ % kCells] = cell;
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

bool LawPlans::next(LawCell& cell) noexcept
{
    if (load(at_) == choice_ && !choose()) {
        return false;
    }
    const std::uint32_t at = load(at_);
    cell = cells_[at % kCells];
    at_.store(at + 1);
    return true;
}

// Goes to the next plan, or on to the end of this one. False: neither.
bool LawPlans::choose() noexcept
{
    const std::uint32_t number = load(begun_);
    const Plan& next = plans_[number % kPlans];
    if (number != load(published_) && next.from_rest == rests_) {
        at_.store(next.begin);
        choice_ = next.certain;
        rests_ = next.certain == next.end;
        begun_.store(number + 1);
        return true;
    }
    if (rests_) {
        return false;
    }
    resting_.store(number);
    choice_ = plans_[(number - 1) % kPlans].end;
    rests_ = true;
    return true;
}

}  // namespace cusp::planner
