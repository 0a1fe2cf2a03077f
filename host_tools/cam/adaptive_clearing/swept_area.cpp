// The circle is looked at in short arcs: those in swept cells are covered as a whole.
#include "host_tools/cam/adaptive_clearing/swept_area.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::adaptive_clearing {

using offset::Box2d;
using offset::Edge;

namespace {

constexpr int kArcs = 128;           // of the circle
constexpr double kGrown = 0.025;     // radii: over half of such an arc
constexpr double kPitch = 1.0 / 12;  // radii: of cells
constexpr double kDiscSpacing = 0.05;
constexpr double kMissed = 0.0004;  // radii: the width that discs miss beside the path
constexpr double kShortestPiece = 0.001;
constexpr std::size_t kNoCell = static_cast<std::size_t>(-1);

// Unit vectors to a place in each arc, 0 at its beginning, 1 at its end.
std::array<Vec2d, kArcs> in_arcs(double share)
{
    std::array<Vec2d, kArcs> table;
    for (int i = 0; i < kArcs; ++i) {
        const double angle = 2 * kPi * (i + share) / kArcs;
        table[static_cast<std::size_t>(i)] = {elementary::cos(angle), elementary::sin(angle)};
    }
    return table;
}

const std::array<Vec2d, kArcs>& directions()
{
    static const std::array<Vec2d, kArcs> table = in_arcs(0.5);
    return table;
}

const std::array<Vec2d, kArcs>& arc_ends()
{
    static const std::array<Vec2d, kArcs> table = in_arcs(0.0);
    return table;
}

// A number that grows with the angle of a vector, -2 at -pi to 2 at pi, without trigonometry: the
// intervals of a circle that discs cover are many, the gaps between them few.
double diamond_angle(Vec2d v)
{
    const double part = v.y / (std::abs(v.x) + std::abs(v.y));
    if (v.x >= 0.0) {
        return part;
    }
    return v.y >= 0.0 ? 2.0 - part : -2.0 - part;
}

// The angle, radians, of a diamond angle in [-2, 2].
double true_angle(double diamond)
{
    const double size = std::abs(diamond);
    return elementary::atan2(size <= 1.0 ? diamond : std::copysign(2.0 - size, diamond),
                             1.0 - size);
}

constexpr double kFront = 1.0;     // a quarter turn, as a diamond angle
constexpr double kPastRear = 3.0;  // more than any angle

// At least one; the box of an empty region is -2e300 mm wide.
int cells_over(double length, double pitch)
{
    return length > pitch ? static_cast<int>(std::ceil(length / pitch)) : 1;
}

// As seen along the heading: x ahead, y to the left.
Vec2d seen_along(Vec2d heading, Vec2d v) { return {dot(heading, v), cross(heading, v)}; }

}  // namespace

SweptArea::SweptArea(const Box2d& box, double radius)
    : corner_{box.x0, box.y0},
      radius_{radius},
      pitch_{kPitch * radius},
      per_mm_{1.0 / pitch_},
      columns_{cells_over(box.x1 - box.x0, pitch_)},
      rows_{cells_over(box.y1 - box.y0, pitch_)},
      is_swept_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)),
      cells_(is_swept_.size())
{
}

// kNoCell outside of the box.
std::size_t SweptArea::cell_at(Vec2d point) const
{
    const double x = (point.x - corner_.x) * per_mm_;
    const double y = (point.y - corner_.y) * per_mm_;
    if (!(x >= 0.0 && y >= 0.0 && x < columns_ && y < rows_)) {
        return kNoCell;
    }
    // By way of int: processors have no conversion to an unsigned one.
    return static_cast<std::size_t>(static_cast<int>(y)) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(static_cast<int>(x));
}

void SweptArea::add_disc(Vec2d centre, double radius)
{
    const auto index = static_cast<std::uint32_t>(discs_.size());
    discs_.push_back({centre, radius});
    last_query_.push_back(0);
    const double diagonal = std::sqrt(0.5) * pitch_ + kGrown * radius_;
    const double inner = radius - kMaxShrink * radius_ - diagonal;
    // A negative `shrink` enlarges the disc by up to as much.
    const double outer = radius + kMaxShrink * radius_ + diagonal;
    const auto column = [&](double x) {
        return std::clamp(static_cast<int>((x - corner_.x) / pitch_), 0, columns_ - 1);
    };
    const auto row = [&](double y) {
        return std::clamp(static_cast<int>((y - corner_.y) / pitch_), 0, rows_ - 1);
    };
    for (int j = row(centre.y - outer); j <= row(centre.y + outer); ++j) {
        const double dy = corner_.y + (j + 0.5) * pitch_ - centre.y;
        const double half = std::sqrt(std::max(0.0, outer * outer - dy * dy));
        const std::size_t first = static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_);
        const int last = column(centre.x + half);
        for (int i = column(centre.x - half); i <= last; ++i) {
            i = next_open(first, i, last);
            if (i > last) {
                break;
            }
            const double dx = corner_.x + (i + 0.5) * pitch_ - centre.x;
            const double d2 = dx * dx + dy * dy;
            const std::size_t cell = first + static_cast<std::size_t>(i);
            if (d2 > outer * outer) {
                continue;
            }
            if (d2 <= inner * inner) {
                is_swept_[cell] = 1;
                Discs{}.swap(cells_[cell]);
            } else {
                put(index, cells_[cell], centre + Vec2d{dx, dy});
            }
        }
    }
}

