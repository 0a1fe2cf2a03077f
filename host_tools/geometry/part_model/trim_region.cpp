// Even-odd test against polygons that contain the trimmed domain, fine in (u, v) and in space.
#include "host_tools/geometry/part_model/trim_region.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace cusp::part_model {

using nurbs::Curve;
using nurbs::Surface;

namespace {

constexpr int kFirstHalvings = 2;  // of a Bezier piece, which is probed at its middle only
constexpr int kDeepestHalving = 14;
constexpr std::size_t kSidesInRow = 4;
constexpr std::size_t kMostRows = 2000;
constexpr double kLengthRounding = 1e-12;  // of a length
constexpr double kBesideEdge = 1e-3;       // of a piece of edge
constexpr float kFar = static_cast<float>(kInfinite);

// True if p lies to the right of the segment, by more than rounding.
bool right_of(Vec2d from, Vec2d to, Vec2d p)
{
    return cross(p - from, to - from) > kLengthRounding * norm(to - from) * norm(to - from);
}

// Turns loops with the inside to their left into polygons. A Bezier piece lies in the convex hull
// of its control points, so a polygon along the right side of the hull excludes nothing inside.
class EdgeTracer {
public:
    EdgeTracer(const Surface& surface, double edge_error)
        : surface_{surface}, edge_error_{edge_error}
    {
    }

    std::vector<Vec2d> trace(const std::vector<Curve>& loop)
    {
        corners_.clear();
        for (const Curve& curve : loop) {
            for (const Curve& piece : bezier_pieces(curve)) {
                trace(piece, 0);
            }
        }
        return std::move(corners_);
    }

private:
    void trace(const Curve& piece, int depth)
    {
        const double middle = 0.5 * (piece.domain_begin() + piece.domain_end());
        const bool fine = depth >= kFirstHalvings && is_monotone(piece) &&
                          chord_error(piece, middle) <= edge_error_;
        if (fine || depth == kDeepestHalving) {
            append(piece);
            return;
        }
        for (const Curve& half : split_at(piece, middle)) {
            trace(half, depth + 1);
        }
    }

    // True if all control points project onto the chord between the first and the last one.
    static bool is_monotone(const Curve& piece)
    {
        const Vec2d from = in_plan(piece.points.front());
        const Vec2d way = in_plan(piece.points.back()) - from;
        return std::all_of(piece.points.begin(), piece.points.end(), [&](const Vec3d& p) {
            const double along = dot(in_plan(p) - from, way);
            return along >= -kLengthRounding * dot(way, way) &&
                   along <= dot(way, way) * (1.0 + kLengthRounding);
        });
    }

    Vec3d in_space(Vec3d p) const { return point_at(surface_, p.x, p.y); }

    // Bound of the distance between the sides and the edge in space. The deviation at the middle
    // counts twice, since other points are not probed.
    double chord_error(const Curve& piece, double middle) const
    {
        const Vec3d from = in_space(piece.points.front());
        const Vec3d to = in_space(piece.points.back());
        const Vec3d way = to - from;
        double largest = 2.0 * norm(in_space(point_at(piece, middle)) - (from + to) * 0.5);
        for (std::size_t k = 1; k + 1 < piece.points.size(); ++k) {
            const Vec3d arm = in_space(piece.points[k]) - from;
            const double square = dot(way, way);
            const double share = square > 0.0 ? std::clamp(dot(arm, way) / square, 0.0, 1.0) : 0.0;
            largest = std::max(largest, norm(arm - way * share));
        }
        return largest;
    }

