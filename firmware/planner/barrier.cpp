// Gradient, Hessian and the longest step, cell by cell.
#include "firmware/planner/barrier.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/assert.hpp"
#include "firmware/planner/law_rows.hpp"

namespace cusp::planner {
namespace {

constexpr float kPartOfSlack = 0.97F;  // that a step may take
// Added to the diagonal: rounding leaves it positive.
constexpr float kRelativeDamping = 1e-6F;
constexpr float kDamping = 1e-6F;
constexpr std::uint32_t kMostLocal = kMostWindow + 4;  // two coefficients more on either side

// x at the places of a cell is linear in three coefficients: their parts, one for each.
struct Parts {
    std::array<float, 3> value;
    std::array<float, 3> slope;
    std::array<float, 3> bend;
};

float sum_of(const std::array<float, 3>& a) noexcept { return a[0] + a[1] + a[2]; }

SquaredSpeed sum_of(const Parts& parts) noexcept
{
    return {sum_of(parts.value), sum_of(parts.slope), sum_of(parts.bend)};
}

// Shape of a cell: how its three coefficients make x.
struct CellShape {
    CellShape(const LawSpline& spline, std::uint32_t k) noexcept : length{spline.station(k).length}
    {
        const float before = spline.length_before(k);
        const float after = spline.station(k + 1).length;
        inverse = 1.0F / length;
        const float to_left = 1.0F / (before + length);
        const float to_right = 1.0F / (length + after);
        left = length * to_left;
        left_slope = 2.0F * to_left;
        right = after * to_right;
        right_slope = 2.0F * to_right;
    }

    // Parts of the coefficients a, b and c at the start.
    Parts at_start(float a, float b, float c) const noexcept
    {
        const float fall = left_slope * a;
        const float rise = right_slope * c;
        const float middle = left_slope * b;
        return {{left * a, b - left * b, 0.0F},
                {-fall, middle, 0.0F},
                {fall * inverse, (-right_slope * b - middle) * inverse, rise * inverse}};
    }

    float length;
    float inverse;
    float left;  // weight of the first coefficient at the start, of the second at the end
    float left_slope;
    float right;
    float right_slope;
};

// Gradient and Hessian by x, x' and x'' at the start of a cell.
struct CellSums {
    // Adds those of a place `t` mm further: x there is x + t x' + t^2/2 x'', x' is x' + t x''.
    void add(const CellSums& at, float t) noexcept
    {
        const float half = 0.5F * t * t;
        const float vs_there = at.vs + t * at.vv;
        const float vb_there = at.vb + t * at.vs + half * at.vv;
        const float sb_there = at.sb + t * at.ss + half * at.vs;
        value += at.value;
        slope += at.slope + t * at.value;
        bend += at.bend + t * at.slope + half * at.value;
        vv += at.vv;
        vs += vs_there;
        vb += vb_there;
        ss += at.ss + t * (at.vs + vs_there);
        sb += sb_there + t * vb_there;
        bb += at.bb + t * (at.sb + sb_there) + half * (at.vb + vb_there);
    }
    float value{0}, slope{0}, bend{0};
    float vv{0}, vs{0}, vb{0}, ss{0}, sb{0}, bb{0};
};

// The sums over all rows at a place, an axis a lane.
struct RowSums {
    // -log of both slacks, left - value and left + value. x'' is not in rows of acceleration.
    template <bool kWithBend>
    void add(const LawRow& row, const LaneVec& moving) noexcept
    {
        const LaneVec above = row.left - row.value;
        const LaneVec below = row.left + row.value;
        const LaneVec inverse = quotient(moving, product(above, below));
        const LaneVec plus = product(below, inverse);
        const LaneVec minus = product(above, inverse);
        const LaneVec both = plus + minus;
        const LaneVec twist = plus - minus;
        const LaneVec squares = product(plus, plus) + product(minus, minus);
        const LaneVec skew = product(both, twist);
        const LaneVec& fall = row.fall;
        value = value + product(both, fall) + product(twist, row.by_value);
        slope = slope + product(twist, row.by_slope);
        const LaneVec by_value = product(squares, row.by_value) + product(skew, fall);
        vv = vv + product(by_value, row.by_value) +
             product(product(squares, fall) + product(skew, row.by_value), fall);
        vs = vs + product(by_value, row.by_slope);
        const LaneVec by_slope = product(squares, row.by_slope);
        ss = ss + product(by_slope, row.by_slope);
        if constexpr (kWithBend) {
            bend = bend + product(twist, row.by_bend);
            vb = vb + product(by_value, row.by_bend);
            sb = sb + product(by_slope, row.by_bend);
            bb = bb + product(product(squares, row.by_bend), row.by_bend);
        }
    }
    CellSums of_axes() const noexcept
    {
        return {sum(value), sum(slope), sum(bend), sum(vv), sum(vs),
                sum(vb),    sum(ss),    sum(sb),   sum(bb)};
    }

