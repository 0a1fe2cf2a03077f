// Passes are level lines of the number of steps over (u, v), strip by strip.
#include "host_tools/cam/adaptive_isocurve/equal_scallop_passes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "host_tools/cam/adaptive_isocurve/density_table.hpp"

namespace cusp::adaptive_isocurve {

using nurbs::Surface;

namespace {

constexpr int kJudgeRounds = 24;
constexpr std::size_t kSamplesPerNode = 2;  // of u
constexpr double kJudged = 0.996;           // of what is allowed: reserve between samples
constexpr double kNearlyRight = 1.001;
constexpr double kTighter = 1.0005;
constexpr std::size_t kTightened = 6;    // spans beside one that becomes denser
constexpr std::size_t kLengthNodes = 4;  // lengths are measured at every fourth node of u
constexpr int kFitRounds = 2;
constexpr double kFitFailed = 1.05;
// In steps: how early a pass begins, for the interpolation of its end.
constexpr double kOverlap = 0.15;

// Isocurves that divide the surface into strips of equal numbers of steps, on average over u.
std::vector<double> strip_sides(const DensityTable& table, int strips)
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

// An end found between nodes is not exact: close to a node it would bend the curve. Such a node is
// dropped.
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
    Strip(const DensityTable& table, double low, double high, Anchor anchor, int number)
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
                trace(0, k, {2.0 * k - kOverlap, kInfinite}, out);
                trace(0, -k, {2.0 * k - kOverlap, kInfinite}, out);
            }
            return out;
        }
        for (int k = 1; k <= most; ++k) {
            trace(-1, k, {2.0 * k - kOverlap, kInfinite}, out);
            trace(1, -k, {2.0 * k - kOverlap, kInfinite}, out);
        }
        for (int k = 0; k <= most; ++k) {
            trace(0, 0, {2.0 * k + 1 - kOverlap, 2.0 * k + 2 + kOverlap}, out);
        }
        return out;
    }

    // The approximate length of the passes, to compare plans.
    double length() const
    {
        const bool from_middle = anchor_ == Anchor::kMiddle;
        const int side = from_middle ? 0 : 1;
        const double widest = *std::max_element(width_.begin(), width_.end());
        const std::size_t most = static_cast<std::size_t>(std::max(0.0, std::floor(0.5 * widest)));
        // v of the passes in the middle, below and above, at the last node and at this one;
        // kInfinite where there is no such pass.
        std::vector<double> last(2 * most + 1, kInfinite);
        std::vector<double> here(last.size(), kInfinite);
        double sum = 0;
        std::size_t before = 0;
        for (std::size_t i = 0; i < table_.u.size();
             i = i + 1 < table_.u.size() ? std::min(i + kLengthNodes, table_.u.size() - 1)
                                         : table_.u.size()) {
            const int count = static_cast<int>(std::floor(0.5 * width_[i]));
            here.front() = v_of(i, 0, 0);
            for (std::size_t k = 1; k <= most; ++k) {
                const int steps = static_cast<int>(k);
                here[2 * k - 1] = steps <= count ? v_of(i, -side, steps) : kInfinite;
                here[2 * k] = steps <= count ? v_of(i, side, -steps) : kInfinite;
            }
            const double middle_width =
                width_[before] - 2 * std::floor(0.5 * std::min(width_[before], width_[i]));
            const std::size_t first = from_middle || middle_width > 1 ? 0 : 1;
            for (std::size_t k = first; i > 0 && k < here.size(); ++k) {
                if (last[k] != kInfinite && here[k] != kInfinite) {
                    sum += table_.length(before, last[k], table_.u[i] - table_.u[before],
                                         here[k] - last[k]);
                }
            }
            last.swap(here);
            before = i;
        }
        return sum;
    }

private:
    struct Range {
        double above;
        double up_to;
    };
    static constexpr Range kAlways{-1, kInfinite};

    // The v at `steps` from a side of the strip. side  -1: low side, 0: middle, 1: high side
    double v_of(std::size_t i, int side, double steps) const
    {
        const double from = first_[i] + 0.5 * (side + 1) * width_[i];
        return table_.inverse(i, from + steps);
    }

    // Adds a curve for each interval of u in which the strip's width lies in the range.
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

    // Adds the ends where the width enters or leaves the range between two nodes, as if linear.
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
        for (const double bound : {range.above, range.up_to}) {
            const double t = (bound - width_[i]) / (width_[i + 1] - width_[i]);
            if ((width_[i] > bound) != (width_[i + 1] > bound)) {
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
            // v_of() is defined at both nodes, even where the pass would be beyond the middle.
            const double v = v_of(i, side, steps) * (1 - t) + v_of(i + 1, side, steps) * t;
            add(u, v);
            in = !in;
            if (!in) {
                close();
            }
        }
    }

    const DensityTable& table_;
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

Plan shortest_plan(const DensityTable& table)
{
    double most = 0;
    for (std::size_t i = 0; i < table.u.size(); ++i) {
        most = std::max(most, table.steps(i, table.v.back()));
    }
    Plan best{{}, {}, kInfinite};
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

std::vector<DomainCurve> curves_of(const DensityTable& table, const Plan& plan, int number)
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

// Returns the largest factor of the judge, at the nodes of u and between them.
//
// look  the spans between nodes of u to be judged; set to those that tighten() will change
double judge_strips(DensityTable& table,
                    const std::vector<DomainCurve>& curves,
                    const StripJudge& judge,
                    std::vector<bool>& look)
{
    double worst = 0;
    std::vector<bool> changed(look.size(), false);
    for (std::size_t i = 0; i < look.size(); ++i) {
        const std::size_t samples = i + 1 < look.size() ? kSamplesPerNode : kSamplesPerNode + 1;
        for (std::size_t n = 0; look[i] && n < samples; ++n) {
            const double t = static_cast<double>(n) / static_cast<double>(kSamplesPerNode);
            const double u = table.u[i] * (1 - t) + table.u[i + 1] * t;
            const std::vector<CurvePlace> across = places_at(curves, u);
            for (std::size_t k = 1; k < across.size(); ++k) {
                const double asked = judge(u, across[k - 1], across[k], kJudged) / kJudged;
                worst = std::max(worst, asked);
                if (asked > 1) {
                    table.require(i, 0.5 * (across[k - 1].v + across[k].v), kTighter * asked);
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

EqualScallopPasses equal_scallop_passes(const Surface& surface,
                                        int number,
                                        const SurfaceFunction& at,
                                        const StepDensity& density,
                                        const StripJudge& judge)
{
    DensityTable table{surface, at, density};
    const Plan first = shortest_plan(table);
    const DensityTable unfitted = table;
    Plan plan = first;
    EqualScallopPasses out{curves_of(table, plan, number), 0};
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
            // Fitting fails for steep slants: each round makes passes slant more.
            table = unfitted;
            plan = first;
            look.assign(look.size(), true);
        } else {
            table.tighten();
        }
        out.curves = curves_of(table, plan, number);
    }
    return out;
}

}  // namespace cusp::adaptive_isocurve
