// Ramps from both ends of a window, below what the path allows, with round tops.
#include "firmware/planner/law_start.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/base/assert.hpp"
#include "firmware/base/math.hpp"

namespace cusp::planner {
namespace {

constexpr float kPart = 0.95F;              // of the limits, that ramps take
constexpr float kPartAtEnds = 0.95F;        // of the caps at the stretch's ends
constexpr float kPartOfCaps = 0.995F;       // of the others
constexpr float kBendAcceleration = 0.85F;  // of the limits, that bends of the path may take
constexpr float kBendJerk = 0.5F;
constexpr int kRounds = 4;            // of rounding: the speed at the top decides how round it is
constexpr float kLeastTop = 0.01F;    // what rounding leaves: squares of speeds stay positive
constexpr float kLeastShare = 1e-9F;  // of a direction or a bend that counts

// mm between the coefficients k and k + 1.
float step_at(const LawSpline& spline, std::uint32_t k) noexcept
{
    return 0.5F * (spline.length_before(k) + spline.station(k).length);
}

// The limits along a cell, by the greatest of its places whatever their signs.
class CellLimits {
public:
    CellLimits(const LawSpline& spline, std::uint32_t k) noexcept
        : kept_{spline.station(k).kept}, ratio_{spline.ratio}
    {
        LaneVec first = all_lanes(kLeastShare);
        for (const LaneDerivatives& place : spline.station(k).places) {
            first = larger(first, magnitude(place.first));
            second_ = larger(second_, magnitude(place.second));
            third_ = larger(third_, magnitude(place.third));
        }
        twice_inverse_ = quotient(all_lanes(2.0F), first);
    }

    // Greatest x.
    float most() const noexcept
    {
        const LaneVec bends = product(second_, ratio_) + kept_.bend_acceleration;
        const float x = kBendAcceleration / greatest(kLeastShare, bends);
        const float cube = kBendJerk / greatest(kLeastShare, third_ + kept_.bend);
        if (x * x * x <= cube * cube) {
            return x;
        }
        const float root = cube_root(cube);
        return root * root;
    }
    // Greatest x'.
    float slope(float x) const noexcept
    {
        const LaneVec bends = kept_.bend_acceleration + product(second_, ratio_);
        const LaneVec free = all_lanes(kPart) - kept_.turn_acceleration * std::sqrt(x) - bends * x;
        return std::max(least(kUnlimited, product(quotient(free, ratio_), twice_inverse_)), 0.0F);
    }
    // Greatest x'', either way.
    float bend(float x, float slope) const noexcept
    {
        const float root = std::sqrt(x);
        const LaneVec still = all_lanes(kPart) - kept_.always - kept_.jump * x - kept_.turn * root;
        const LaneVec free =
            still / root - (kept_.bend + third_) * x - second_ * (1.5F * std::fabs(slope));
        return std::max(least(kUnlimited, product(free, twice_inverse_)), 0.0F);
    }

private:
    KeptShares kept_;
    LaneVec ratio_;
    LaneVec second_ = all_lanes(0.0F);
    LaneVec third_ = all_lanes(0.0F);
    LaneVec twice_inverse_;  // over q'
};

// A way along the coefficients, in either direction, that rises as fast as it may.
struct Rise {
    float x;
    float slope;

    // To the next coefficient, `step` mm on, behind a cell of a length; not above `most`.
    void go_on(const CellLimits& cell, float length, float step, float most) noexcept
    {
        float next = std::max(x, x + slope * step);
        // The bend that is allowed depends on the speed that it leads to.
        for (int i = 0; i < 2; ++i) {
            const float steeper = slope + cell.bend(next, slope) * length;
            next = std::max(x, x + std::min(steeper, cell.slope(next)) * step);
        }
        take(std::min(next, most), step);
    }
    void take(float next, float step) noexcept
    {
        slope = (next - x) / step;
        x = next;
    }
};

class Ramps {
public:
    Ramps(LawSpline& spline, const LawWindow& window, std::uint32_t from) noexcept
        : spline_{spline}, window_{window}, from_{from}
    {
        find_tops();
    }

    void rise() noexcept;
    void fall() noexcept;
    void round_tops() noexcept;

private:
    // One for each coefficient from that before `from_` to that behind the window.
    using Values = std::array<float, kMostWindow + 2>;

    float& top(std::uint32_t j) noexcept { return tops_[j + 1 - from_]; }
    void find_tops() noexcept;
    void put_hull(const Values& expected) noexcept;

