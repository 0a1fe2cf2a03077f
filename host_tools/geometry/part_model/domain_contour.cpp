// Crossings of a lattice's sides, chained, then divided until the polyline follows the contour.
#include "host_tools/geometry/part_model/domain_contour.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "host_tools/geometry/part_model/cell_chains.hpp"
#include "host_tools/geometry/part_model/contour_lattice.hpp"
#include "host_tools/geometry/part_model/surface_length.hpp"

namespace cusp::part_model {

using nurbs::Surface;

namespace {

constexpr double kSamplePitch = 0.5;  // mm
constexpr int kFewestSamples = 24;
constexpr int kMostSamples = 128;
constexpr int kFewestHalvings = 2;
constexpr double kRounding = 1e-8;    // of a side of the lattice
constexpr double kSnap = 1e-9;        // of the domain's sides
constexpr double kZeroMargin = 1e-7;  // mm
constexpr int kSecantSteps = 12;      // then by bisection: the margin jumps
constexpr int kDeepestDivision = 24;
constexpr double kFirstReach = 1.0 / 32;  // of a side: first distance of the search for the contour
constexpr double kLastReach = 8;          // of a side: last one, across a slender tip
constexpr std::size_t kMostDropped = 64;  // points in a row that one side replaces

class ContourTracer {
public:
    ContourTracer(const Surface& surface, const DomainMargin& margin, double edge_error)
        : surface_{surface},
          edge_error_{edge_error},
          low_{surface.u_begin(), surface.v_begin()},
          size_{surface.u_end() - surface.u_begin(), surface.v_end() - surface.v_begin()},
          lattice_{low_, size_, samples_over(surface), margin}
    {
    }

    std::vector<std::vector<Vec2d>> contours()
    {
        std::vector<std::vector<Vec2d>> loops;
        bool followed = false;
        for (int k = 1; !followed && lattice_.may_halve(); ++k) {
            const bool is_new = lattice_.halve();
            if (k >= kFewestHalvings && !(is_new && lattice_.may_halve())) {
                loops.clear();
                followed = trace(loops);
            }
        }
        return loops;
    }

private:
    // Returns whether the sides follow the contour within the error.
    bool trace(std::vector<std::vector<Vec2d>>& loops)
    {
        follows_ = true;
        for (const std::vector<GridSide>& chain : lattice_.chains()) {
            std::vector<Vec2d> loop = simplified(divided(turned_left(chain)));
            if (encloses_something(loop)) {
                loops.push_back(std::move(loop));
            }
        }
        return follows_;
    }

    // False where the loop is on average so narrow that readers of trims take it for rounding.
    bool encloses_something(const std::vector<Vec2d>& loop) const
    {
        constexpr double kNarrow = 2e-5;  // of the domain's larger side
        double area = 0;
        double length = 0;
        for (std::size_t i = 1; i < loop.size(); ++i) {
            area += 0.5 * cross(loop[i - 1] - low_, loop[i] - low_);
            length += norm(loop[i] - loop[i - 1]);
        }
        return std::abs(area) > kNarrow * std::max(size_.x, size_.y) * length;
    }

    // The last point inside on the segment from `in` to `out`, or one with a margin of nearly 0, by
    // false position (Illinois algorithm), or by bisection where the margin jumps.
    Vec2d last_within(Vec2d in, double in_margin, Vec2d out, double out_margin) const
    {
        double from = 0;
        double to = 1;
        double in_weight = 1;
        double out_weight = 1;
        bool was_within = false;
        bool was_beyond = false;
        for (int step = 0; to - from > kRounding && in_margin > kZeroMargin; ++step) {
            const double a = in_weight * in_margin;
            const double b = out_weight * out_margin;
            const bool jumps = step >= kSecantSteps || !std::isfinite(a) || !std::isfinite(b);
            const double share = jumps ? 0.5 : std::clamp(a / (a - b), 1e-3, 1 - 1e-3);
            const double middle = from + share * (to - from);
            const double margin = lattice_.margin_at(in + middle * (out - in));
            if (margin >= 0) {
                from = middle;
                in_margin = margin;
                in_weight = 1;
                out_weight *= was_within ? 0.5 : 1;
            } else {
                to = middle;
                out_margin = margin;
                out_weight = 1;
                in_weight *= was_beyond ? 0.5 : 1;
            }
            was_within = margin >= 0;
            was_beyond = margin < 0;
        }
        return snapped(in + from * (out - in));
    }

    // Moved onto the domain's border where it differs by rounding only.
    Vec2d snapped(Vec2d p) const
    {
        const auto snap = [](double x, double low, double size) {
            const double near = kSnap * size;
            return std::abs(x - low) <= near          ? low
                   : std::abs(x - low - size) <= near ? low + size
                                                      : x;
        };
        return {snap(p.x, low_.x, size_.x), snap(p.y, low_.y, size_.y)};
    }