    LaneVec value = all_lanes(0.0F);
    LaneVec slope = value;
    LaneVec bend = value;
    LaneVec vv = value;
    LaneVec vs = value;
    LaneVec vb = value;
    LaneVec ss = value;
    LaneVec sb = value;
    LaneVec bb = value;
};

// The parts at the start of a cell of what its coefficients add.
Parts start_of(const LawSpline& spline, std::uint32_t k) noexcept
{
    const CellShape shape{spline, k};
    return shape.at_start(spline.coefficient(k), spline.coefficient(k + 1),
                          spline.coefficient(k + 2));
}

// The rows at a place of a cell.
struct PlaceRows {
    float travel;  // mm from the start of the cell
    LawRow jerk;
    LawRow acceleration;
    bool has_acceleration;
};

// Calls `take` with the rows at each place of the cell whose x is `start` at its start.
template <class Take>
void for_places(const LawSpline& spline,
                std::uint32_t k,
                const SquaredSpeed& start,
                Take take) noexcept
{
    const Station& station = spline.station(k);
    for (unsigned i = 0; i < kPlacesOfCell; ++i) {
        const float travel = 0.5F * static_cast<float>(i) * station.length;
        const SquaredSpeed x = advanced(start, travel);
        const float root = std::sqrt(x.value);
        take(PlaceRows{travel, jerk_row(station.places[i], station.kept, x, root),
                       acceleration_row(station.places[i], station.kept, spline.ratio, x, root),
                       i + 1 < kPlacesOfCell || station.acceleration_at_end});
    }
}

// The pentadiagonal system of a window, by relative changes of the coefficients.
class NewtonSystem {
public:
    explicit NewtonSystem(const LawWindow& window) noexcept
        : window_{window}, base_{window.first_cell()}
    {
    }

    void add_cell(const LawSpline& spline, std::uint32_t k, float weight) noexcept;
    void add_coefficient(const LawSpline& spline,
                         std::uint32_t j,
                         const BarrierWeight& weight) noexcept;
    void solve() noexcept;
    // The longest part of the step that leaves of each slack what a step leaves.
    float longest(const LawSpline& spline) const noexcept;
    // Returns the greatest change of the coefficients that become final.
    float apply(LawSpline& spline, float part) const noexcept;

private:
    struct Line {
        float gradient{0};
        float diagonal{0};
        float next{0};    // coupling with the next line
        float second{0};  // and with the one after it
        float change{0};
    };
    Line& line(std::uint32_t j) noexcept { return lines_[j - base_]; }
    const Line& line(std::uint32_t j) const noexcept { return lines_[j - base_]; }
    void add_sums(std::uint32_t k, const Parts& parts, const CellSums& sums, float mu) noexcept;
    void tie_ends() noexcept;

