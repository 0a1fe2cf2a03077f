// Greedy wedges for lines, circles through three points for arcs.
#include "host_tools/cam/cl_path/tolerance_chain.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::cl_path {

using offset::left_normal;
using offset::unit;

namespace {

// Allowed deviation between stations, relative to that at stations.
constexpr double kBetween = 1.15;
// Radii of arcs, mm.
constexpr double kSmallest = 0.5;
constexpr double kSmallestDrawn = 0.005;
constexpr double kAsDrawn = 0.05;  // of the curvature

// Directions between two unit vectors, less than half a turn counter-clockwise from low to high.
struct Wedge {
    Vec2d low;
    Vec2d high;

    Vec2d middle() const
    {
        return dot(low, high) > 0.0 ? unit(low + high) : unit(left_normal(low) - left_normal(high));
    }
};

// The directions from the origin to all points within `room` of the end of `arm`, whose length is `apart` > room.
Wedge wedge_about(Vec2d arm, double apart, double room)
{
    const Vec2d way = arm * (1.0 / apart);
    const double sine = room / apart;
    const Vec2d ahead = way * std::sqrt(1.0 - sine * sine);
    const Vec2d aside = left_normal(way) * sine;
    return {ahead - aside, ahead + aside};
}

// Possible slopes of z of a straight line from a point, narrowed by the bands of stations.
struct Rise {
    double low{-kUnbounded};
    double high{kUnbounded};

    void pass(double along, double from, double to)
    {
        low = std::max(low, from / along);
        high = std::min(high, to / along);
    }
    bool open() const { return low <= high; }
};

class ChainBuilder {
public:
    ChainBuilder(const std::vector<Station>& stations,
                 const StationBand& band,
                 bool arcs,
                 bool closed)
        : stations_{stations}, band_{band}, arcs_{arcs}, closed_{closed}, last_{0}
    {
    }

    Chain run()
    {
        const Station& first = stations_.front();
        at_ = first.at;
        z_ = first.height + band_.middle_at(first);
        Chain chain{{at_.x, at_.y, z_}, {}};
        for (std::size_t i = 0; i + 1 < stations_.size();) {
            const std::size_t from = i;
            const auto next =
                std::find_if(stations_.begin() + static_cast<std::ptrdiff_t>(from) + 1,
                             stations_.end() - 1, [](const Station& s) { return s.exact; });
            last_ = static_cast<std::size_t>(next - stations_.begin());
            home_ = next->exact ? middle_of(*next) : chain.start;
            fixed_end_ = next->exact || closed_;
            while (i < last_) {
                i = extend(chain, i);
            }
        }
        return chain;
    }

private:
    // Appends the longest move from station i; returns the station at its end.
    std::size_t extend(Chain& chain, std::size_t i)
    {
        Reach best = farthest_line(i);
        if (arcs_) {
            const Reach arc = farthest_arc(i, best.station);
            best = arc.station > best.station + 1 ? arc : best;
        }
        chain.moves.push_back(best.move);
        at_ = {best.move.end.x, best.move.end.y};
        z_ = best.move.end.z;
        return best.station;
    }

    Vec3d middle_of(const Station& s) const
    {
        return {s.at.x, s.at.y, s.height + band_.middle_at(s)};
    }

    struct Reach {
        std::size_t station;
        ClMove move;
    };

    bool ends_home(std::size_t j) const { return fixed_end_ && j == last_; }

    // The last station up to which one line from here passes all stations; `way` becomes the middle
    // of the directions of such lines.
    std::size_t widest_wedge(std::size_t i, Vec2d& way) const
    {
        std::size_t good = i + 1;
        bool set = false;
        double along = 0.0;
        Wedge wedge{};
        for (std::size_t k = i + 1; k <= last_; ++k) {
            const Vec2d target = ends_home(k) ? in_plan(home_) : stations_[k].at;
            const Vec2d arm = target - at_;
            const double apart = std::sqrt(dot(arm, arm));
            const double room = ends_home(k) ? 1e-9 : band_.plan_tolerance;
            if (apart <= room) {
                if (set) {
                    break;  // the path returns
                }
                good = k;
                continue;
            }
            Wedge next = wedge_about(arm, apart, room);
            if (set) {
                if (dot(arm, way) < 0.0) {
                    break;
                }
                next.low = cross(wedge.low, next.low) > 0.0 ? next.low : wedge.low;
                next.high = cross(next.high, wedge.high) > 0.0 ? next.high : wedge.high;
            }
            const Vec2d middle = next.middle();
            const double here = dot(arm, middle);
            if (cross(next.low, next.high) < 0.0 || here < along) {
                break;
            }
            wedge = next;
            set = true;
            along = here;
            good = k;
            way = middle;
        }
        if (!set) {
            const Vec2d arm = stations_[good].at - at_;
            way = dot(arm, arm) > 0.0 ? unit(arm) : Vec2d{1.0, 0.0};
        }
        return good;
    }

    Reach farthest_line(std::size_t i) const
    {
        Vec2d way{};
        std::size_t limit = widest_wedge(i, way);
        for (int round = 0; round < 40; ++round) {
            if (const auto reach = line_to(i, limit, way)) {
                if (reach->station >= limit || reach->station == i + 1) {
                    return *reach;
                }
                // The floor limits the line: fewer stations leave a wider range of directions.
                limit = reach->station;
            } else {
                limit = i + 1;
            }
            narrow_to(i, limit, way);
        }
        return plain(i, i + 1);
    }

    // Sets `way` to the direction for stations up to `limit` only.
    void narrow_to(std::size_t i, std::size_t limit, Vec2d& way) const
    {
        ChainBuilder part = *this;
        part.fixed_end_ = ends_home(limit);
        part.last_ = limit;
        part.widest_wedge(i, way);
    }

