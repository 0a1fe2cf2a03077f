// Equally spaced stations along each edge, halved where the slope changes.
#include "host_tools/cam/cl_path/station_row.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/clearing/corner_cleanup.hpp"

namespace cusp::cl_path {

using clearing::starts_cleanup_spur;
using offset::Edge;
using offset::left_normal;
using offset::unit;

namespace {

constexpr double kClosest = 2e-3;      // mm between stations: no closer
constexpr double kSmooth = 0.999;      // cosine of 2.6 degrees
constexpr std::size_t kStretch = 6;    // stations predicted by two samples on any floor
constexpr double kTurned = 1.0;        // radians: longer stretches on smooth floors
constexpr double kLookupShare = 0.06;  // of the allowed height: accuracy of predictions

// The unit tangent of an edge at a point of it.
Vec2d tangent_at(const Edge& edge, Vec2d at)
{
    return edge.turn == 0 ? unit(edge.end - edge.start)
                          : left_normal(unit(at - edge.centre)) * edge.turn;
}

// Equally spaced points of an edge, each rotated from the one before.
class EvenPoints {
public:
    EvenPoints(const Edge& edge, double whole, int n) : edge_{edge}, arm_{edge.start - edge.centre}
    {
        step_ = (edge.end - edge.start) * (1.0 / n);
        if (edge.turn != 0) {
            const double angle = edge.turn * whole / (edge.radius * n);
            step_ = {elementary::cos(angle), elementary::sin(angle)};
        }
    }

    Vec2d next()
    {
        if (edge_.turn == 0) {
            offset_ = offset_ + step_;
            return edge_.start + offset_;
        }
        arm_ = arm_ * step_.x + left_normal(arm_) * step_.y;
        return edge_.centre + arm_;
    }

private:
    const Edge& edge_;
    Vec2d arm_;
    Vec2d offset_{};
    Vec2d step_;
};

// The end of a part of an edge.
struct Stop {
    const Edge* edge;
    Vec2d at;
    double from, to;  // shares of the edge
    double bend;
    double along;  // mm from the start of the plan
    bool kink;     // the tangent jumps here
    bool exact;
};

class RowBuilder {
public:
    RowBuilder(const PathFloor* floor, const StationSpacing& spacing)
        : floor_{floor}, spacing_{spacing}
    {
    }

    StationRow run(const std::vector<Edge>& plan)
    {
        find_stops(plan);
        row_.stations.push_back(station_at(plan.front().start, 0.0));
        row_.stations.back().exact = starts_exact_;
        row_.corners.push_back(0);
        for (std::size_t i = 0; i < stops_.size() && !row_.missing;) {
            const std::size_t last = end_of_stretch(i);
            if (floor_ != nullptr && spacing_.sparse && last >= i + 2) {
                const Place middle = place_of(halfway(i, last));
                fill(start_of(i), i, last, {middle, place_of(last)});
            } else {
                step_along(i, last);
            }
            i = last + 1;
        }
        return std::move(row_);
    }

private:
    void find_stops(const std::vector<Edge>& plan)
    {
        double along = 0.0;
        for (std::size_t e = 0; e < plan.size(); ++e) {
            const Edge& edge = plan[e];
            // Both visits of a spur meet at one point: a corner micrometres beside the other visit
            // could not be distinguished from it.
            if (starts_cleanup_spur(plan, e) || (e > 1 && starts_cleanup_spur(plan, e - 2))) {
                (stops_.empty() ? starts_exact_ : stops_.back().exact) = true;
            }
            const double bend = edge.turn == 0 ? 0.0 : edge.turn / edge.radius;
            const double step =
                edge.turn == 0
                    ? spacing_.along
                    : std::min(spacing_.along, std::sqrt(edge.radius * spacing_.plan_tolerance));
            const double whole = length(edge);
            const int n = std::max(1, static_cast<int>(std::ceil(whole / step)));
            EvenPoints points{edge, whole, n};
            for (int i = 1; i <= n; ++i) {
                const double to = i == n ? 1.0 : static_cast<double>(i) / n;
                stops_.push_back({&edge, i == n ? edge.end : points.next(),
                                  static_cast<double>(i - 1) / n, to, bend, along + to * whole,
                                  false, false});
            }
            along += whole;
            stops_.back().kink = e + 1 == plan.size() ||
                                 dot(tangent_at_end(edge), tangent_at_start(plan[e + 1])) < kSmooth;
        }
    }

    // End of the stretch without kinks that starts with this stop.
    std::size_t end_of_stretch(std::size_t first) const
    {
        std::size_t last = first;
        double turned = 0.0;
        while (last + 1 < stops_.size() && !stops_[last].kink && !stops_[last].exact) {
            const Stop& next = stops_[last + 1];
            turned += std::abs(next.bend) * (next.along - stops_[last].along);
            const double along = next.along - begin_of(first);
            const bool lookup_spacing =
                along < 2.0 * (spacing_.lookup_spacing - spacing_.along) && turned < kTurned;
            if (last + 1 >= first + kStretch && !lookup_spacing) {
                break;
            }
            ++last;
        }
        return last;
    }

    double begin_of(std::size_t i) const { return i == 0 ? 0.0 : stops_[i - 1].along; }

    Station station_at(Vec2d at, double bend)
    {
        if (floor_ == nullptr) {
            return {at, 0.0, {}, bend};
        }
        const std::optional<PathFloor::Lowest> tip = floor_->drop(at);
        if (!tip) {
            row_.missing = at;
            return {at, -kUnbounded, {}, bend};
        }
        return {at, tip->z, tip->slope, bend};
    }

    // A station with its position and direction along the plan path.
    struct Place {
        Station station;
        double along;
        Vec2d way;
    };