    LawWindow window_;
    std::uint32_t base_;
    std::array<Line, kMostLocal> lines_{};
};

void NewtonSystem::add_sums(std::uint32_t k, const Parts& p, const CellSums& s, float mu) noexcept
{
    std::array<float, 3> by_value;
    std::array<float, 3> by_slope;
    std::array<float, 3> by_bend;
    for (unsigned i = 0; i < 3; ++i) {
        line(k + i).gradient +=
            mu * (s.value * p.value[i] + s.slope * p.slope[i] + s.bend * p.bend[i]);
        by_value[i] = mu * (s.vv * p.value[i] + s.vs * p.slope[i] + s.vb * p.bend[i]);
        by_slope[i] = mu * (s.vs * p.value[i] + s.ss * p.slope[i] + s.sb * p.bend[i]);
        by_bend[i] = mu * (s.vb * p.value[i] + s.sb * p.slope[i] + s.bb * p.bend[i]);
    }
    const auto pair = [&](unsigned a, unsigned b) {
        return by_value[a] * p.value[b] + by_slope[a] * p.slope[b] + by_bend[a] * p.bend[b];
    };
    for (unsigned i = 0; i < 3; ++i) {
        line(k + i).diagonal += pair(i, i);
    }
    line(k).next += pair(0, 1);
    line(k + 1).next += pair(1, 2);
    line(k).second += pair(0, 2);
}

void NewtonSystem::add_cell(const LawSpline& spline, std::uint32_t k, float weight) noexcept
{
    const Parts start = start_of(spline, k);
    const LaneVec& moving = spline.station(k).moving;
    CellSums sums;
    for_places(spline, k, sum_of(start), [&](const PlaceRows& place) {
        RowSums rows;
        rows.add<true>(place.jerk, moving);
        if (place.has_acceleration) {
            rows.add<false>(place.acceleration, moving);
        }
        sums.add(rows.of_axes(), place.travel);
    });
    add_sums(k, start, sums, weight);
}

// A slack as small as rounding counts as that.
float part_of_cap(const LawSpline& spline, std::uint32_t j) noexcept
{
    constexpr float kLeastSlack = 1e-6F;
    return std::min(spline.coefficient(j) / spline.cap(j), 1.0F - kLeastSlack);
}

// The time that a coefficient stands for is a third of its support over its root.
void NewtonSystem::add_coefficient(const LawSpline& spline,
                                   std::uint32_t j,
                                   const BarrierWeight& weight) noexcept
{
    const float middle = spline.length_before(j);
    const float before = j < 2 ? middle : spline.station(j - 2).length;
    const float after = spline.station(j).length;
    const float c = spline.coefficient(j);
    const float time = weight.time * (before + middle + after) / (3.0F * std::sqrt(c));
    const float part = part_of_cap(spline, j);
    const float push = part / (1.0F - part);
    Line& own = line(j);
    own.gradient += weight.speed * push - 0.5F * time;
    own.diagonal += weight.speed * push * push + 0.75F * weight.time_hessian * time;
}

// Coefficients beyond the ends change by the same part as their neighbours.
void NewtonSystem::tie_ends() noexcept
{
    if (window_.start_factor > 0) {
        const Line& beyond = line(0);
        Line& first = line(1);
        first.gradient += beyond.gradient;
        first.diagonal += beyond.diagonal + 2.0F * beyond.next;
        first.next += beyond.second;
    }
    if (window_.end_factor > 0) {
        const Line& beyond = line(window_.end);
        Line& last = line(window_.end - 1);
        last.gradient += beyond.gradient;
        last.diagonal += beyond.diagonal + 2.0F * last.next;
        line(window_.end - 2).next += line(window_.end - 2).second;
    }
}

// L D L^T without pivots: the matrix is positive definite.
void NewtonSystem::solve() noexcept
{
    tie_ends();
    // Couplings of the last two lines with those after them, in the matrix and in L.
    struct Passed {
        float next{0}, second{0};
        float next_of_l{0}, second_of_l{0};
        float change{0};
    };
    Passed one;
    Passed two;
    for (std::uint32_t j = window_.begin; j < window_.end; ++j) {
        Line& own = line(j);
        const float diagonal = own.diagonal * (1.0F + kRelativeDamping) + kDamping -
                               one.next * one.next_of_l - two.second * two.second_of_l;
        const float inverse = 1.0F / std::max(diagonal, kDamping);
        Passed now;
        now.next = own.next - one.next_of_l * one.second;
        now.second = own.second;
        now.next_of_l = now.next * inverse;
        now.second_of_l = now.second * inverse;
        now.change = -own.gradient - one.next_of_l * one.change - two.second_of_l * two.change;
        own = {own.gradient, inverse, now.next_of_l, now.second_of_l, now.change};
        two = one;
        one = now;
    }
    for (std::uint32_t j = window_.end; j-- > window_.begin;) {
        Line& own = line(j);
        own.change *= own.diagonal;
        own.change -= j + 1 < window_.end ? own.next * line(j + 1).change : 0.0F;
        own.change -= j + 2 < window_.end ? own.second * line(j + 2).change : 0.0F;
    }
    for (std::uint32_t j = base_; j < window_.begin; ++j) {
        line(j).change = window_.start_factor > 0 ? line(window_.begin).change : 0.0F;
    }
    line(window_.end).change = window_.end_factor > 0 ? line(window_.end - 1).change : 0.0F;
    if (window_.end_factor <= 0) {
        line(window_.end + 1).change = 0.0F;
    }
}

// Greatest -dg/g of a row's slacks for the changes of x.
LaneVec approach(const LawRow& row, const SquaredSpeed& change) noexcept
{
    const LaneVec turn =
        row.by_value * change.value + row.by_slope * change.slope + row.by_bend * change.bend;
    const LaneVec fall = row.fall * change.value;
    return larger(quotient(fall + turn, row.left - row.value),
                  quotient(fall - turn, row.left + row.value));
}

float NewtonSystem::longest(const LawSpline& spline) const noexcept
{
    LaneVec worst = all_lanes(0.0F);
    for (std::uint32_t k = base_; k < window_.end_cell(); ++k) {
        const Parts start = start_of(spline, k);
        SquaredSpeed change{};
        for (unsigned i = 0; i < 3; ++i) {
            const float z = line(k + i).change;
            change.value += start.value[i] * z;
            change.slope += start.slope[i] * z;
            change.bend += start.bend[i] * z;
        }
        for_places(spline, k, sum_of(start), [&](const PlaceRows& place) {
            const SquaredSpeed there = advanced(change, place.travel);
            LaneVec nearer = approach(place.jerk, there);
            if (place.has_acceleration) {
                nearer = larger(nearer, approach(place.acceleration, there));
            }
            worst = larger(worst, product(nearer, spline.station(k).moving));
        });
    }
    float most = greatest(kPartOfSlack, worst);
    for (std::uint32_t j = window_.begin; j < window_.end; ++j) {
        const float z = line(j).change;
        const float part = part_of_cap(spline, j);
        most = std::max(most, std::max(-z, z * part / (1.0F - part)));
    }
    return kPartOfSlack / most;
}

float NewtonSystem::apply(LawSpline& spline, float part) const noexcept
{
    float most = 0;
    for (std::uint32_t j = window_.begin; j < window_.end; ++j) {
        const float change = part * line(j).change;
        spline.coefficient(j) *= 1.0F + change;
        most = j < window_.begin + kLawAdvance ? std::max(most, std::fabs(change)) : most;
    }
    cusp::planner::tie_ends(spline, window_);
    return most;
}

}  // namespace

SquaredSpeed LawSpline::at_start(std::uint32_t k) const noexcept
{
    return sum_of(start_of(*this, k));
}

void tie_ends(LawSpline& spline, const LawWindow& window) noexcept
{
    if (window.start_factor > 0) {
        spline.coefficient(0) = window.start_factor * spline.coefficient(1);
    }
    if (window.end_factor > 0) {
        spline.coefficient(window.end) = window.end_factor * spline.coefficient(window.end - 1);
    }
}

float newton_step(LawSpline& spline, const LawWindow& window, const BarrierWeight& weight) noexcept
{
    CUSP_ASSERT(window.end - window.begin <= kMostWindow);
    NewtonSystem system{window};
    for (std::uint32_t k = window.first_cell(); k < window.end_cell(); ++k) {
        system.add_cell(spline, k, weight.rows);
    }
    for (std::uint32_t j = window.begin; j < window.end; ++j) {
        system.add_coefficient(spline, j, weight);
    }
    system.solve();
    return system.apply(spline, system.longest(spline));
}

float greatest_use(const LawSpline& spline, const LawWindow& window) noexcept
{
    float most = 0;
    for (std::uint32_t k = window.first_cell(); k < window.end_cell(); ++k) {
        for_places(spline, k, spline.at_start(k), [&most](const PlaceRows& place) {
            const float also = place.has_acceleration ? use(place.acceleration) : 0.0F;
            most = std::max({most, use(place.jerk), also});
        });
    }
    for (std::uint32_t j = window.begin; j < window.end; ++j) {
        // A slack of speed may be as small as rounding. What is no number is none, either.
        most = spline.coefficient(j) <= spline.cap(j) ? most : std::max(most, 2.0F);
    }
    return most;
}

}  // namespace cusp::planner
