// A table of the number of steps over (u, v); its level lines, strip by strip, are the passes.
#include "host_tools/adaptive_isocurve/even_spacing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cusp::host {
namespace {

constexpr std::size_t kLeastNodes = 160;
constexpr std::size_t kNodesInSpan = 4;
constexpr std::size_t kMostNodes = 800;
constexpr int kJudgeRounds = 8;
constexpr std::size_t kLooksAtNode = 2;  // of u, up to the next
constexpr double kJudged = 0.998;        // of what is allowed: the rest is for places between looks
constexpr double kNearlyRight = 1.001;
constexpr double kTighter = 1.0005;
constexpr std::size_t kTightened = 6;  // spans beside one that is made denser
constexpr double kGrown = 1.002;
constexpr double kMostGrowth = 1.05;
constexpr int kFitRounds = 2;
constexpr double kLeastFitted = 0.4;  // steps: narrower strips say little of the density
constexpr double kMostFitted = 1.2;   // times as dense, or as wide, in a round
constexpr double kFitFailed = 1.05;
constexpr double kOverlap =
    0.05;  // steps: how early a pass begins, for the interpolation of its end
constexpr double kLeastDensity = 1e-6;
constexpr double kFullStep = 0.998;  // the rest is for the interpolation between nodes

// All distinct knots, and equal parts between them.
std::vector<double> nodes_of(const std::vector<double>& knots, double begin, double end)
{
    std::vector<double> breaks{begin};
    for (const double knot : knots) {
        if (knot > breaks.back() && knot < end) {
            breaks.push_back(knot);
        }
    }
    breaks.push_back(end);
    const std::size_t spans = breaks.size() - 1;
    const std::size_t parts = std::clamp(kLeastNodes / spans + 1, kNodesInSpan,
                                         std::max(kNodesInSpan, kMostNodes / spans));
    std::vector<double> out;
    for (std::size_t k = 0; k < spans; ++k) {
        for (std::size_t part = 0; part < parts; ++part) {
            const double t = static_cast<double>(part) / static_cast<double>(parts);
            out.push_back(breaks[k] + t * (breaks[k + 1] - breaks[k]));
        }
    }
    out.push_back(end);
    return out;
}

// Steps and metric on the nodes.
class StepTable {
public:
    StepTable(const Surface& surface, const SurfaceFunction& at, const StepDensity& density)
        : u{nodes_of(surface.knots_u, surface.u_begin(), surface.u_end())},
          v{nodes_of(surface.knots_v, surface.v_begin(), surface.v_end())}
    {
        for (const double here_u : u) {
            for (const double here_v : v) {
                const SurfacePoint p = at(here_u, here_v);
                density_.push_back(density(p) / kFullStep);
                metric_.push_back({dot(p.du, p.du), dot(p.du, p.dv), dot(p.dv, p.dv)});
            }
        }
        integrate();
    }

    // Steps from the lower end of v.
    double steps(std::size_t i, double at) const
    {
        const std::size_t j = cell(at);
        const double h = v[j + 1] - v[j];
        return cubic(i, j, (at - v[j]) / h);
    }

    // The v at which so many steps are passed; it may lie a little outside the surface.
    double inverse(std::size_t i, double wanted) const
    {
        const auto row = sum_.begin() + static_cast<std::ptrdiff_t>(i * v.size());
        const auto next =
            std::upper_bound(row + 1, row + static_cast<std::ptrdiff_t>(v.size()) - 1, wanted);
        const std::size_t j = static_cast<std::size_t>(next - row) - 1;
        const std::size_t end = i * v.size() + v.size() - 1;
        // Outside by the density at the side: passes that begin early begin there.
        if (wanted < 0) {
            return v.front() + wanted / std::max(kLeastDensity, density_[i * v.size()]);
        }
        if (wanted > sum_[end]) {
            return v.back() + (wanted - sum_[end]) / std::max(kLeastDensity, density_[end]);
        }
        double low = 0;
        double high = 1;
        const double rise =
            row[static_cast<std::ptrdiff_t>(j) + 1] - row[static_cast<std::ptrdiff_t>(j)];
        double t = rise > 0
                       ? std::clamp((wanted - row[static_cast<std::ptrdiff_t>(j)]) / rise, 0.0, 1.0)
                       : 0;
        const double h = v[j + 1] - v[j];
        for (int turn = 0; turn < 30; ++turn) {
            const double off = cubic(i, j, t) - wanted;
            (off > 0 ? high : low) = t;
            const double slope =
                density_[i * v.size() + j] * (1 - t) * h + density_[i * v.size() + j + 1] * t * h;
            double next_t = slope > 0 ? t - off / slope : t;
            if (next_t < low || next_t > high) {
                next_t = 0.5 * (low + high);
            }
            if (std::abs(next_t - t) < 1e-10) {
                break;
            }
            t = next_t;
        }
        return v[j] + t * h;
    }