// The first column from i on whose cell is not swept in the row that begins at `first`; over `last`
// where there is none up to it.
int SweptArea::next_open(std::size_t first, int i, int last) const
{
    constexpr int kTogether = 8;
    constexpr std::uint64_t kAllSwept = 0x0101010101010101U;
    const std::uint8_t* const row = is_swept_.data() + first;
    while (i <= last && row[i] != 0) {
        std::uint64_t some = 0;
        if (i + kTogether <= last) {
            std::memcpy(&some, row + i, kTogether);
        }
        i += some == kAllSwept ? kTogether : 1;
    }
    return i;
}

// True if all points of the cell about `middle`, and within kGrown of it, are nearer to the other
// disc, which is no smaller. Then that disc covers all that this one covers in the cell, for any
// `shrink`.
bool SweptArea::is_hidden(std::uint32_t disc, std::uint32_t by, Vec2d middle) const
{
    const Disc& a = discs_[disc];
    const Disc& b = discs_[by];
    const Vec2d way = b.centre - a.centre;
    const double reach = (0.5 * pitch_ + kGrown * radius_) * (std::abs(way.x) + std::abs(way.y));
    return b.radius >= a.radius && dot(middle - (a.centre + b.centre) * 0.5, way) >= reach;
}

void SweptArea::put(std::uint32_t disc, Discs& discs, Vec2d middle) const
{
    for (const std::uint32_t other : discs) {
        if (is_hidden(disc, other, middle)) {
            return;
        }
    }
    discs.erase(std::remove_if(discs.begin(), discs.end(),
                               [&](std::uint32_t other) { return is_hidden(other, disc, middle); }),
                discs.end());
    discs.push_back(disc);
}

// On the outer side of an arc of radius r discs at angles b apart miss the swept circle by
// r b^2 / 8 (1 + r / R).
int SweptArea::discs_along(const Edge& edge) const
{
    double pieces = length(edge) / (kDiscSpacing * radius_);
    if (edge.turn != 0) {
        pieces = std::max(pieces, sweep(edge) * std::sqrt(edge.radius * (edge.radius + radius_) /
                                                          (8.0 * kMissed * radius_ * radius_)));
    }
    return std::max(1, static_cast<int>(std::ceil(pieces)));
}

void SweptArea::add(const Edge& edge, double tolerance)
{
    const int n = discs_along(edge);
    const double radius = radius_ - (edge.turn != 0 ? tolerance : 0.0);
    const bool goes_on = !discs_.empty() && norm(discs_.back().centre - edge.start) < 1e-9 &&
                         discs_.back().radius >= radius;
    for (int i = goes_on ? 1 : 0; i <= n; ++i) {
        add_disc(point_on(edge, static_cast<double>(i) / n), radius);
    }
}

// The part of the tool's circle at the pose that lies in the disc; where it reaches over the rear,
// `from` is beyond `to`. None: no part.
std::optional<SweptArea::Interval> SweptArea::covered_by(const Disc& disc,
                                                         const Pose2d& pose,
                                                         double shrink) const
{
    const double r = disc.radius - shrink;
    const Vec2d to = disc.centre - pose.at;
    const double d = norm(to);
    if (d + radius_ <= r) {
        return Interval{-kPastRear, kPastRear};
    }
    const double cosine = d > 0.0 ? (radius_ * radius_ + d * d - r * r) / (2.0 * radius_ * d) : 2.0;
    if (cosine >= 1.0) {
        return std::nullopt;
    }
    if (cosine <= -1.0) {
        return Interval{-kPastRear, kPastRear};
    }
    const Vec2d middle = seen_along(pose.heading, to) * (1.0 / d);
    const double sine = std::sqrt((1.0 - cosine) * (1.0 + cosine));
    const Interval found{
        diamond_angle({cosine * middle.x + sine * middle.y, cosine * middle.y - sine * middle.x}),
        diamond_angle({cosine * middle.x - sine * middle.y, cosine * middle.y + sine * middle.x})};
    // Rounding may exchange the ends of a short part; that does not reach over the rear.
    if (cosine > 0.9 && found.from >= found.to && found.from - found.to < kFront) {
        return std::nullopt;
    }
    return found;
}

