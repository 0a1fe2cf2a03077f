// Divides strips in v where the symbolic distance is too large, or the bound of the length across.
#include "host_tools/cam/adaptive_isocurve/isocurve_extraction.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/cam/adaptive_isocurve/iso_distance.hpp"
#include "host_tools/geometry/part_model/bezier_cell.hpp"

namespace cusp::adaptive_isocurve {

using nurbs::BezierPatch;
using nurbs::Curve;
using nurbs::Surface;
using part_model::BezierCell;

namespace {

constexpr int kDeepestHalving = 24;
constexpr int kMostComplete = 1 << 20;

// A rectangle of the domain.
struct DomainBox {
    double u_begin, u_end, v_begin, v_end;
};

// Bounds of the speed |S_v| on the cells of a grid, for lengths on the surface along v.
class CrossSpeed {
public:
    explicit CrossSpeed(const Surface& surface)
    {
        for (const BezierPatch& patch : bezier_patches(surface)) {
            collect(BezierCell{patch, 0}, 4);
        }
    }

    // Upper bound of the lengths of all curves of constant u in the rectangle, over its v.
    double most_length(const DomainBox& box) const
    {
        std::vector<double> breaks{box.v_begin, box.v_end};
        std::vector<const Cell*> near;
        for (const Cell& cell : cells_) {
            if (cell.box.u_begin < box.u_end && cell.box.u_end > box.u_begin &&
                cell.box.v_begin < box.v_end && cell.box.v_end > box.v_begin) {
                near.push_back(&cell);
                breaks.push_back(std::clamp(cell.box.v_begin, box.v_begin, box.v_end));
            }
        }
        std::sort(breaks.begin(), breaks.end());
        // Cells lie in rows, so most breaks are equal.
        breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
        double sum = 0;
        for (std::size_t k = 1; k < breaks.size(); ++k) {
            const double middle = 0.5 * (breaks[k - 1] + breaks[k]);
            double most = 0;
            for (const Cell* cell : near) {
                if (cell->box.v_begin <= middle && middle <= cell->box.v_end) {
                    most = std::max(most, cell->speed);
                }
            }
            sum += most * (breaks[k] - breaks[k - 1]);
        }
        return sum;
    }

    // Upper bound of |S_v|.
    double most() const
    {
        double most = 0;
        for (const Cell& cell : cells_) {
            most = std::max(most, cell.speed);
        }
        return most;
    }

private:
    struct Cell {
        DomainBox box;
        double speed;
    };

    void collect(const BezierCell& cell, int halvings)
    {
        if (halvings > 0) {
            for (const BezierCell* half : cell.halves()) {
                collect(*half, halvings - 1);
            }
            return;
        }
        const double speed =
            (norm(cell.middle().dv) + cell.spread().dt) / (cell.v_end() - cell.v_begin());
        cells_.push_back({{cell.u_begin(), cell.u_end(), cell.v_begin(), cell.v_end()}, speed});
    }

    std::vector<Cell> cells_;
};

// True if the surface across a strip may be long although its sides are near at each u. On a closed
// surface the first curve is the last.
bool folds(const CrossSpeed& speed, const DomainBox& strip, double distance)
{
    return speed.most_length(strip) >= 2 * distance;
}

class Extraction {
public:
    Extraction(const Surface& surface, int number, double distance)
        : surface_{surface}, number_{number}, distance_{distance}, speed_{surface}
    {
    }

    std::vector<DomainCurve> run()
    {
        const double v0 = surface_.v_begin();
        const double v1 = surface_.v_end();
        add(v0, surface_.u_begin(), surface_.u_end());
        add(v1, surface_.u_begin(), surface_.u_end());
        fill({v0, isocurve_at_v(surface_, v0)}, {v1, isocurve_at_v(surface_, v1)},
             surface_.u_begin(), surface_.u_end(), 0);
        std::sort(out_.begin(), out_.end(), [](const DomainCurve& a, const DomainCurve& b) {
            return a.v.front() != b.v.front() ? a.v.front() < b.v.front()
                                              : a.u.front() < b.u.front();
        });
        return std::move(out_);
    }

private:
    struct Isocurve {
        double v;
        Curve curve;
    };

