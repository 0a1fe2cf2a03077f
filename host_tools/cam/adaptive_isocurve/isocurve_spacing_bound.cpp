// Intervals of u, halved until the sag of the difference of two curves is small.
#include "host_tools/cam/adaptive_isocurve/isocurve_spacing_bound.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::adaptive_isocurve {

using nurbs::BezierPatch;
using nurbs::Surface;
using nurbs::SurfacePoint;
using part_model::BezierCell;
using part_model::PartModel;

namespace {

constexpr std::size_t kLeaves = 4096;  // of the surface, about
constexpr int kMostHalvings = 5;       // of a patch
constexpr double kSharp = 1e-3;
constexpr int kSpanHalvings = 24;

using Cubic = std::array<double, 4>;

std::array<Cubic, 2> halves_of(const Cubic& c)
{
    const double a = 0.5 * (c[0] + c[1]);
    const double b = 0.5 * (c[1] + c[2]);
    const double d = 0.5 * (c[2] + c[3]);
    const double e = 0.5 * (a + b);
    const double f = 0.5 * (b + d);
    const double middle = 0.5 * (e + f);
    return {{{c[0], a, e, middle}, {middle, f, d, c[3]}}};
}

// The cubic of the curve from u0 to u1. Precondition: no node of the curve lies between.
Cubic cubic_of(const DomainCurve& curve, double u0, double u1)
{
    const CurvePlace from = curve.place_at(u0);
    const CurvePlace to = curve.place_at(u1);
    const double third = (u1 - u0) / 3;
    return {from.v, from.v + from.slope * third, to.v - to.slope * third, to.v};
}

double most_of(double a, double b, double c)
{
    return std::max({std::abs(a), std::abs(b), std::abs(c)});
}

// True if the second is proved to be nowhere below the first.
bool in_order(const Cubic& low, const Cubic& high)
{
    return low[0] <= high[0] && low[1] <= high[1] && low[2] <= high[2] && low[3] <= high[3];
}

// All ends and nodes, in order.
std::vector<double> breaks_of(const std::vector<DomainCurve>& curves)
{
    std::vector<double> out;
    for (const DomainCurve& curve : curves) {
        out.insert(out.end(), curve.u.begin(), curve.u.end());
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

std::size_t span_at(const std::vector<double>& breaks, double at)
{
    const auto next = std::upper_bound(breaks.begin() + 1, breaks.end(), at);
    return static_cast<std::size_t>(next - breaks.begin()) - 1;
}

}  // namespace

IsocurveSpacingBound::IsocurveSpacingBound(const Surface& surface,
                                           const PartModel& model,
                                           int number)
    : model_{model}, number_{number}, v_begin_{surface.v_begin()}, v_end_{surface.v_end()}
{
    const std::vector<BezierPatch> patches = bezier_patches(surface);
    int halvings = 0;
    while (halvings < kMostHalvings && (patches.size() << (halvings + 1)) <= kLeaves) {
        ++halvings;
    }
    for (const BezierPatch& patch : patches) {
        if (breaks_u_.empty() || patch.u_begin > breaks_u_.back()) {
            breaks_u_.push_back(patch.u_begin);
        }
        if (breaks_u_.size() == 1) {
            breaks_v_.push_back(patch.v_begin);
        }
        patches_.emplace_back();
        collect(BezierCell{patch, 0}, halvings, patches_.back());
    }
}

void IsocurveSpacingBound::collect(const BezierCell& cell,
                                   int halvings,
                                   std::vector<Leaf>& out) const
{
    if (halvings > 0) {
        for (const BezierCell* half : cell.halves()) {
            collect(*half, halvings - 1, out);
        }
        return;
    }
    const double width_u = cell.u_end() - cell.u_begin();
    const double width_v = cell.v_end() - cell.v_begin();
    const SurfacePoint& p = cell.middle();
    const BezierCell::Spread& e = cell.spread();
    out.push_back({cell.u_begin(), cell.u_end(), cell.v_begin(), cell.v_end(),
                   (norm(p.dv) + e.dt) / width_v, (norm(p.duu) + e.dss) / (width_u * width_u),
                   (norm(p.duv) + e.dst) / (width_u * width_v),
                   (norm(p.dvv) + e.dtt) / (width_v * width_v)});
}

// Bound of the second derivative by u of the curve on the surface. Beyond the border of the domain
// a curve runs along the border. It has a kink where it enters, which counts as a second derivative
// with the same sag.
double IsocurveSpacingBound::bend_over(double u0, double u1, const Cubic& v) const
{
    const auto [least, greatest] = std::minmax_element(v.begin(), v.end());
    const double low = std::clamp(*least, v_begin_, v_end_);
    const double high = std::clamp(*greatest, v_begin_, v_end_);
    const double h = u1 - u0;
    const bool inside = high > low;
    const double slope = inside ? 3 / h * most_of(v[1] - v[0], v[2] - v[1], v[3] - v[2]) : 0;
    const double turn =
        inside ? 6 / (h * h) * most_of(v[2] - 2 * v[1] + v[0], v[3] - 2 * v[2] + v[1], 0) : 0;
    const double kinks = (*least < low ? 1 : 0) + (*greatest > high ? 1 : 0);
    double most = 0;
    for (std::size_t i = span_at(breaks_u_, u0); i < breaks_u_.size() && breaks_u_[i] <= u1; ++i) {
        for (std::size_t j = span_at(breaks_v_, low); j < breaks_v_.size() && breaks_v_[j] <= high;
             ++j) {
            for (const Leaf& leaf : patches_[i * breaks_v_.size() + j]) {
                if (leaf.u0 <= u1 && leaf.u1 >= u0 && leaf.v0 <= high && leaf.v1 >= low) {
                    most =
                        std::max(most, leaf.duu + 2 * leaf.duv * slope + leaf.dvv * slope * slope +
                                           leaf.dv * turn + kinks * 2 * leaf.dv * slope / h);
                }
            }
        }
    }
    return most;
}

// strands  in order of v at the middle. Those that may cross form a group; all members of a group
//          count as neighbours of each other and of the next group's members
double IsocurveSpacingBound::over_interval(
    double u0, double u1, const std::vector<Strand>& strands, double allowed, int depth) const
{
    const double sag = (u1 - u0) * (u1 - u0) / 8;
    double most = 0;
    std::vector<bool> open(strands.size(), false);
    const auto measure = [&](std::size_t a, std::size_t b, bool neighbours) {
        const Strand& one = strands[a];
        const Strand& other = strands[b];
        const double more = sag * (one.bend + other.bend);
        const double bound = std::max(norm(other.from - one.from), norm(other.to - one.to)) + more;
        const bool settled = bound <= allowed || (neighbours && more <= kSharp * allowed);
        if (settled || depth == kSpanHalvings) {
            most = std::max(most, bound);
        } else {
            open[a] = open[b] = true;
        }
    };
    const std::vector<std::size_t> first = first_of_groups(strands);
    for (std::size_t g = 0; g + 1 < first.size(); ++g) {
        const std::size_t end = first[std::min(g + 2, first.size() - 1)];
        const bool single = end - first[g] == std::min<std::size_t>(2, first.size() - 1 - g);
        for (std::size_t a = first[g]; a < first[g + 1]; ++a) {
            for (std::size_t b = a + 1; b < end; ++b) {
                measure(a, b, single);
            }
        }
    }
    if (std::find(open.begin(), open.end(), true) != open.end()) {
        // Open groups are divided as a whole, since their strands may cross.
        for (std::size_t g = 0; g + 1 < first.size(); ++g) {
            const auto from = open.begin() + static_cast<std::ptrdiff_t>(first[g]);
            const auto to = open.begin() + static_cast<std::ptrdiff_t>(first[g + 1]);
            if (std::find(from, to, true) != to) {
                std::fill(from, to, true);
            }
        }
    }
    for (std::size_t k = 0; k < strands.size(); ++k) {
        std::vector<Strand> run;
        for (; k < strands.size() && open[k]; ++k) {
            run.push_back(strands[k]);
        }
        if (!run.empty()) {
            most = std::max(most, over_halves(u0, u1, run, allowed, depth + 1));
        }
    }
    return most;
}

double IsocurveSpacingBound::over_halves(
    double u0, double u1, const std::vector<Strand>& strands, double allowed, int depth) const
{
    const double middle = 0.5 * (u0 + u1);
    std::vector<Strand> lower;
    std::vector<Strand> upper;
    for (const Strand& whole : strands) {
        const std::array<Cubic, 2> v = halves_of(whole.v);
        const Vec3d point = model_.tangents(number_, middle, v[1][0]).point;
        lower.push_back({v[0], whole.from, point, bend_over(u0, middle, v[0])});
        upper.push_back({v[1], point, whole.to, bend_over(middle, u1, v[1])});
    }
    std::stable_sort(lower.begin(), lower.end(), by_middle);
    std::stable_sort(upper.begin(), upper.end(), by_middle);
    return std::max(over_interval(u0, middle, lower, allowed, depth),
                    over_interval(middle, u1, upper, allowed, depth));
}

// The indices of the first strands of all groups, and the end: everything before such a strand is
// proved to be below it.
std::vector<std::size_t> IsocurveSpacingBound::first_of_groups(const std::vector<Strand>& strands)
{
    std::vector<Cubic> least_from(strands.size());
    for (std::size_t k = strands.size(); k-- > 0;) {
        least_from[k] = strands[k].v;
        for (std::size_t i = 0; k + 1 < strands.size() && i < 4; ++i) {
            least_from[k][i] = std::min(least_from[k][i], least_from[k + 1][i]);
        }
    }
    std::vector<std::size_t> out;
    Cubic most{-kInfinite, -kInfinite, -kInfinite, -kInfinite};
    for (std::size_t k = 0; k < strands.size(); ++k) {
        if (in_order(most, least_from[k])) {
            out.push_back(k);
        }
        for (std::size_t i = 0; i < 4; ++i) {
            most[i] = std::max(most[i], strands[k].v[i]);
        }
    }
    out.push_back(strands.size());
    return out;
}

bool IsocurveSpacingBound::by_middle(const Strand& a, const Strand& b)
{
    const auto middle = [](const Cubic& v) {
        return v[0] + 3 * (v[1] + v[2]) + v[3];
    };
    return middle(a.v) < middle(b.v);
}

double IsocurveSpacingBound::over(const std::vector<DomainCurve>& curves, double allowed) const
{
    const std::vector<double> breaks = breaks_of(curves);
    double most = 0;
    for (std::size_t k = 1; k < breaks.size(); ++k) {
        const double u0 = breaks[k - 1];
        const double u1 = breaks[k];
        std::vector<Strand> strands;
        for (const DomainCurve& curve : curves) {
            if (curve.u.front() <= u0 && curve.u.back() >= u1) {
                const Cubic v = cubic_of(curve, u0, u1);
                strands.push_back({v, model_.tangents(number_, u0, v[0]).point,
                                   model_.tangents(number_, u1, v[3]).point, bend_over(u0, u1, v)});
            }
        }
        std::sort(strands.begin(), strands.end(), by_middle);
        most = std::max(most, over_interval(u0, u1, strands, allowed, 0));
    }
    return most;
}

}  // namespace cusp::adaptive_isocurve