// Adds the part of the tool's circle that lies in the disc.
void SweptArea::add_covered(const Disc& disc, const Pose2d& pose, double shrink) const
{
    const std::optional<Interval> part = covered_by(disc, pose, shrink);
    if (!part) {
        return;
    }
    if (part->from <= part->to) {
        covered_.push_back(*part);
    } else {
        covered_.push_back({-kPastRear, part->to});
        covered_.push_back({part->from, kPastRear});
    }
}

double SweptArea::engagement(Vec2d centre, Vec2d heading, double shrink, double widened) const
{
    const Pose2d pose{centre, heading};
    return open_angle(pose, std::min(0.5 * kPi + widened, kPi),
                      [&](const Disc& disc) { add_covered(disc, pose, shrink); });
}

// Radians from -end to end (a diamond angle) that covered_ leaves out; sorts it.
double SweptArea::open_between_covered(double end) const
{
    // They come nearly in order: the circle is looked at from one end to the other.
    for (std::size_t i = 1; i < covered_.size(); ++i) {
        const Interval part = covered_[i];
        std::size_t k = i;
        for (; k > 0 && part.from < covered_[k - 1].from; --k) {
            covered_[k] = covered_[k - 1];
        }
        covered_[k] = part;
    }
    double reached = -end;
    double open = 0.0;
    for (const Interval& c : covered_) {
        if (c.from >= end) {
            break;
        }
        if (c.from > reached) {
            open += true_angle(c.from) - true_angle(reached);
        }
        reached = std::max(reached, c.to);
    }
    return reached < end ? open + true_angle(end) - true_angle(reached) : open;
}

// The angle up to `most` (radians) from the heading that is neither in swept cells nor covered;
// `cover` adds to covered_ what a disc covers.
template <typename Cover>
double SweptArea::open_angle(const Pose2d& pose, double most, const Cover& cover) const
{
    const Vec2d centre = pose.at;
    const Vec2d heading = pose.heading;
    ++query_;
    covered_.clear();
    const double arc = 2 * kPi / kArcs;
    const double at = elementary::atan2(heading.y, heading.x);
    const int first = static_cast<int>(std::floor((at - most) / arc));
    const int last = static_cast<int>(std::floor((at + most) / arc));
    const std::array<Vec2d, kArcs>& table = directions();
    const auto at_arc = [&](int i) {
        return cell_at(centre + table[static_cast<std::size_t>((i + 4 * kArcs) % kArcs)] * radius_);
    };
    // The place where arc i begins. At the rear rounding may turn the sign.
    const auto angle_of_end = [&](int i) {
        const double angle = diamond_angle(
            seen_along(heading, arc_ends()[static_cast<std::size_t>((i + 4 * kArcs) % kArcs)]));
        const double side = i * arc - at;
        return std::abs(angle) > kFront ? std::copysign(angle, side) : angle;
    };
    const auto is_swept = [this](std::size_t cell) {
        return cell != kNoCell && is_swept_[cell] != 0;
    };
    for (int i = first; i <= last; ++i) {
        const std::size_t cell = at_arc(i);
        if (cell == kNoCell) {
            continue;
        }
        if (is_swept_[cell] != 0) {
            const int begin = i;
            for (; i < last && is_swept(at_arc(i + 1)); ++i) {
            }
            // The first arc begins and the last ends beyond `most`.
            covered_.push_back({begin > first ? angle_of_end(begin) : -kPastRear,
                                i < last ? angle_of_end(i + 1) : kPastRear});
            continue;
        }
        for (const std::uint32_t k : cells_[cell]) {
            if (last_query_[k] != query_) {
                last_query_[k] = query_;
                cover(discs_[k]);
            }
        }
    }
    return open_between_covered(
        most > 0.5 * kPi ? diamond_angle({elementary::cos(most), elementary::sin(most)}) : kFront);
}