    Place place_of(std::size_t i)
    {
        const Stop& stop = stops_[i];
        return {station_at(stop.at, stop.bend), stop.along, tangent_at(*stop.edge, stop.at)};
    }

    // The last station added, as the start of a stretch.
    Place start_of(std::size_t first) const
    {
        const Station& last = row_.stations.back();
        return {last, begin_of(first), tangent_at(*stops_[first].edge, last.at)};
    }

    // The middle stop; by number if the stretch is short.
    std::size_t halfway(std::size_t first, std::size_t last) const
    {
        std::size_t half = first + (last - first) / 2;
        if (last - first >= kStretch) {
            const double middle = 0.5 * (begin_of(first) + stops_[last].along);
            half = first;
            while (stops_[half + 1].along <= middle) {
                ++half;
            }
        }
        return half;
    }

    // The middle and the end of a stretch.
    struct Lookups {
        Place middle;
        Place end;
    };

    // Stations between the stretch's middle and its ends are interpolated by cubics if the cubic
    // from end to end predicts the middle. Else a long stretch is halved, and a short one is
    // sampled at every station.
    void fill(const Place& start, std::size_t first, std::size_t last, const Lookups& known)
    {
        if (row_.missing) {
            return;
        }
        const std::size_t half = halfway(first, last);
        const double lookup_spacing = between(start, known.end, stops_[half]).height;
        const bool even = std::abs(lookup_spacing - known.middle.station.height) <=
                              kLookupShare * spacing_.height &&
                          interpolate(first, half, last, {start, known.middle, known.end});
        if (!even && last - first >= kStretch) {
            fill_half(start, first, half, known.middle);
            fill_half(known.middle, half + 1, last, known.end);
        } else if (!even) {
            step_along(first, last);
        }
    }

    void fill_half(const Place& start, std::size_t first, std::size_t last, const Place& end)
    {
        if (last < first + 2) {
            step_along(first, last);
        } else if (!row_.missing) {
            fill(start, first, last, {place_of(halfway(first, last)), end});
        }
    }

    // False, and nothing added, if the stations are not even.
    bool interpolate(std::size_t first,
                     std::size_t half,
                     std::size_t last,
                     const std::array<Place, 3>& known)
    {
        const auto& [start, middle, end] = known;
        const std::size_t before = row_.stations.size();
        const std::size_t corners = row_.corners.size();
        for (std::size_t i = first; i <= last; ++i) {
            Station next = i == half   ? middle.station
                           : i == last ? end.station
                                       : between(i < half ? start : middle, i < half ? middle : end,
                                                 stops_[i]);
            if (!is_even(row_.stations.back(), next)) {
                row_.stations.resize(before);
                row_.corners.resize(corners);
                return false;
            }
            add(next, stops_[i]);
        }
        return true;
    }

    void step_along(std::size_t first, std::size_t last)
    {
        for (std::size_t i = first; i <= last && !row_.missing; ++i) {
            step_to(i);
        }
    }

    // On the cubic through the heights and slopes at two places.
    static Station between(const Place& a, const Place& b, const Stop& stop)
    {
        const double whole = b.along - a.along;
        const double t = (stop.along - a.along) / whole;
        const double rise = b.station.height - a.station.height;
        const double leaving = whole * dot(a.station.gradient, a.way) - rise;
        const double arriving = rise - whole * dot(b.station.gradient, b.way);
        const double bow = t * (1.0 - t) * ((1.0 - t) * leaving + t * arriving);
        return {stop.at, a.station.height + t * rise + bow,
                a.station.gradient * (1.0 - t) + b.station.gradient * t, stop.bend};
    }

    void add(Station station, const Stop& stop)
    {
        station.exact = station.exact || stop.exact;
        row_.stations.push_back(station);
        if (stop.kink) {
            row_.corners.push_back(row_.stations.size() - 1);
        }
    }

    void step_to(std::size_t i)
    {
        const Stop& stop = stops_[i];
        Station next = station_at(stop.at, stop.bend);
        halve(*stop.edge, length(*stop.edge), stop.from, stop.to, next);
        add(next, stop);
    }

    static double jump(const Station& a, const Station& b)
    {
        return std::abs(b.height - a.height - 0.5 * dot(b.gradient + a.gradient, b.at - a.at));
    }

    bool is_even(const Station& a, const Station& b) const
    {
        const double hidden = 0.125 * std::abs(dot(b.gradient - a.gradient, b.at - a.at));
        return hidden < 0.05 * spacing_.height && jump(a, b) < 0.5 * spacing_.height;
    }

    // Adds stations between the last one and `next`, at shares `from` to `to` of the edge.
    void halve(const Edge& edge, double whole, double from, double to, Station& next)
    {
        const Station& last = row_.stations.back();
        if (row_.missing || is_even(last, next)) {
            return;
        }
        if ((to - from) * whole < kClosest) {
            // A cliff: no move may start to climb before it.
            const bool pencil = jump(last, next) >= 0.5 * spacing_.height;
            row_.stations.back().exact = row_.stations.back().exact || pencil;
            next.exact = next.exact || pencil;
            return;
        }
        const double middle = 0.5 * (from + to);
        Station between = station_at(point_on(edge, middle), next.bend);
        halve(edge, whole, from, middle, between);
        row_.stations.push_back(between);
        halve(edge, whole, middle, to, next);
    }

    const PathFloor* floor_;
    const StationSpacing& spacing_;
    std::vector<Stop> stops_;  // after the first station
    bool starts_exact_{};
    StationRow row_;
};

}  // namespace

StationRow stations_along(const std::vector<Edge>& plan,
                          const PathFloor* floor,
                          const StationSpacing& spacing)
{
    return RowBuilder{floor, spacing}.run(plan);
}

}  // namespace cusp::cl_path