    // Length of a short move in the domain near the node.
    double length(std::size_t i, double at, double du, double dv) const
    {
        const std::array<double, 3>& g = metric_[i * v.size() + cell(at)];
        return std::sqrt(std::max(0.0, g[0] * du * du + 2 * g[1] * du * dv + g[2] * dv * dv));
    }

    // The density as the strips between the curves ask for it: where passes slant, steps may be
    // wider than across isocurves, and where the bend changes between them, narrower.
    void fit(const std::vector<DomainCurve>& curves, const StripJudge& judge)
    {
        std::vector<double> factor(density_.size(), 1.0);
        for (std::size_t i = 0; i < u.size(); ++i) {
            const std::vector<CurvePlace> across = places_at(curves, u[i]);
            double* row = &factor[i * v.size()];
            std::size_t j = 0;
            double last_v = v.front();
            double last = 0;
            for (std::size_t k = 1; k < across.size(); ++k) {
                const double width = steps(i, across[k].v) - steps(i, across[k - 1].v);
                if (width < kLeastFitted) {
                    continue;
                }
                const double asked = judge(u[i], across[k - 1], across[k]) / width;
                const double here = std::clamp(asked, 1 / kMostFitted, kMostFitted);
                const double here_v = 0.5 * (across[k - 1].v + across[k].v);
                last = last == 0 ? here : last;
                for (; j < v.size() && v[j] <= here_v; ++j) {
                    row[j] =
                        last + (here - last) * (v[j] - last_v) / std::max(1e-300, here_v - last_v);
                }
                last_v = here_v;
                last = here;
            }
            if (last > 0) {
                std::fill(row + j, row + v.size(), last);
            }
        }
        smooth(factor, v.size(), 1, u.size(), v.size());
        smooth(factor, 1, v.size(), v.size(), u.size());
        for (std::size_t k = 0; k < density_.size(); ++k) {
            density_[k] *= factor[k];
        }
        integrate();
    }

    // The factor asked for between nodes of u, at a place of v; kept for `tighten`.
    void ask(std::size_t i, double at, double factor)
    {
        asked_.resize(density_.size(), 1.0);
        const std::size_t j = cell(at);
        for (const std::size_t k : {i * v.size() + j, (i + 1) * v.size() + j}) {
            asked_[k] = std::max(asked_[k], factor);
            asked_[k + 1] = std::max(asked_[k + 1], factor);
        }
    }

    // Denser where it was asked for and round about.
    void tighten()
    {
        for (int turn = 0; turn < 2; ++turn) {
            raise(asked_, v.size(), 1, u.size(), v.size());
            raise(asked_, 1, v.size(), v.size(), u.size());
        }
        smooth(asked_, v.size(), 1, u.size(), v.size());
        smooth(asked_, 1, v.size(), v.size(), u.size());
        for (std::size_t k = 0; k < density_.size(); ++k) {
            density_[k] *= asked_[k];
        }
        asked_.clear();
        integrate();
    }

    // Everywhere alike: a place made denser alone would push all passes beyond it aside.
    void grow(double factor)
    {
        for (double& density : density_) {
            density *= factor;
        }
        integrate();
    }

    void integrate()
    {
        sum_.assign(density_.size(), 0.0);
        for (std::size_t i = 0; i < u.size(); ++i) {
            for (std::size_t j = 1; j < v.size(); ++j) {
                const std::size_t k = i * v.size() + j;
                sum_[k] = sum_[k - 1] + 0.5 * (density_[k - 1] + density_[k]) * (v[j] - v[j - 1]);
            }
        }
    }