    LawSpline& spline_;
    LawWindow window_;
    std::uint32_t from_;
    Values tops_;  // the coefficients stay below
};

void Ramps::find_tops() noexcept
{
    const bool goes_on = from_ > window_.begin;
    for (std::uint32_t j = from_; j < window_.end; ++j) {
        top(j) = kPartOfCaps * spline_.cap(j);
    }
    for (std::uint32_t k = std::max<std::uint32_t>(from_, 2) - 2; k < window_.end_cell(); ++k) {
        const float most = CellLimits{spline_, k}.most();
        for (std::uint32_t j = std::max(k, from_); j <= k + 2 && j < window_.end; ++j) {
            top(j) = std::min(top(j), most);
        }
    }
    // The last plan may be nearer to the limits than ramps go.
    for (std::uint32_t j = from_; goes_on && j < window_.end; ++j) {
        top(j) = std::max(top(j), std::min(spline_.coefficient(from_ - 1), spline_.cap(j)));
    }
}

void Ramps::rise() noexcept
{
    std::uint32_t j = from_;
    if (window_.start_factor > 0 && j == window_.begin) {
        top(j) *= kPartAtEnds;
        spline_.coefficient(j) = top(j);
        spline_.coefficient(j - 1) = window_.start_factor * top(j);
        ++j;
    }
    Rise way{spline_.coefficient(j - 2), 0.0F};
    way.take(spline_.coefficient(j - 1), step_at(spline_, j - 2));
    for (; j < window_.end; ++j) {
        way.go_on(CellLimits{spline_, j - 1}, spline_.length_before(j - 1), step_at(spline_, j - 1),
                  top(j));
        spline_.coefficient(j) = way.x;
    }
}

// Backwards, as far as it is below the rise.
void Ramps::fall() noexcept
{
    std::uint32_t j = window_.end;
    Rise way{spline_.coefficient(j), 0.0F};
    if (window_.end_factor > 0) {
        --j;
        const float end = std::min(kPartAtEnds * top(j), spline_.coefficient(j));
        spline_.coefficient(j) = end;
        spline_.coefficient(j + 1) = window_.end_factor * end;
        way.x = spline_.coefficient(j + 1);
        way.take(end, step_at(spline_, j));
    }
    while (j-- > from_) {
        way.go_on(CellLimits{spline_, j}, spline_.station(j).length, step_at(spline_, j),
                  std::min(top(j), spline_.coefficient(j)));
        spline_.coefficient(j) = way.x;
    }
}

// The greatest function below the tops whose x'' stays above -B, B being what the cells allow: with
// W'' = B it is the lower convex hull of the tops + W, less W.
void Ramps::put_hull(const Values& expected) noexcept
{
    struct Corner {
        std::uint32_t i;
        float at;
        float height;
    };
    std::array<Corner, kMostWindow + 2> hull;
    Values lifts;  // W
    const std::uint32_t last = window_.end + 1 - from_;
    std::uint32_t count = 0;
    float at = 0;
    float lift = 0;
    float slope = 0;
    for (std::uint32_t i = 0; i <= last; ++i) {
        const std::uint32_t j = from_ + i - 1;
        if (i > 0) {
            const float step = step_at(spline_, j - 1);
            at += step;
            lift += slope * step;
            const float beside = std::max(expected[i - 1], expected[i + (i < last ? 1 : 0)]);
            const float x = 0.5F * (expected[i] + std::max(expected[i], beside));
            slope += CellLimits{spline_, j - 1}.bend(x, 0.0F) * spline_.station(j - 1).length;
        }
        lifts[i] = lift;
        const Corner now{i, at, tops_[i] + lift};
        // The last corner is above the way from the one before it to this.
        while (count > 1 &&
               (hull[count - 1].height - hull[count - 2].height) * (now.at - hull[count - 2].at) >=
                   (now.height - hull[count - 2].height) *
                       (hull[count - 1].at - hull[count - 2].at)) {
            --count;
        }
        hull[count] = now;
        ++count;
    }
    for (std::uint32_t n = 1; n < count; ++n) {
        const Corner& a = hull[n - 1];
        const Corner& b = hull[n];
        const float rise = (b.height - a.height) / (b.at - a.at);
        at = a.at;
        for (std::uint32_t i = a.i + 1; i <= b.i && i < last; ++i) {
            at += step_at(spline_, from_ + i - 2);
            const float height = a.height + rise * (at - a.at);
            spline_.coefficient(from_ + i - 1) =
                std::max(kLeastTop * tops_[i], std::min(tops_[i], height - lifts[i]));
        }
    }
}

void Ramps::round_tops() noexcept
{
    const std::uint32_t count = window_.end + 2 - from_;
    for (std::uint32_t i = 0; i < count; ++i) {
        tops_[i] = spline_.coefficient(from_ + i - 1);
    }
    Values expected = tops_;
    for (int round = 0; round < kRounds; ++round) {
        put_hull(expected);
        tie_ends(spline_, window_);
        tops_[0] = spline_.coefficient(from_ - 1);
        tops_[count - 1] = spline_.coefficient(window_.end);
        for (std::uint32_t i = 0; i < count; ++i) {
            expected[i] = 0.5F * (expected[i] + spline_.coefficient(from_ + i - 1));
        }
    }
}

}  // namespace

std::uint32_t end_of_kept(const LawSpline& spline,
                          const LawWindow& window,
                          std::uint32_t planned) noexcept
{
    std::uint32_t end = std::max(planned, window.begin + 1) - 1;
    while (end > window.begin && spline.coefficient(end - 1) >= spline.coefficient(end)) {
        --end;
    }
    return planned > window.begin ? std::min(end + 1, window.end - 1) : window.begin;
}

void start_by_ramps(LawSpline& spline, const LawWindow& window, std::uint32_t from) noexcept
{
    CUSP_ASSERT(window.end - from <= kMostWindow);
    Ramps ramps{spline, window, from};
    ramps.rise();
    ramps.fall();
    ramps.round_tops();
}

}  // namespace cusp::planner
