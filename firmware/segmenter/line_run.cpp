// Feasible bulges in closed form, and the check of an arc as it will be written.
//
// In the frame of the chord (start at 0, end at c along x) the arc of bulge k = tan(sweep / 4) lies
// on the circle with centre (c/2, y0), y0 = c (k^2 - 1) / (4 k) and signed radius
// r = c (k^2 + 1) / (4 k). A point (x, y) at distance d above it, along the radius, satisfies
//   c (y + d) k^2 - 2 g k - c (y - d) = 0,  g = x^2 - c x + y^2 - d^2,
// hence k = c (y - d) / (-g + sqrt(g^2 + c^2 (y^2 - d^2))). A larger bulge raises the arc, so the
// largest d allowed gives the least bulge and the other way round.
#include "firmware/segmenter/line_run.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"

namespace cusp::segmenter {
namespace {

struct Axes {
    unsigned first;
    unsigned second;
    unsigned normal;
};

constexpr Axes axes_of(path::Plane plane) noexcept
{
    switch (plane) {
        case path::Plane::kZX:
            return {2, 0, 1};
        case path::Plane::kYZ:
            return {1, 2, 0};
        case path::Plane::kXY:
            break;
    }
    return {0, 1, 2};
}

struct Point {
    double x;
    double y;
};

// The room of a point on both sides of the path.
struct Band {
    double left;
    double right;
};

Band scaled(Band band, double factor) noexcept { return {band.left * factor, band.right * factor}; }

struct Interval {
    double low;
    double high;
};

// Narrows the interval of bulges to those that keep a point of the chord's frame within the band.
// A point left of the path lies above it. `c` is the chord.
void narrow(Interval& bulges, double c, Point p, Band band) noexcept
{
    const double base = p.x * p.x - c * p.x + p.y * p.y;
    const auto root_at = [&](double d, double otherwise) {
        const double g = base - d * d;
        const double square = g * g + c * c * (p.y * p.y - d * d);
        if (square < 0) {
            return otherwise;  // so near to an end of the chord that every arc keeps it
        }
        const double denominator = std::sqrt(square) - g;
        const double numerator = c * (p.y - d);
        if (denominator > 1e-300) {
            return numerator / denominator;
        }
        return otherwise;
    };
    bulges.low = std::max(bulges.low, root_at(band.left, bulges.low));
    bulges.high = std::min(bulges.high, root_at(-band.right, bulges.high));
}

// Turns points of the plane into the frame of the chord.
struct Frame {
    Axes axes;
    Point origin;
    Point along;  // unit vector
    double chord;

    Point operator()(const Vec3d& v) const noexcept
    {
        const double dx = v[axes.first] - origin.x;
        const double dy = v[axes.second] - origin.y;
        return {dx * along.x + dy * along.y, dy * along.x - dx * along.y};
    }
};

bool make_frame(Span<const Vec3d> vertices, Axes axes, Frame& frame) noexcept
{
    constexpr double kLeastChord = 1e-3;  // mm: shorter ones say too little about the direction
    const Vec3d& a = vertices[0];
    const Vec3d& b = vertices[vertices.size() - 1];
    const Point d{b[axes.first] - a[axes.first], b[axes.second] - a[axes.second]};
    const double chord = std::sqrt(d.x * d.x + d.y * d.y);
    if (chord < kLeastChord) {
        return false;
    }
    frame = {axes, {a[axes.first], a[axes.second]}, {d.x / chord, d.y / chord}, chord};
    return true;
}

constexpr Point middle(Point a, Point b) noexcept { return {0.5 * (a.x + b.x), 0.5 * (a.y + b.y)}; }

// Bulges that keep all vertices and all middles of lines; empty (low > high) where there are none.
Interval feasible_bulges(Span<const Vec3d> vertices,
                         const Frame& frame,
                         Band band,
                         double greatest) noexcept
{
    Interval bulges{-greatest, greatest};
    const Band between = scaled(band, kBetweenVertices);
    Point last{0, 0};
    for (std::size_t i = 1; i < vertices.size() && bulges.low <= bulges.high; ++i) {
        const Point p = frame(vertices[i]);
        narrow(bulges, frame.chord, middle(last, p), between);
        if (i + 1 < vertices.size()) {
            narrow(bulges, frame.chord, p, band);
        }
        last = p;
    }
    return bulges;
}

// The circle of an arc as the controller will see it: centre rounded, radius linear in angle.
struct Circle {
    Point centre;  // from the first vertex, along the plane's axes
    double radius;
    double radius_change;
    double sweep;  // > 0
    double turn;   // 1 counter-clockwise, -1 clockwise
};

double rounded_to(double value, double step) noexcept
{
    return step > 0 ? std::floor(value / step + 0.5) * step : value;
}

double angle_between(Point a, Point b, double turn) noexcept
{
    return atan2(turn * (a.x * b.y - a.y * b.x), a.x * b.x + a.y * b.y);
}

// Distance of vertices and middles from the path, measured as they follow it.
class Follower {
public:
    Follower(const Circle& circle, Axes axes, const Vec3d& first, double rise) noexcept
        : circle_{circle},
          axes_{axes},
          first_{first},
          rise_{rise},
          last_{-circle.centre.x, -circle.centre.y}
    {
    }

