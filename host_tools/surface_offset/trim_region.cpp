// Even-odd test against polylines that are fine both in (u, v) and in space.
#include "host_tools/surface_offset/trim_region.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace cusp::host {
namespace {

constexpr int kFirstPieces = 4;  // of a span, so that no wave hides between the ends
constexpr int kDeepestHalving = 14;
constexpr std::size_t kSidesInRow = 4;
constexpr std::size_t kMostRows = 2000;

struct EdgePoint {
    double t;
    Vec2d domain;
    Vec3d space;
};

class EdgeTracer {
public:
    EdgeTracer(const Surface& surface, double edge_error)
        : surface_{surface}, edge_error_{edge_error}
    {
    }

    EdgePoint at(const Curve& curve, double t) const
    {
        const Vec3d p = point_at(curve, t);
        return {t, {p.x, p.y}, point_at(surface_, p.x, p.y)};
    }

    // Appends the points after `a` up to `b`. Half of the allowed error is for what the probe at
    // the middle does not see.
    void trace(const Curve& curve,
               const EdgePoint& a,
               const EdgePoint& b,
               int depth,
               std::vector<EdgePoint>& out) const
    {
        const EdgePoint middle = at(curve, 0.5 * (a.t + b.t));
        const double off = norm(middle.space - (a.space + b.space) * 0.5);
        if (depth < kDeepestHalving && off > 0.5 * edge_error_) {
            trace(curve, a, middle, depth + 1, out);
            trace(curve, middle, b, depth + 1, out);
        } else {
            out.push_back(b);
        }
    }

private:
    const Surface& surface_;
    double edge_error_;
};

std::vector<double> breaks(const Curve& curve)
{
    std::vector<double> out{curve.domain_begin()};
    for (const double knot : curve.knots) {
        if (knot > out.back() && knot <= curve.domain_end()) {
            const double from = out.back();
            for (int k = 1; k <= kFirstPieces; ++k) {
                out.push_back(from + (knot - from) * k / kFirstPieces);
            }
        }
    }
    return out;
}

// The part of the side, as shares, that lies in the rectangle (Liang and Barsky).
std::optional<std::array<double, 2>> part_in(const std::array<Vec2d, 2>& side,
                                             Vec2d low,
                                             Vec2d high)
{
    double from = 0;
    double to = 1;
    const Vec2d d = side[1] - side[0];
    const std::array<std::array<double, 2>, 4> bounds{{{-d.x, side[0].x - low.x},
                                                       {d.x, high.x - side[0].x},
                                                       {-d.y, side[0].y - low.y},
                                                       {d.y, high.y - side[0].y}}};
    for (const auto& [p, q] : bounds) {
        if (p == 0) {
            if (q < 0) {
                return std::nullopt;
            }
        } else if (p < 0) {
            from = std::max(from, q / p);
        } else {
            to = std::min(to, q / p);
        }
    }
    return from <= to ? std::optional{std::array{from, to}} : std::nullopt;
}

}  // namespace

TrimRegion::TrimRegion(const Surface& surface, double edge_error)
{
    const EdgeTracer tracer{surface, edge_error};
    for (const std::vector<Curve>& loop : surface.trims) {
        std::vector<EdgePoint> points;
        for (const Curve& curve : loop) {
            const std::vector<double> at = breaks(curve);
            EdgePoint last = tracer.at(curve, at.front());
            points.push_back(last);
            for (std::size_t k = 1; k < at.size(); ++k) {
                const EdgePoint next = tracer.at(curve, at[k]);
                tracer.trace(curve, last, next, 0, points);
                last = next;
            }
        }
        std::vector<Vec2d> domain;
        for (std::size_t k = 0; k < points.size(); ++k) {
            const EdgePoint& next = points[(k + 1) % points.size()];
            sides_.push_back({points[k].domain, next.domain});
            edges_.push_back({points[k].space, next.space});
            domain.push_back(points[k].domain);
        }
        loops_.push_back(std::move(domain));
    }
    make_rows();
}