    void add(double v, double u_begin, double u_end)
    {
        out_.push_back(isocurve(number_, v, u_begin, u_end));
    }

    void fill(const Isocurve& a, const Isocurve& b, double begin, double end, int depth)
    {
        if (depth > kDeepestHalving) {
            return;
        }
        const ScalarSpline excess = distance_excess(a.curve, b.curve, distance_);
        const double middle = 0.5 * (a.v + b.v);
        Isocurve between{middle, {}};
        for (const ParameterRange& range : sign_ranges(excess, begin, end)) {
            if (!range.positive && !folds(speed_, {range.begin, range.end, a.v, b.v}, distance_)) {
                continue;
            }
            if (between.curve.points.empty()) {
                between.curve = isocurve_at_v(surface_, middle);
            }
            add(middle, range.begin, range.end);
            fill(a, between, range.begin, range.end, depth + 1);
            fill(between, b, range.begin, range.end, depth + 1);
        }
    }

    const Surface& surface_;
    int number_;
    double distance_;
    CrossSpeed speed_;
    std::vector<DomainCurve> out_;
};

// Fast acceptance without the symbolic distance. For a surface without weights, the difference of
// two isocurves at equal u is a curve with the differences of their control points.
bool surely_within(const Curve& a, const Curve& b, double distance)
{
    constexpr double kRounding = 1e-9;
    for (std::size_t k = 0; k < a.points.size(); ++k) {
        if (!(norm(a.points[k] - b.points[k]) < (1 - kRounding) * distance)) {
            return false;
        }
    }
    return true;
}

bool within(const Surface& surface, const CrossSpeed& speed, int strips, double distance)
{
    const double v0 = surface.v_begin();
    const double width = (surface.v_end() - v0) / strips;
    const bool slow = width * speed.most() < 2 * distance;
    for (int k = 0; k < strips && !slow; ++k) {
        if (folds(speed, {surface.u_begin(), surface.u_end(), v0 + k * width, v0 + (k + 1) * width},
                  distance)) {
            return false;
        }
    }
    const bool plain = std::all_of(surface.weights.begin(), surface.weights.end(),
                                   [](double weight) { return weight == 1; });
    Curve last = isocurve_at_v(surface, v0);
    for (int k = 1; k <= strips; ++k) {
        Curve next = isocurve_at_v(surface, v0 + k * width);
        if (!plain || !surely_within(last, next, distance)) {
            const auto ranges = sign_ranges(distance_excess(last, next, distance),
                                            surface.u_begin(), surface.u_end());
            if (std::any_of(ranges.begin(), ranges.end(),
                            [](const auto& r) { return r.positive; })) {
                return false;
            }
        }
        last = std::move(next);
    }
    return true;
}

}  // namespace

std::vector<DomainCurve> adaptive_isocurves(const Surface& surface, int number, double distance)
{
    return Extraction{surface, number, distance}.run();
}

std::vector<DomainCurve> complete_isocurves(const Surface& surface, int number, double distance)
{
    const CrossSpeed speed{surface};
    const double across =
        speed.most_length({surface.u_begin(), surface.u_end(), surface.v_begin(), surface.v_end()});
    // This estimate is no bound of the number of curves: it starts low, is doubled, then bisected.
    int few = 0;
    int sufficient =
        std::max(1, static_cast<int>(std::min<double>(kMostComplete, across / distance / 4)));
    while (sufficient < kMostComplete && !within(surface, speed, sufficient, distance)) {
        few = sufficient;
        sufficient *= 2;
    }
    while (sufficient - few > 1) {
        const int middle = few + (sufficient - few) / 2;
        (within(surface, speed, middle, distance) ? sufficient : few) = middle;
    }
    std::vector<DomainCurve> out;
    const double v0 = surface.v_begin();
    for (int k = 0; k <= sufficient; ++k) {
        const double v =
            k == sufficient ? surface.v_end() : v0 + (surface.v_end() - v0) * k / sufficient;
        out.push_back(isocurve(number, v, surface.u_begin(), surface.u_end()));
    }
    return out;
}

}  // namespace cusp::adaptive_isocurve