    std::vector<double> u;
    std::vector<double> v;

private:
    // Mean of each value, doubled, and its neighbours, along lines of values `stride` apart.
    static void smooth(std::vector<double>& values,
                       std::size_t stride,
                       std::size_t line_stride,
                       std::size_t count,
                       std::size_t lines)
    {
        for (std::size_t line = 0; line < lines; ++line) {
            double* at = &values[line * line_stride];
            double before = at[0];
            for (std::size_t k = 0; k + 1 < count; ++k) {
                const double here = at[k * stride];
                at[k * stride] = 0.25 * (before + 2 * here + at[(k + 1) * stride]);
                before = here;
            }
        }
    }

    // The largest of each value and its neighbours.
    static void raise(std::vector<double>& values,
                      std::size_t stride,
                      std::size_t line_stride,
                      std::size_t count,
                      std::size_t lines)
    {
        for (std::size_t line = 0; line < lines; ++line) {
            double* at = &values[line * line_stride];
            double before = at[0];
            for (std::size_t k = 0; k < count; ++k) {
                const double here = at[k * stride];
                const double after = k + 1 < count ? at[(k + 1) * stride] : here;
                at[k * stride] = std::max({before, here, after});
                before = here;
            }
        }
    }

    std::size_t cell(double at) const
    {
        const auto next = std::upper_bound(v.begin() + 1, v.end() - 1, at);
        return static_cast<std::size_t>(next - v.begin()) - 1;
    }

    // The integral of the density, itself linear between nodes.
    double cubic(std::size_t i, std::size_t j, double t) const
    {
        const std::size_t k = i * v.size() + j;
        const double h = v[j + 1] - v[j];
        return sum_[k] + h * t * (density_[k] + 0.5 * t * (density_[k + 1] - density_[k]));
    }

    std::vector<double> density_;
    std::vector<double> asked_;
    std::vector<double> sum_;
    std::vector<std::array<double, 3>> metric_;
};

// Isocurves that cut the surface into strips of equal numbers of steps, on the average over u.
std::vector<double> strip_sides(const StepTable& table, int strips)
{
    std::vector<double> sides{table.v.front()};
    for (int k = 1; k < strips; ++k) {
        double sum = 0;
        for (std::size_t i = 0; i < table.u.size(); ++i) {
            sum += table.inverse(i, table.steps(i, table.v.back()) * k / strips);
        }
        sides.push_back(sum / static_cast<double>(table.u.size()));
    }
    sides.push_back(table.v.back());
    return sides;
}

// An end that was found between nodes is only nearly right: close to a node it would bend the
// curve.
void drop_crowded_nodes(DomainCurve& curve)
{
    constexpr double kCrowded = 0.4;
    const auto drop = [&](std::size_t end, std::size_t node, std::size_t next) {
        if (std::abs(curve.u[node] - curve.u[end]) <
            kCrowded * std::abs(curve.u[next] - curve.u[node])) {
            curve.u.erase(curve.u.begin() + static_cast<std::ptrdiff_t>(node));
            curve.v.erase(curve.v.begin() + static_cast<std::ptrdiff_t>(node));
        }
    };
    if (curve.u.size() >= 3) {
        drop(0, 1, 2);
    }
    if (curve.u.size() >= 3) {
        const std::size_t last = curve.u.size() - 1;
        drop(last, last - 1, last - 2);
    }
}

enum class Anchor { kSides, kMiddle };

// The passes of one strip, without its sides.
class Strip {
public:
    Strip(const StepTable& table, double low, double high, Anchor anchor, int number)
        : table_{table}, anchor_{anchor}, number_{number}
    {
        for (std::size_t i = 0; i < table.u.size(); ++i) {
            first_.push_back(table.steps(i, low));
            width_.push_back(table.steps(i, high) - first_.back());
        }
    }

    std::vector<DomainCurve> curves() const
    {
        std::vector<DomainCurve> out;
        const double widest = *std::max_element(width_.begin(), width_.end());
        const int most = static_cast<int>(std::floor(0.5 * widest));
        if (anchor_ == Anchor::kMiddle) {
            if (widest > 1) {
                trace(0, 0, kAlways, out);
            }
            for (int k = 1; k <= most; ++k) {
                trace(0, k, {2.0 * k - kOverlap, kEndless}, out);
                trace(0, -k, {2.0 * k - kOverlap, kEndless}, out);
            }
            return out;
        }
        for (int k = 1; k <= most; ++k) {
            trace(-1, k, {2.0 * k - kOverlap, kEndless}, out);
            trace(1, -k, {2.0 * k - kOverlap, kEndless}, out);
        }
        for (int k = 0; k <= most; ++k) {
            trace(0, 0, {2.0 * k + 1 - kOverlap, 2.0 * k + 2 + kOverlap}, out);
        }
        return out;
    }