    // Appends the right side of the hull, from the first control point to the last: the points to
    // the right of the chord, in order along it, without those that are not convex.
    void append(const Curve& piece)
    {
        const Vec2d from = in_plan(piece.points.front());
        const Vec2d to = in_plan(piece.points.back());
        std::vector<Vec2d> beyond;
        for (const Vec3d& p : piece.points) {
            if (right_of(from, to, in_plan(p))) {
                beyond.push_back(in_plan(p));
            }
        }
        std::sort(beyond.begin(), beyond.end(),
                  [&](Vec2d a, Vec2d b) { return dot(a, to - from) < dot(b, to - from); });
        beyond.push_back(to);
        if (corners_.empty() || corners_.back().x != from.x || corners_.back().y != from.y) {
            corners_.push_back(from);
        }
        const std::size_t first = corners_.size();
        for (const Vec2d p : beyond) {
            while (corners_.size() > first &&
                   !right_of(corners_[corners_.size() - 2], p, corners_.back())) {
                corners_.pop_back();
            }
            corners_.push_back(p);
        }
    }

    const Surface& surface_;
    double edge_error_;
    std::vector<Vec2d> corners_;
};

// The part of the side inside the rectangle, as parameters from 0 to 1 (Liang & Barsky).
std::optional<std::array<double, 2>> part_in(const std::array<Vec2d, 2>& side,
                                             Vec2d low,
                                             Vec2d high)
{
    // Most sides lie beside the rectangle.
    if (std::max(side[0].x, side[1].x) < low.x || std::min(side[0].x, side[1].x) > high.x ||
        std::max(side[0].y, side[1].y) < low.y || std::min(side[0].y, side[1].y) > high.y) {
        return std::nullopt;
    }
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
    EdgeTracer tracer{surface, edge_error};
    for (const std::vector<Curve>& loop : surface.trims) {
        const std::vector<Vec2d> corners = tracer.trace(loop);
        if (!corners.empty()) {
            corners_.insert(corners_.end(), corners.begin(), corners.end());
            corners_.push_back(corners.front());
        }
        loop_ends_.push_back(static_cast<std::uint32_t>(corners_.size()));
    }
    corners_.shrink_to_fit();
    make_rows();
}

template <class Visit>
void TrimRegion::for_each_side(const Visit& visit) const
{
    std::uint32_t number = 0;
    for (const std::uint32_t end : loop_ends_) {
        for (; number + 1 < end; ++number) {
            visit(number);
        }
        number = end;
    }
}

std::vector<std::vector<Vec2d>> TrimRegion::loops() const
{
    std::vector<std::vector<Vec2d>> out;
    std::size_t begin = 0;
    for (const std::uint32_t end : loop_ends_) {
        const std::size_t last = end > begin ? end - 1 : begin;
        out.emplace_back(corners_.begin() + static_cast<std::ptrdiff_t>(begin),
                         corners_.begin() + static_cast<std::ptrdiff_t>(last));
        begin = end;
    }
    return out;
}

std::vector<std::vector<Vec3d>> TrimRegion::edges(const Surface& surface) const
{
    std::vector<std::vector<Vec3d>> out;
    std::size_t begin = 0;
    for (const std::uint32_t end : loop_ends_) {
        std::vector<Vec3d>& loop = out.emplace_back();
        loop.reserve(end - begin);
        for (; begin < end; ++begin) {
            loop.push_back(point_at(surface, corners_[begin].x, corners_[begin].y));
        }
    }
    return out;
}

std::size_t TrimRegion::row(double v) const
{
    const double share = high_ > low_ ? (v - low_) / (high_ - low_) : 0;
    const double last = static_cast<double>(rows() - 1);
    return static_cast<std::size_t>(std::clamp(share * static_cast<double>(rows()), 0.0, last));
}

void TrimRegion::make_rows()
{
    if (!trimmed()) {
        return;
    }
    low_ = high_ = corners_.front().y;
    for (const Vec2d& corner : corners_) {
        largest_u_ = std::max(largest_u_, std::abs(corner.x));
        low_ = std::min(low_, corner.y);
        high_ = std::max(high_, corner.y);
    }
    static_assert(kMostRows <= std::numeric_limits<std::uint16_t>::max());
    const std::size_t sides = corners_.size() - loop_ends_.size();
    row_begins_.resize(std::clamp<std::size_t>(sides / kSidesInRow, 1, kMostRows) + 1);
    first_rows_.resize(corners_.size());
    const auto last_row = [&](std::uint32_t number) {
        return row(std::max(corners_[number].y, corners_[number + 1].y));
    };
    // Number of sides of each row, counted one row further on; then the place where each row
    // begins.
    for_each_side([&](std::uint32_t number) {
        const std::size_t first = row(std::min(corners_[number].y, corners_[number + 1].y));
        first_rows_[number] = static_cast<std::uint16_t>(first);
        for (std::size_t at = first; at <= last_row(number); ++at) {
            ++row_begins_[at + 1];
        }
    });
    std::partial_sum(row_begins_.begin(), row_begins_.end(), row_begins_.begin());
    row_sides_.resize(row_begins_.back());
    std::vector<std::uint32_t> next(row_begins_.begin(), row_begins_.end() - 1);
    for_each_side([&](std::uint32_t number) {
        for (std::size_t at = first_rows_[number]; at <= last_row(number); ++at) {
            row_sides_[next[at]++] = number;
        }
    });
    find_blocks();
}

void TrimRegion::find_blocks()
{
    blocks_.assign((row_sides_.size() + kBlock - 1) / kBlock, {kFar, -kFar});
    for (std::size_t k = 0; k < row_sides_.size(); ++k) {
        auto& [low, high] = blocks_[k / kBlock];
        const auto [a, b] = side(row_sides_[k]);
        const auto least = static_cast<float>(std::min(a.x, b.x));
        const auto most = static_cast<float>(std::max(a.x, b.x));
        low = std::min(low, std::nextafter(least, -kFar));
        high = std::max(high, std::nextafter(most, kFar));
    }
}

template <class Visit>
void TrimRegion::visit_sides(std::size_t row, double low, double high, const Visit& visit) const
{
    const std::size_t end = row_begins_[row + 1];
    std::size_t k = row_begins_[row];
    while (k < end) {
        const auto [block_low, block_high] = blocks_[k / kBlock];
        const std::size_t block_end = std::min(end, (k / kBlock + 1) * kBlock);
        if (block_low <= high && block_high >= low) {
            for (; k < block_end; ++k) {
                visit(row_sides_[k]);
            }
        }
        k = block_end;
    }
}

// The place where a side crosses a row is rounded: it counts as left of u no nearer than this.
double TrimRegion::left_of(double u) const { return u - kLengthRounding * largest_u_; }

bool TrimRegion::inside(double u, double v) const
{
    if (!trimmed()) {
        return true;
    }
    bool in = false;
    visit_sides(row(v), left_of(u), kInfinite, [&](std::uint32_t number) {
        const auto [a, b] = side(number);
        if ((a.y > v) != (b.y > v) && u < a.x + (b.x - a.x) * (v - a.y) / (b.y - a.y)) {
            in = !in;
        }
    });
    return in;
}

// Slightly widened, so that an edge along a side of the rectangle counts.
TrimRegion::Box TrimRegion::widened(double u_begin, double u_end, double v_begin, double v_end)
{
    const Vec2d max_error{1e-9 * (u_end - u_begin), 1e-9 * (v_end - v_begin)};
    return {Vec2d{u_begin, v_begin} - max_error, Vec2d{u_end, v_end} + max_error};
}

TrimRegion::Part TrimRegion::part(double u_begin, double u_end, double v_begin, double v_end) const
{
    const Box box = widened(u_begin, u_end, v_begin, v_end);
    if (!trimmed()) {
        return Part::kInside;
    }
    const std::size_t first = row(box.low.y);
    const std::size_t last = row(box.high.y);
    for (std::size_t at = first; at <= last; ++at) {
        bool cut = false;
        visit_sides(at, box.low.x, box.high.x, [&](std::uint32_t number) {
            cut = cut ||
                  (is_seen_first(number, at, first) && part_in(side(number), box.low, box.high));
        });
        if (cut) {
            return Part::kCut;
        }
    }
    return inside(0.5 * (u_begin + u_end), 0.5 * (v_begin + v_end)) ? Part::kInside
                                                                    : Part::kOutside;
}

// Both points of one v in one pass over its row.
std::array<bool, 2> TrimRegion::inside_at(const std::array<double, 2>& u, double v) const
{
    std::array<bool, 2> in{false, false};
    visit_sides(row(v), left_of(std::min(u[0], u[1])), kInfinite, [&](std::uint32_t number) {
        const auto [a, b] = side(number);
        if ((a.y > v) != (b.y > v)) {
            const double crossed = a.x + (b.x - a.x) * (v - a.y) / (b.y - a.y);
            in[0] = in[0] != (u[0] < crossed);
            in[1] = in[1] != (u[1] < crossed);
        }
    });
    return in;
}

// The mean of what is left lies in a sliver; else a place just to the left of an edge may.
std::optional<TrimRegion::Beside> TrimRegion::beside(Vec2d low, Vec2d high) const
{
    Remnant left;
    if (remnant(low.x, high.x, low.y, high.y, left) != Part::kCut) {
        return std::nullopt;
    }
    Vec2d longest{};
    Vec2d sum{};
    for (std::size_t k = 0; k + 1 < left.edge.size(); k += 2) {
        const Vec2d way = left.edge[k + 1] - left.edge[k];
        longest = norm(way) > norm(longest) ? way : longest;
        sum = sum + left.edge[k] + left.edge[k + 1];
    }
    for (const Vec2d& corner : left.corners) {
        sum = sum + corner;
    }
    const auto within = [&](Vec2d at) {
        return Vec2d{std::clamp(at.x, low.x, high.x), std::clamp(at.y, low.y, high.y)};
    };
    const Vec2d mean =
        within(sum * (1.0 / static_cast<double>(left.edge.size() + left.corners.size())));
    if (inside(mean.x, mean.y)) {
        return Beside{mean, longest};
    }
    for (std::size_t k = 0; k + 1 < left.edge.size(); k += 2) {
        const Vec2d way = left.edge[k + 1] - left.edge[k];
        const Vec2d place =
            within((left.edge[k] + left.edge[k + 1]) * 0.5 + Vec2d{-way.y, way.x} * kBesideEdge);
        if (inside(place.x, place.y)) {
            return Beside{place, way};
        }
    }
    return std::nullopt;
}

TrimRegion::Part TrimRegion::remnant(
    double u_begin, double u_end, double v_begin, double v_end, Remnant& out) const
{
    out.corners.clear();
    out.edge.clear();
    if (!trimmed()) {
        return Part::kInside;
    }
    const Box box = widened(u_begin, u_end, v_begin, v_end);
    const std::size_t first = row(box.low.y);
    const std::size_t last = row(box.high.y);
    for (std::size_t at = first; at <= last; ++at) {
        visit_sides(at, box.low.x, box.high.x, [&](std::uint32_t number) {
            if (!is_seen_first(number, at, first)) {
                return;
            }
            const std::array<Vec2d, 2> ends = side(number);
            if (const auto part = part_in(ends, box.low, box.high)) {
                const Vec2d way = ends[1] - ends[0];
                out.edge.push_back(ends[0] + way * (*part)[0]);
                out.edge.push_back(ends[0] + way * (*part)[1]);
            }
        });
    }
    if (out.edge.empty()) {
        return inside(0.5 * (u_begin + u_end), 0.5 * (v_begin + v_end)) ? Part::kInside
                                                                        : Part::kOutside;
    }
    const std::array<bool, 2> low = inside_at({u_begin, u_end}, v_begin);
    const std::array<bool, 2> high = inside_at({u_begin, u_end}, v_end);
    for (std::size_t k = 0; k < 2; ++k) {
        const double u = k == 0 ? u_begin : u_end;
        if (low[k]) {
            out.corners.push_back({u, v_begin});
        }
        if (high[k]) {
            out.corners.push_back({u, v_end});
        }
    }
    return Part::kCut;
}

}  // namespace cusp::part_model
