// Looks the floor up along the path, takes the longest moves that stay in the band, lifts what
// would cut too deep, and certifies every move.
#include "host_tools/contour_pocket/floor_path.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::host {

namespace {

struct Station {
    Vec2d at;
    double height;
    Vec2d gradient;
};

Vec3d written(Vec2d at, double z)
{
    const auto nearest = [](double x) {
        return std::round(x / kWrittenStep) * kWrittenStep;
    };
    return {nearest(at.x), nearest(at.y), std::ceil(z / kWrittenStep - 1e-6) * kWrittenStep};
}

std::vector<Vec2d> stations_in_plan(const std::vector<Edge>& plan,
                                    const FloorPathSettings& settings)
{
    std::vector<Vec2d> points{plan.front().start};
    for (const Edge& edge : plan) {
        double spacing = settings.spacing;
        if (edge.turn != 0) {
            // Chords of the arc keep within an eighth of what is allowed.
            spacing = std::min(spacing, std::sqrt(edge.radius * settings.aside));
        }
        const int n = std::max(1, static_cast<int>(std::ceil(length(edge) / spacing)));
        for (int i = 1; i <= n; ++i) {
            points.push_back(i == n ? edge.end : point_on(edge, static_cast<double>(i) / n));
        }
    }
    return points;
}

class Chain {
public:
    Chain(std::vector<Station> stations, const FloorPathSettings& settings)
        : stations_{std::move(stations)}, settings_{settings}
    {
        // With a lift, moves may sag below the line of stations by half the band and rise by half.
        band_ = 0.92 * (settings.lift ? 0.5 * settings.above : settings.above);
        aside_ = 0.97 * settings.aside;
    }

    // Indices of the stations that moves join.
    std::vector<std::size_t> joints() const
    {
        std::vector<std::size_t> joints{0};
        while (joints.back() + 1 < stations_.size()) {
            joints.push_back(farthest(joints.back()));
        }
        return joints;
    }

    // How far the move between two stations sags below the floor, at most; 0 or more.
    double sag(std::size_t i, std::size_t j) const
    {
        double worst = 0.0;
        for (std::size_t k = i + 1; k < j; ++k) {
            worst = std::max(worst, departure(i, j, k).below);
        }
        return worst;
    }

    const Station& operator[](std::size_t i) const { return stations_[i]; }

private:
    struct Departure {
        double aside;
        double below;  // floor minus move, by the slope of the floor at the station
    };

    Departure departure(std::size_t i, std::size_t j, std::size_t k) const
    {
        const Vec2d a = stations_[i].at;
        const Vec2d chord = stations_[j].at - a;
        const Vec2d arm = stations_[k].at - a;
        const double square = dot(chord, chord);
        const double share = square > 0.0 ? std::clamp(dot(arm, chord) / square, 0.0, 1.0) : 0.0;
        const Vec2d off = chord * share - arm;
        const double move =
            stations_[i].height + (stations_[j].height - stations_[i].height) * share;
        const double floor = stations_[k].height + dot(stations_[k].gradient, off);
        return {std::sqrt(dot(off, off)), floor - move};
    }

    bool fits(std::size_t i, std::size_t j) const
    {
        for (std::size_t k = i + 1; k < j; ++k) {
            const Departure d = departure(i, j, k);
            if (d.aside > aside_ || std::abs(d.below) > band_) {
                return false;
            }
        }
        return true;
    }

    std::size_t farthest(std::size_t i) const
    {
        const std::size_t last = stations_.size() - 1;
        std::size_t good = i + 1;
        std::size_t stride = 2;
        while (i + stride <= last && fits(i, i + stride)) {
            good = i + stride;
            stride *= 2;
        }
        std::size_t bad = std::min(last + 1, i + stride);
        while (bad - good > 1) {
            const std::size_t middle = good + (bad - good) / 2;
            (fits(i, middle) ? good : bad) = middle;
        }
        return good;
    }

    std::vector<Station> stations_;
    FloorPathSettings settings_;
    double band_;
    double aside_;
};

// Raises both ends of every move by what it lacks to keep off the floor, until none lacks anything.
// Raising only ever adds room to the neighbours.
double certify(std::vector<Vec3d>& points, const TipFloor& floor, bool lift)
{
    constexpr int kRounds = 6;
    constexpr double kEnough = 0.01;
    double least = kEnough;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        double gap = floor.gap(points[i], points[i + 1], kEnough);
        for (int round = 0; lift && gap < 0.0 && round < kRounds; ++round) {
            const double raise = kWrittenStep + 1.5 * -gap;
            points[i] = written({points[i].x, points[i].y}, points[i].z + raise);
            points[i + 1] = written({points[i + 1].x, points[i + 1].y}, points[i + 1].z + raise);
            gap = floor.gap(points[i], points[i + 1], kEnough);
        }
        least = std::min(least, gap);
    }
    return least;
}

}  // namespace

FloorPath lay_on_floor(const std::vector<Edge>& plan,
                       const TipFloor& floor,
                       const FloorPathSettings& settings)
{
    FloorPath path;
    std::vector<Station> stations;
    for (const Vec2d at : stations_in_plan(plan, settings)) {
        const TipFloor::Rest rest = floor.drop(at);
        if (rest.height == TipFloor::kNothing) {
            path.over_floor = false;
            path.missing = at;
            return path;
        }
        stations.push_back({at, rest.height, rest.gradient});
    }
    const bool closed = distance(stations.front().at, stations.back().at) < 1e-9;
    const Chain chain{std::move(stations), settings};
    const std::vector<std::size_t> joints = chain.joints();
    std::vector<double> lift(joints.size(), 0.0);
    for (std::size_t m = 0; settings.lift && m + 1 < joints.size(); ++m) {
        const double sag = chain.sag(joints[m], joints[m + 1]);
        lift[m] = std::max(lift[m], sag);
        lift[m + 1] = std::max(lift[m + 1], sag);
    }
    if (closed) {
        lift.front() = lift.back() = std::max(lift.front(), lift.back());
    }
    for (std::size_t m = 0; m < joints.size(); ++m) {
        const Station& station = chain[joints[m]];
        path.points.push_back(written(station.at, station.height + lift[m]));
    }
    path.least_gap = certify(path.points, floor, settings.lift);
    if (closed) {
        const double top = std::max(path.points.front().z, path.points.back().z);
        path.points.front().z = path.points.back().z = top;
    }
    return path;
}

}  // namespace cusp::host