    double length() const
    {
        double sum = 0;
        for (std::size_t i = 0; i + 1 < table_.u.size(); ++i) {
            const double du = table_.u[i + 1] - table_.u[i];
            const int most = static_cast<int>(std::floor(0.5 * std::min(width_[i], width_[i + 1])));
            const auto add = [&](int side, int steps) {
                const double a = v_of(i, side, steps);
                sum += table_.length(i, a, du, v_of(i + 1, side, steps) - a);
            };
            for (int k = 1; k <= most; ++k) {
                add(anchor_ == Anchor::kMiddle ? 0 : -1, k);
                add(anchor_ == Anchor::kMiddle ? 0 : 1, -k);
            }
            if (anchor_ == Anchor::kMiddle || width_[i] - 2 * most > 1) {
                add(0, 0);
            }
        }
        return sum;
    }

private:
    static constexpr double kEndless = std::numeric_limits<double>::infinity();
    struct Range {
        double above;
        double up_to;
    };
    static constexpr Range kAlways{-1, kEndless};

    // side -1: from the low side, 0: from the middle, 1: from the high side.
    double v_of(std::size_t i, int side, double steps) const
    {
        const double from = first_[i] + 0.5 * (side + 1) * width_[i];
        return table_.inverse(i, from + steps);
    }

    // One curve for each run of u over which the strip's width lies in the range.
    void trace(int side, double steps, Range range, std::vector<DomainCurve>& out) const
    {
        DomainCurve curve{number_, {}, {}};
        const auto close = [&] {
            if (curve.u.size() >= 2) {
                drop_crowded_nodes(curve);
                out.push_back(curve);
            }
            curve.u.clear();
            curve.v.clear();
        };
        const auto add = [&](double u, double v) {
            if (curve.u.empty() ||
                u > curve.u.back() + 1e-9 * (table_.u.back() - table_.u.front())) {
                curve.u.push_back(u);
                curve.v.push_back(v);
            }
        };
        for (std::size_t i = 0; i < table_.u.size(); ++i) {
            const bool in = width_[i] > range.above && width_[i] <= range.up_to;
            if (i > 0) {
                add_crossings(i - 1, side, steps, range, in, add, close);
            }
            if (in) {
                add(table_.u[i], v_of(i, side, steps));
            }
        }
        close();
    }

    // Where the width enters or leaves the range between two nodes; it is taken as linear there.
    template <class Add, class Close>
    void add_crossings(std::size_t i,
                       int side,
                       double steps,
                       Range range,
                       bool in_at_end,
                       const Add& add,
                       const Close& close) const
    {
        std::array<double, 2> at{};
        std::size_t count = 0;
        for (const double level : {range.above, range.up_to}) {
            const double t = (level - width_[i]) / (width_[i + 1] - width_[i]);
            if ((width_[i] > level) != (width_[i + 1] > level)) {
                at[count++] = t;
            }
        }
        if (count == 2 && at[1] < at[0]) {
            std::swap(at[0], at[1]);
        }
        bool in = (count % 2 == 0) == in_at_end;
        for (std::size_t k = 0; k < count; ++k) {
            const double t = at[k];
            const double u = table_.u[i] + t * (table_.u[i + 1] - table_.u[i]);
            // Both nodes know the level even where the pass is beyond the middle there.
            const double v = v_of(i, side, steps) * (1 - t) + v_of(i + 1, side, steps) * t;
            add(u, v);
            in = !in;
            if (!in) {
                close();
            }
        }
    }