// A point of the circle keeps its angle from the heading, so it moves along an arc about the edge's
// centre. If both of its ends lie in a disc made smaller by the height of that arc, all of it
// lies in the disc: what a disc covers at both ends it covers in between.
double SweptArea::engagement_of_piece(const Edge& edge,
                                      double from,
                                      double to,
                                      double tolerance) const
{
    const double turn = (to - from) * sweep(edge);
    const double height =
        edge.turn != 0 ? (edge.radius + radius_) * (1.0 - elementary::cos(0.5 * turn)) : 0.0;
    const double shrink = height + (edge.turn != 0 ? tolerance : 0.0);
    const double middle = 0.5 * (from + to);
    const Pose2d poses[2] = {{point_on(edge, from), tangent_on(edge, from)},
                             {point_on(edge, to), tangent_on(edge, to)}};
    const Pose2d at{point_on(edge, middle), tangent_on(edge, middle)};
    return open_angle(at, 0.5 * kPi,
                      [&](const Disc& disc) { add_covered_at_both(disc, poses, shrink); });
}

// The parts of the front half that lie in the disc; their number.
int SweptArea::covered_front(const Disc& disc,
                             const Pose2d& pose,
                             double shrink,
                             Interval* parts) const
{
    const std::optional<Interval> part = covered_by(disc, pose, shrink);
    int n = 0;
    const auto add = [&](double from, double to) {
        const Interval front{std::max(from, -kFront), std::min(to, kFront)};
        if (front.from < front.to) {
            parts[n++] = front;
        }
    };
    if (part && part->from <= part->to) {
        add(part->from, part->to);
    } else if (part) {
        add(-kPastRear, part->to);
        add(part->from, kPastRear);
    }
    return n;
}

void SweptArea::add_covered_at_both(const Disc& disc, const Pose2d* poses, double shrink) const
{
    Interval first[2];
    Interval last[2];
    const int n = covered_front(disc, poses[0], shrink, first);
    const int m = n > 0 ? covered_front(disc, poses[1], shrink, last) : 0;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < m; ++j) {
            const Interval both{std::max(first[i].from, last[j].from),
                                std::min(first[i].to, last[j].to)};
            if (both.from < both.to) {
                covered_.push_back(both);
            }
        }
    }
}

double SweptArea::bound_of_piece(
    const Edge& edge, double from, double to, double limit, double tolerance) const
{
    const double most = engagement_of_piece(edge, from, to, tolerance);
    if (most <= limit || (to - from) * length(edge) < 2.0 * kShortestPiece * radius_) {
        return most;
    }
    const double middle = 0.5 * (from + to);
    return std::max(bound_of_piece(edge, from, middle, limit, tolerance),
                    bound_of_piece(edge, middle, to, limit, tolerance));
}

// Number of equal pieces of the edge in which no point of the circle moves by more than kMaxShrink
// from its place in the middle.
int SweptArea::pieces_of(const Edge& edge, double tolerance) const
{
    const double way = edge.turn != 0 ? (edge.radius + radius_) * sweep(edge) : length(edge);
    const double most = kMaxShrink * radius_ - (edge.turn != 0 ? tolerance : 0.0);
    return std::max(1, static_cast<int>(std::ceil(0.5 * way / most)));
}

double SweptArea::engagement_bound(const Edge& edge, double limit, double tolerance) const
{
    const int n = pieces_of(edge, tolerance);
    double most = 0.0;
    for (int i = 0; i < n; ++i) {
        most = std::max(most, bound_of_piece(edge, static_cast<double>(i) / n,
                                             static_cast<double>(i + 1) / n, limit, tolerance));
    }
    return most;
}

bool SweptArea::piece_keeps(
    const Edge& edge, double from, double to, double limit, double tolerance) const
{
    if (engagement_of_piece(edge, from, to, tolerance) <= limit) {
        return true;
    }
    if ((to - from) * length(edge) < 2.0 * kShortestPiece * radius_) {
        return false;
    }
    const double middle = 0.5 * (from + to);
    return piece_keeps(edge, from, middle, limit, tolerance) &&
           piece_keeps(edge, middle, to, limit, tolerance);
}

bool SweptArea::keeps(const Edge& edge, double limit, double tolerance) const
{
    const int n = pieces_of(edge, tolerance);
    for (int i = 0; i < n; ++i) {
        if (!piece_keeps(edge, static_cast<double>(i) / n, static_cast<double>(i + 1) / n, limit,
                         tolerance)) {
            return false;
        }
    }
    return true;
}

bool SweptArea::contains(Vec2d point) const
{
    const std::size_t cell = cell_at(point);
    if (cell == kNoCell) {
        return false;
    }
    const auto covers = [&](std::uint32_t k) {
        const Vec2d d = point - discs_[k].centre;
        return dot(d, d) <= discs_[k].radius * discs_[k].radius;
    };
    return is_swept_[cell] != 0 || std::any_of(cells_[cell].begin(), cells_[cell].end(), covers);
}

}  // namespace cusp::adaptive_clearing