std::size_t TrimRegion::row(double v) const
{
    const double share = high_ > low_ ? (v - low_) / (high_ - low_) : 0;
    const double last = static_cast<double>(rows_.size() - 1);
    return static_cast<std::size_t>(
        std::clamp(share * static_cast<double>(rows_.size()), 0.0, last));
}

void TrimRegion::make_rows()
{
    if (sides_.empty()) {
        return;
    }
    low_ = high_ = sides_.front()[0].y;
    for (const auto& [a, b] : sides_) {
        low_ = std::min({low_, a.y, b.y});
        high_ = std::max({high_, a.y, b.y});
    }
    rows_.resize(std::clamp<std::size_t>(sides_.size() / kSidesInRow, 1, kMostRows));
    for (std::size_t k = 0; k < sides_.size(); ++k) {
        const std::size_t last = row(std::max(sides_[k][0].y, sides_[k][1].y));
        for (std::size_t at = row(std::min(sides_[k][0].y, sides_[k][1].y)); at <= last; ++at) {
            rows_[at].push_back(static_cast<std::uint32_t>(k));
        }
    }
}

bool TrimRegion::inside(double u, double v) const
{
    if (sides_.empty()) {
        return true;
    }
    bool in = false;
    for (const std::uint32_t side : rows_[row(v)]) {
        const auto& [a, b] = sides_[side];
        if ((a.y > v) != (b.y > v) && u < a.x + (b.x - a.x) * (v - a.y) / (b.y - a.y)) {
            in = !in;
        }
    }
    return in;
}

// A little wider, so that an edge along the rectangle's own side counts.
TrimRegion::Box TrimRegion::widened(double u_begin, double u_end, double v_begin, double v_end)
{
    const Vec2d slack{1e-9 * (u_end - u_begin), 1e-9 * (v_end - v_begin)};
    return {Vec2d{u_begin, v_begin} - slack, Vec2d{u_end, v_end} + slack};
}

TrimRegion::Part TrimRegion::part(double u_begin, double u_end, double v_begin, double v_end) const
{
    const Box box = widened(u_begin, u_end, v_begin, v_end);
    if (sides_.empty()) {
        return Part::kInside;
    }
    const std::size_t last = row(box.high.y);
    for (std::size_t at = row(box.low.y); at <= last; ++at) {
        for (const std::uint32_t side : rows_[at]) {
            if (part_in(sides_[side], box.low, box.high)) {
                return Part::kCut;
            }
        }
    }
    return inside(0.5 * (u_begin + u_end), 0.5 * (v_begin + v_end)) ? Part::kInside
                                                                    : Part::kOutside;
}

TrimRegion::Remnant TrimRegion::remnant(double u_begin,
                                        double u_end,
                                        double v_begin,
                                        double v_end) const
{
    Remnant result;
    for (const Vec2d corner : {Vec2d{u_begin, v_begin}, Vec2d{u_begin, v_end},
                               Vec2d{u_end, v_begin}, Vec2d{u_end, v_end}}) {
        if (inside(corner.x, corner.y)) {
            result.corners.push_back(corner);
        }
    }
    const Box box = widened(u_begin, u_end, v_begin, v_end);
    const std::size_t last = row(box.high.y);
    for (std::size_t at = row(box.low.y); at <= last && !sides_.empty(); ++at) {
        for (const std::uint32_t index : rows_[at]) {
            const std::array<Vec2d, 2>& side = sides_[index];
            if (const auto part = part_in(side, box.low, box.high)) {
                const Vec2d way = side[1] - side[0];
                result.edge.push_back(side[0] + way * (*part)[0]);
                result.edge.push_back(side[0] + way * (*part)[1]);
            }
        }
    }
    return result;
}

}  // namespace cusp::host