    Reach plain(std::size_t, std::size_t j) const
    {
        if (ends_home(j)) {
            return {j, {home_}};
        }
        return {j, {middle_of(stations_[j])}};
    }

    // The line in a direction up to station `limit` or as far as z allows. None if not even the
    // first station is within reach.
    std::optional<Reach> line_to(std::size_t i, std::size_t limit, Vec2d way) const
    {
        const bool home = ends_home(limit);
        if (home) {
            way = unit(in_plan(home_) - at_);
        }
        Rise rise;
        std::optional<Reach> reach;
        for (std::size_t k = i + 1; k <= limit; ++k) {
            const Station& s = stations_[k];
            const double along = std::max(dot(s.at - at_, way), 1e-9);
            const Vec2d error = at_ + way * along - s.at;
            const double floor = s.height + dot(s.gradient, error);
            Rise next = rise;
            if (ends_home(k)) {
                next.pass(along, home_.z - z_, home_.z - z_);
            } else {
                next.pass(along, floor + band_.low_at(s) - z_, floor + band_.high_at(s) - z_);
            }
            if (!next.open()) {
                break;
            }
            rise = next;
            const double z = z_ + along * 0.5 * (rise.low + rise.high);
            const Vec2d end = at_ + way * along;
            reach = Reach{k, {ends_home(k) ? home_ : Vec3d{end.x, end.y, z}}};
        }
        return reach;
    }

    // An arc from here through a station near the middle to station j.
    std::optional<Reach> arc_to(std::size_t i, std::size_t j) const
    {
        const Vec2d end = ends_home(j) ? in_plan(home_) : stations_[j].at;
        const Vec2d u = stations_[i + (j - i) / 2].at - at_;
        const Vec2d v = end - at_;
        const double bend = 2.0 * cross(u, v);
        if (std::abs(bend) < 1e-9 || dot(v, v) < 1e-6) {
            return std::nullopt;
        }
        const Vec2d w = v * dot(u, u) - u * dot(v, v);
        const Vec2d centre = at_ + Vec2d{w.y, -w.x} * (1.0 / bend);
        const Vec2d arm = at_ - centre;
        const double radius = std::sqrt(dot(arm, arm));
        const int turn = bend > 0.0 ? 1 : -1;
        const auto angle_of = [&](Vec2d p) {
            return elementary::atan2(cross(arm, p - centre), dot(arm, p - centre)) * turn;
        };
        // A smaller one is none of the floor's noise where the plan path itself is that arc.
        const bool drawn =
            std::abs(stations_[i + (j - i) / 2].bend * radius * turn - 1.0) < kAsDrawn;
        if (radius < (drawn ? kSmallestDrawn : kSmallest) || radius > 2000.0) {
            return std::nullopt;
        }
        Rise rise;
        double before = 0.0;
        double beside = 0.0;
        for (std::size_t k = i + 1; k <= j; ++k) {
            const Station& s = stations_[k];
            const Vec2d spoke = (k == j ? end : s.at) - centre;
            const double angle = angle_of(k == j ? end : s.at);
            const double share = radius / std::sqrt(dot(spoke, spoke)) - 1.0;
            const double here = std::abs(share) * std::sqrt(dot(spoke, spoke));
            const double apart = radius * (angle - before);
            const double bulge = 0.125 * apart * apart * std::abs(turn / radius - s.bend);
            if (angle < before || angle > 3.0 || here > band_.plan_tolerance ||
                std::max(here, beside) + bulge > kBetween * band_.plan_tolerance) {
                return std::nullopt;
            }
            beside = here;
            before = angle;
            if (angle < 1e-9) {
                continue;
            }
            const double floor = s.height + dot(s.gradient, spoke * share);
            if (ends_home(k)) {
                rise.pass(angle, home_.z - z_, home_.z - z_);
            } else {
                rise.pass(angle, floor + band_.low_at(s) - z_, floor + band_.high_at(s) - z_);
            }
            if (!rise.open()) {
                return std::nullopt;
            }
        }
        const double z = z_ + before * 0.5 * (rise.low + rise.high);
        const Vec3d tip = ends_home(j) ? home_ : Vec3d{end.x, end.y, z};
        return Reach{j, {tip, centre, turn}};
    }

    Reach farthest_arc(std::size_t i, std::size_t floor_of_search) const
    {
        Reach best = plain(i, i + 1);
        std::size_t stride = std::max<std::size_t>(floor_of_search - i + 1, 3);
        std::size_t bad = last_ + 1;
        while (i + stride <= last_) {
            if (const auto reach = arc_to(i, i + stride)) {
                best = *reach;
                stride *= 2;
            } else {
                bad = i + stride;
                break;
            }
        }
        std::size_t good = best.station;
        while (bad - good > 1) {
            const std::size_t middle = good + (bad - good) / 2;
            if (const auto reach = arc_to(i, middle)) {
                best = *reach;
                good = middle;
            } else {
                bad = middle;
            }
        }
        return best;
    }

    const std::vector<Station>& stations_;
    StationBand band_;
    bool arcs_;
    bool closed_;
    std::size_t last_;  // of the run up to an exact station
    Vec2d at_{};
    double z_{};
    Vec3d home_{};  // required position at station `last_`
    bool fixed_end_{};
};

}  // namespace

Chain chain_through(const std::vector<Station>& stations,
                    const StationBand& band,
                    bool arcs,
                    bool closed)
{
    return ChainBuilder{stations, band, arcs, closed}.run();
}

}  // namespace cusp::cl_path