    // Angle of the next point on the path; false where it goes back.
    bool advance(const Vec3d& v) noexcept
    {
        constexpr double kBack = 1e-9;
        const Point p = from_centre(v);
        const double step = angle_between(last_, p, circle_.turn);
        last_ = p;
        angle_ += step;
        return step >= -kBack;
    }
    double angle() const noexcept { return angle_; }

    // True if a point at the angle reached is within the band; keeps the largest distance.
    bool keeps(const Vec3d& v, Band band, double& largest) const noexcept
    {
        const Point p = from_centre(v);
        const double share = angle_ / circle_.sweep;
        const double off =
            std::sqrt(p.x * p.x + p.y * p.y) - (circle_.radius + share * circle_.radius_change);
        const double height = v[axes_.normal] - first_[axes_.normal] - share * rise_;
        const double distance = std::sqrt(off * off + height * height);
        largest = std::max(largest, distance);
        // Outside a counter-clockwise arc is right of the motion.
        const bool is_left = off * circle_.turn < 0;
        return distance <= (is_left ? band.left : band.right);
    }

private:
    Point from_centre(const Vec3d& v) const noexcept
    {
        return {v[axes_.first] - first_[axes_.first] - circle_.centre.x,
                v[axes_.second] - first_[axes_.second] - circle_.centre.y};
    }