    const StepTable& table_;
    Anchor anchor_;
    int number_;
    std::vector<double> first_;
    std::vector<double> width_;
};

struct Plan {
    std::vector<double> sides;
    std::vector<Anchor> anchors;
    double length;
};

Plan shortest_plan(const StepTable& table)
{
    double most = 0;
    for (std::size_t i = 0; i < table.u.size(); ++i) {
        most = std::max(most, table.steps(i, table.v.back()));
    }
    Plan best{{}, {}, std::numeric_limits<double>::infinity()};
    for (int strips = 1; strips == 1 || strips * 4 <= most; strips *= 2) {
        Plan plan{strip_sides(table, strips), {}, 0};
        for (std::size_t k = 0; k + 1 < plan.sides.size(); ++k) {
            const double from_sides =
                Strip{table, plan.sides[k], plan.sides[k + 1], Anchor::kSides, 0}.length();
            const double from_middle =
                Strip{table, plan.sides[k], plan.sides[k + 1], Anchor::kMiddle, 0}.length();
            plan.anchors.push_back(from_sides <= from_middle ? Anchor::kSides : Anchor::kMiddle);
            plan.length += std::min(from_sides, from_middle);
        }
        for (const double side : plan.sides) {
            for (std::size_t i = 0; i + 1 < table.u.size(); ++i) {
                plan.length += table.length(i, side, table.u[i + 1] - table.u[i], 0);
            }
        }
        if (plan.length >= 1.1 * best.length) {
            break;
        }
        if (plan.length < best.length) {
            best = std::move(plan);
        }
    }
    return best;
}

std::vector<DomainCurve> curves_of(const StepTable& table, const Plan& plan, int number)
{
    std::vector<DomainCurve> out;
    for (std::size_t k = 0; k < plan.sides.size(); ++k) {
        out.push_back(isocurve(number, plan.sides[k], table.u.front(), table.u.back()));
        if (k < plan.anchors.size()) {
            const Strip strip{table, plan.sides[k], plan.sides[k + 1], plan.anchors[k], number};
            for (DomainCurve& curve : strip.curves()) {
                out.push_back(std::move(curve));
            }
        }
    }
    return out;
}

// The largest factor asked for, at the nodes of u and between them.
//
// look  spans between nodes of u to look at; then those that `tighten` changes
double judge_strips(StepTable& table,
                    const std::vector<DomainCurve>& curves,
                    const StripJudge& judge,
                    std::vector<bool>& look)
{
    double worst = 0;
    std::vector<bool> changed(look.size(), false);
    for (std::size_t i = 0; i < look.size(); ++i) {
        const std::size_t looks = i + 1 < look.size() ? kLooksAtNode : kLooksAtNode + 1;
        for (std::size_t n = 0; look[i] && n < looks; ++n) {
            const double t = static_cast<double>(n) / static_cast<double>(kLooksAtNode);
            const double u = table.u[i] * (1 - t) + table.u[i + 1] * t;
            const std::vector<CurvePlace> across = places_at(curves, u);
            for (std::size_t k = 1; k < across.size(); ++k) {
                const double asked = judge(u, across[k - 1], across[k]) / kJudged;
                worst = std::max(worst, asked);
                if (asked > 1) {
                    table.ask(i, 0.5 * (across[k - 1].v + across[k].v), kTighter * asked);
                    const std::size_t end = std::min(look.size(), i + kTightened + 1);
                    for (std::size_t m = i < kTightened ? 0 : i - kTightened; m < end; ++m) {
                        changed[m] = true;
                    }
                }
            }
        }
    }
    look = std::move(changed);
    return worst;
}

}  // namespace

EvenSpacing even_passes(const Surface& surface,
                        int number,
                        const SurfaceFunction& at,
                        const StepDensity& density,
                        const StripJudge& judge)
{
    StepTable table{surface, at, density};
    const Plan first = shortest_plan(table);
    const StepTable unfitted = table;
    Plan plan = first;
    EvenSpacing out{curves_of(table, plan, number), 0};
    for (int round = 0; judge && round < kFitRounds; ++round) {
        table.fit(out.curves, judge);
        plan.sides = strip_sides(table, static_cast<int>(plan.anchors.size()));
        out.curves = curves_of(table, plan, number);
    }
    std::vector<bool> look(table.u.size() - 1, true);
    for (int round = 0; judge && round < kJudgeRounds; ++round) {
        out.worst = judge_strips(table, out.curves, judge, look);
        if (out.worst <= kNearlyRight) {
            break;
        }
        if (round == 0 && out.worst > kFitFailed) {
            // Passes that slant much slant more with every fit.
            table = unfitted;
            plan = first;
            look.assign(look.size(), true);
        } else if (round + 1 < kJudgeRounds) {
            table.tighten();
        } else {
            table.grow(kGrown * std::min(kMostGrowth, out.worst));
        }
        out.curves = curves_of(table, plan, number);
    }
    return out;
}

}  // namespace cusp::host