    Vec2d crossing(const GridSide& side) const
    {
        std::size_t in = side.first;
        std::size_t out = lattice_.end_of(side);
        if (!lattice_.belongs(in)) {
            std::swap(in, out);
        }
        return last_within(lattice_.node(in), lattice_.value(in), lattice_.node(out),
                           lattice_.value(out));
    }

    std::vector<Vec2d> turned_left(const std::vector<GridSide>& chain) const
    {
        std::vector<Vec2d> loop;
        for (const GridSide& side : chain) {
            loop.push_back(crossing(side));
        }
        const std::size_t end = lattice_.end_of(chain[0]);
        const Vec2d inner = lattice_.node(lattice_.belongs(end) ? end : chain[0].first);
        if (cross(loop[1] - loop[0], inner - loop[0]) < 0) {
            std::reverse(loop.begin(), loop.end());
        }
        return loop;
    }

    Vec3d in_space(Vec2d p) const { return point_at(surface_, p.x, p.y); }

    std::vector<Vec2d> divided(const std::vector<Vec2d>& loop)
    {
        std::vector<Vec2d> out{loop.front()};
        for (std::size_t i = 1; i < loop.size(); ++i) {
            cell_ = lattice_.cell_of(0.5 * (loop[i - 1] + loop[i]));
            divide(loop[i - 1], loop[i], 0, out);
        }
        return out;
    }

    // Parts of a side stay out of the cells of other sides, so loops cross neither themselves nor
    // each other.
    void divide(Vec2d a, Vec2d b, int depth, std::vector<Vec2d>& out)
    {
        const Vec2d middle = 0.5 * (a + b);
        const Vec3d chord = in_space(b) - in_space(a);
        if (depth < kDeepestDivision && norm(chord) > edge_error_) {
            const std::optional<Vec2d> beside = contour_beside(a, b);
            const bool strays = !beside || norm(in_space(*beside) - in_space(middle)) > edge_error_;
            if (strays && beside && lattice_.may_reach(cell_, *beside)) {
                divide(a, *beside, depth + 1, out);
                divide(*beside, b, depth + 1, out);
                return;
            }
            follows_ = follows_ && !strays;
        }
        out.push_back(b);
    }

    // The point of the contour straight beside a side's middle, in the domain scaled to a square;
    // none within eight times the side's length.
    std::optional<Vec2d> contour_beside(Vec2d a, Vec2d b) const
    {
        const Vec2d way{(b.x - a.x) / size_.x, (b.y - a.y) / size_.y};
        const Vec2d left{-way.y * size_.x, way.x * size_.y};
        const Vec2d middle = 0.5 * (a + b);
        const double here = lattice_.margin_at(middle);
        const double toward = here >= 0 ? -1.0 : 1.0;  // the other side of the contour
        Vec2d last = middle;
        double last_margin = here;
        for (double reach = kFirstReach; reach <= kLastReach; reach *= 2) {
            const Vec2d next = middle + toward * reach * left;
            const double margin = lattice_.margin_at(next);
            if ((margin >= 0) != (here >= 0)) {
                return here >= 0 ? last_within(last, last_margin, next, margin)
                                 : last_within(next, margin, last, last_margin);
            }
            last = next;
            last_margin = margin;
        }
        return std::nullopt;
    }

    // Drops points that a side between their neighbours passes within a quarter of the error.
    std::vector<Vec2d> simplified(const std::vector<Vec2d>& loop) const
    {
        std::vector<Vec2d> out{loop.front()};
        std::size_t from = 0;
        for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
            if (i - from >= kMostDropped || !follows(loop, from, i + 1)) {
                out.push_back(loop[i]);
                from = i;
            }
        }
        out.push_back(loop.back());
        return out;
    }

    bool follows(const std::vector<Vec2d>& loop, std::size_t from, std::size_t to) const
    {
        const Vec2d way = loop[to] - loop[from];
        const Vec3d whole = in_space(loop[to]) - in_space(loop[from]);
        const double square = dot(whole, whole);
        for (std::size_t i = from + 1; i < to; ++i) {
            const Vec3d arm = in_space(loop[i]) - in_space(loop[from]);
            const double share = square > 0 ? std::clamp(dot(arm, whole) / square, 0.0, 1.0) : 0;
            if (norm(in_space(loop[from] + share * way) - in_space(loop[i])) > edge_error_ / 4) {
                return false;
            }
        }
        return true;
    }

    const Surface& surface_;
    double edge_error_;
    Vec2d low_;
    Vec2d size_;
    ContourLattice lattice_;
    std::size_t cell_{};  // of the side that is divided
    bool follows_{true};
};

int samples_along(double length)
{
    return static_cast<int>(
        std::clamp(length / kSamplePitch, double{kFewestSamples}, double{kMostSamples}));
}

}  // namespace

DomainSamples samples_over(const Surface& surface)
{
    return {samples_along(longest_row(surface, true)), samples_along(longest_row(surface, false))};
}

std::vector<std::vector<Vec2d>> domain_contour(const Surface& surface,
                                               const DomainMargin& margin,
                                               double edge_error)
{
    return ContourTracer{surface, margin, edge_error}.contours();
}

}  // namespace cusp::part_model