    const Circle& circle_;
    Axes axes_;
    const Vec3d& first_;
    double rise_;
    Point last_;
    double angle_{0};
};

bool verify(Span<const Vec3d> vertices,
            const Circle& circle,
            Axes axes,
            Band band,
            double& deviation) noexcept
{
    const Vec3d& first = vertices[0];
    const Vec3d& last = vertices[vertices.size() - 1];
    Follower follower{circle, axes, first, last[axes.normal] - first[axes.normal]};
    const Band between = scaled(band, kBetweenVertices);
    deviation = 0;
    for (std::size_t i = 1; i < vertices.size(); ++i) {
        const Vec3d centre = 0.5 * (vertices[i - 1] + vertices[i]);
        if (!follower.advance(centre) || !follower.keeps(centre, between, deviation) ||
            !follower.advance(vertices[i]) || !follower.keeps(vertices[i], band, deviation)) {
            return false;
        }
    }
    constexpr double kSameAngle = 1e-6;
    return std::fabs(follower.angle() - circle.sweep) < kSameAngle;
}

// The bulge to use: the middle of the interval, for most room on either side, but the end with the
// smaller radius where the middle's is too great.
double choose_bulge(Interval bulges, double chord, double greatest_radius) noexcept
{
    const double least = chord / (4 * greatest_radius);
    const double centre = 0.5 * (bulges.low + bulges.high);
    if (std::fabs(centre) >= least) {
        return centre;
    }
    return std::fabs(bulges.low) > std::fabs(bulges.high) ? bulges.low : bulges.high;
}

// Vertices that do not stay at one height leave part of the tolerance to the height.
Band plane_band(Span<const Vec3d> vertices, unsigned normal, Band band) noexcept
{
    constexpr double kShare = 0.7;
    const double height = vertices[0][normal];
    for (const Vec3d& v : vertices) {
        if (v[normal] != height) {
            return scaled(band, kShare);
        }
    }
    return band;
}

Circle circle_of(const Frame& frame, double bulge, Point travel, double centre_step) noexcept
{
    const double height = frame.chord * (bulge * bulge - 1) / (4 * bulge);
    const double half = 0.5 * frame.chord;
    Circle circle{};
    // A bulge to the left of the chord turns clockwise.
    circle.turn = bulge > 0 ? -1 : 1;
    circle.centre = {rounded_to(half * frame.along.x - height * frame.along.y, centre_step),
                     rounded_to(half * frame.along.y + height * frame.along.x, centre_step)};
    const Point from{-circle.centre.x, -circle.centre.y};
    const Point to{travel.x - circle.centre.x, travel.y - circle.centre.y};
    circle.radius = std::sqrt(from.x * from.x + from.y * from.y);
    circle.radius_change = std::sqrt(to.x * to.x + to.y * to.y) - circle.radius;
    const double sweep = angle_between(from, to, circle.turn);
    circle.sweep = sweep > 0 ? sweep : sweep + 2 * kPi;
    return circle;
}

}  // namespace

bool fit_line(Span<const Vec3d> vertices, const FitSettings& settings, FittedMove& move) noexcept
{
    const Vec3d first = vertices[0];
    const Vec3d travel = vertices[vertices.size() - 1] - first;
    const double length = norm(travel);
    if (!(length > 0)) {
        return false;
    }
    const Vec3d along = travel / length;
    double last = 0;
    double largest = 0;
    for (const Vec3d& v : vertices) {
        const Vec3d off = v - first;
        const double place = dot(off, along);
        const double square = std::max(0.0, dot(off, off) - place * place);
        const bool is_left = along.x * off.y > along.y * off.x;
        const double room = is_left ? settings.left : settings.right;
        if (place < last || square > room * room) {
            return false;
        }
        last = place;
        largest = std::max(largest, square);
    }
    move = {};
    move.end = vertices[vertices.size() - 1];
    move.lines = static_cast<std::uint32_t>(vertices.size() - 1);
    move.deviation = std::sqrt(largest);
    return true;
}

bool fit_arc(Span<const Vec3d> vertices,
             path::Plane plane,
             const FitSettings& settings,
             FittedMove& move) noexcept
{
    constexpr double kGreatestMismatch = 0.0005;  // mm, of the radii at both ends
    const Axes axes = axes_of(plane);
    Frame frame{};
    if (!make_frame(vertices, axes, frame)) {
        return false;
    }
    const Band full{settings.left, settings.right};
    const Band band = plane_band(vertices, axes.normal, full);
    const SinCos<double> quarter = sin_cos(0.25 * settings.greatest_sweep);
    const Interval bulges = feasible_bulges(vertices, frame, band, quarter.sin / quarter.cos);
    if (!(bulges.low <= bulges.high)) {
        return false;
    }
    const double bulge = choose_bulge(bulges, frame.chord, settings.greatest_radius);
    if (std::fabs(bulge) * 4 * settings.greatest_radius < frame.chord) {
        return false;
    }
    const Vec3d travel = vertices[vertices.size() - 1] - vertices[0];
    const Circle circle =
        circle_of(frame, bulge, {travel[axes.first], travel[axes.second]}, settings.centre_step);
    double deviation = 0;
    if (circle.radius * circle.sweep < settings.least_arc_length ||
        std::fabs(circle.radius_change) > kGreatestMismatch ||
        !verify(vertices, circle, axes, full, deviation)) {
        return false;
    }
    move = {true,
            vertices[vertices.size() - 1],
            plane,
            circle.turn < 0,
            circle.centre.x,
            circle.centre.y,
            static_cast<std::uint32_t>(vertices.size() - 1),
            deviation};
    return true;
}

}  // namespace cusp::segmenter
