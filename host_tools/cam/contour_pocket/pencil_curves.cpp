// Bisection finds a point of a line between two samples. From there the line is traced step by step
// in both directions; at sharp corners a circle of samples finds its continuation.
#include "host_tools/cam/contour_pocket/pencil_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/part_model/pattern_search.hpp"

namespace cusp::contour_pocket {

using drop_cutter::DropCutter;
using offset::Box2d;
using offset::distance;
using offset::left_normal;
using offset::unit;
using part_model::pattern_search;

namespace {

constexpr double kGrid = 0.125;             // of the tool's radius
constexpr double kMostPencilCells = 600.0;  // a side
constexpr double kTurn = 0.15;              // of the slope
constexpr double kSteepest = 20.0;          // larger changes of the slope are jumps
constexpr double kLongestStep = 0.1;        // of the radius
constexpr double kShortestStep = 2e-3;      // of the radius
constexpr double kBeside = 0.35;            // of a step: search beside its end
constexpr double kSame = 0.04;              // of the radius: along a line, near its points
constexpr double kBesideSame = 0.005;       // of the radius: beside a line
constexpr double kParallel = 0.9;           // cosine
constexpr double kDimple = 6.0;             // half sides of the grid: largest distance

class LineTracer {
public:
    LineTracer(const DropCutter& floor, const PencilSearch& search)
        : floor_{floor},
          search_{search},
          radius_{floor.tool().radius},
          nearest_{0.1 * search.fine},
          traced_cell_{kSame * floor.tool().radius}
    {
    }

    std::vector<PencilCurve> run()
    {
        const Box2d& box = search_.box;
        const double longest = std::max(box.x1 - box.x0, box.y1 - box.y0);
        const double grid = std::max(kGrid * radius_, longest / kMostPencilCells);
        const int columns = static_cast<int>((box.x1 - box.x0) / grid) + 2;
        const int rows = static_cast<int>((box.y1 - box.y0) / grid) + 2;
        std::vector<GridPlace> before;
        for (int i = 0; i < columns; ++i) {
            std::vector<GridPlace> column;
            for (int j = 0; j < rows; ++j) {
                const Vec2d at{box.x0 + grid * i, box.y0 + grid * j};
                column.push_back({at, sample(at)});
                const auto here = static_cast<std::size_t>(j);
                if (j > 0) {
                    start_on_edge(column[here - 1], column[here]);
                }
                if (i > 0) {
                    start_on_edge(before[here], column[here]);
                }
            }
            before = std::move(column);
        }
        return std::move(lines_);
    }

private:
    struct Sample {
        Vec2d at;
        DropCutter::ClPoint cl;
    };

    std::optional<Sample> sample(Vec2d at) const
    {
        if (!search_.inside(at)) {
            return std::nullopt;
        }
        const std::optional<DropCutter::ClPoint> cl = floor_.drop(at);
        return cl ? std::optional{Sample{at, *cl}} : std::nullopt;
    }

    struct GridPlace {
        Vec2d at;
        std::optional<Sample> sample;
    };

    // A curve may run along walls, less than a cell from the border of the tool's positions.
    void start_on_edge(const GridPlace& a, const GridPlace& b)
    {
        if (a.sample && b.sample) {
            start_between(a.sample, b.sample);
        } else if (a.sample) {
            start_between(a.sample, sample(last_inside(a.at, b.at)));
        } else if (b.sample) {
            start_between(sample(last_inside(b.at, a.at)), b.sample);
        }
    }

    // The last point inside on the segment from an inside point to one outside.
    Vec2d last_inside(Vec2d in, Vec2d out) const
    {
        while (distance(in, out) > nearest_) {
            const Vec2d middle = (in + out) * 0.5;
            (search_.inside(middle) ? in : out) = middle;
        }
        return in;
    }

    struct Bend {
        double jump;  // mm not explained by the slopes at both ends
        double turn;  // of the slope, upward
    };

    static Bend bend(const Sample& a, const Sample& b)
    {
        const Vec2d way = b.at - a.at;
        const double apart = std::sqrt(dot(way, way));
        const double by_slopes = 0.5 * dot(a.cl.slope + b.cl.slope, way);
        return {std::abs(b.cl.z - a.cl.z - by_slopes), dot(b.cl.slope - a.cl.slope, way) / apart};
    }

    // If a smooth valley is as tight as the tool, the slope turns no more over that distance.
    bool is_uneven(const Sample& a, const Sample& b) const
    {
        return bend(a, b).jump > search_.jump || is_tight(a, b);
    }

    bool is_tight(const Sample& a, const Sample& b) const
    {
        return bend(a, b).turn > kTurn + distance(a.at, b.at) / radius_;
    }

    // The place at which a line passes between two samples, and the nearest samples on both sides.
    struct Crossing {
        PencilPoint point;
        Sample before;
        Sample behind;
    };

    std::optional<Crossing> crossing(const std::optional<Sample>& from,
                                     const std::optional<Sample>& to) const
    {
        if (!from || !to || !is_uneven(*from, *to)) {
            return std::nullopt;
        }
        Sample a = *from;
        Sample b = *to;
        const auto weight = [](const Sample& p, const Sample& q) {
            const Bend found = bend(p, q);
            return found.jump + 0.5 * std::max(0.0, found.turn) * distance(p.at, q.at);
        };
        while (distance(a.at, b.at) > nearest_) {
            const std::optional<Sample> middle = sample((a.at + b.at) * 0.5);
            if (!middle) {
                return std::nullopt;
            }
            (weight(a, *middle) > weight(*middle, b) ? b : a) = *middle;
        }
        const double rise = b.cl.z - a.cl.z;
        const double turn = bend(a, b).turn;
        const bool jump = std::abs(rise) > search_.jump || turn > kSteepest;
        if (!jump && turn < kTurn) {
            return std::nullopt;
        }
        const Vec2d way = unit(b.at - a.at);
        const double climb = dot(a.cl.slope + b.cl.slope, way);
        const bool low_first = jump ? rise > 0.0 : climb > 0.0;
        const PencilPoint point =
            low_first ? PencilPoint{a.at, way * -1.0, jump} : PencilPoint{b.at, way, jump};
        return Crossing{point, a, b};
    }

    std::optional<PencilPoint> between(const std::optional<Sample>& a,
                                       const std::optional<Sample>& b) const
    {
        const std::optional<Crossing> found = crossing(a, b);
        return found ? std::optional{found->point} : std::nullopt;
    }

    std::optional<PencilPoint> between(Vec2d a, Vec2d b) const
    {
        return between(sample(a), sample(b));
    }

    // Points of the lines found so far, in square cells of side kSame radii.
    using Cell = std::array<int, 2>;
    struct Traced {
        Vec2d at;
        Vec2d way;  // direction of the line; zero at its start
        std::size_t line;
        std::size_t point;
        double along;  // mm: distance along the line from its start
    };

    Cell cell_of(Vec2d p) const
    {
        return {static_cast<int>(std::floor(p.x / traced_cell_)),
                static_cast<int>(std::floor(p.y / traced_cell_))};
    }

    // True if the line traced up to there passes by p. A ledge has two lines beside each other.
    bool passes_by(const Traced& place, Vec2d p) const
    {
        const Vec2d arm = p - place.at;
        const bool starts = dot(place.way, place.way) == 0.0;
        const double beside = starts ? norm(arm) : std::abs(cross(place.way, arm));
        return beside < kBesideSame * radius_;
    }

    template <class Counts>
    std::optional<Traced> traced_near(Vec2d p, double reach, Counts counts) const
    {
        const Cell cell = cell_of(p);
        std::optional<Traced> nearest;
        for (int i = -1; i <= 1; ++i) {
            for (int j = -1; j <= 1; ++j) {
                const auto found = traced_.find({cell[0] + i, cell[1] + j});
                if (found == traced_.end()) {
                    continue;
                }
                for (const Traced& place : found->second) {
                    const double apart = distance(place.at, p);
                    if (apart < reach && counts(place)) {
                        reach = apart;
                        nearest = place;
                    }
                }
            }
        }
        return nearest;
    }

    void mark(Vec2d from, Vec2d to, std::size_t line, std::size_t point, double along)
    {
        const int n = 1 + static_cast<int>(2.0 * distance(from, to) / traced_cell_);
        const Vec2d way = distance(from, to) > 0.0 ? unit(to - from) : Vec2d{};
        for (int i = 1; i <= n; ++i) {
            const Vec2d p = from + (to - from) * (static_cast<double>(i) / n);
            traced_[cell_of(p)].push_back({p, way, line, point, along});
        }
    }

    // Bisection finds the steepest line. Beside a jump there may be others, those of ledges.
    void start_between(const std::optional<Sample>& a,
                       const std::optional<Sample>& b,
                       int ledges = 0)
    {
        constexpr int kMostLedges = 3;
        const std::optional<Crossing> found = crossing(a, b);
        if (!found) {
            if (a && b && is_tight(*a, *b)) {
                cross_dimple(*a, *b);
            }
            return;
        }
        start_at(found->point);
        if (found->point.jump && ledges < kMostLedges) {
            start_between(a, found->before, ledges + 1);
            start_between(found->behind, b, ledges + 1);
        }
    }

    void start_at(const PencilPoint& found)
    {
        const auto passes = [&](const Traced& place) {
            return passes_by(place, found.at);
        };
        if (traced_near(found.at, traced_cell_, passes)) {
            return;
        }
        const std::optional<PencilPoint> start = met_perpendicular(found);
        if (!start) {
            return;
        }
        lines_.push_back({{*start}, false});
        mark(start->at, start->at, lines_.size() - 1, 0, 0.0);
        follow(left_normal(start->low_side));
        if (!lines_.back().closed) {
            std::reverse(lines_.back().points.begin(), lines_.back().points.end());
            first_of_way_back_ = lines_.back().points.size();
            follow(left_normal(start->low_side) * -1.0);
            first_of_way_back_ = 0;
        }
        if (lines_.back().points.size() < 2) {
            lines_.pop_back();
        }
    }

    // In a hole narrower than the tool the height of the tip has a single lowest point, and no
    // pencil curve starts there: sections near the point bend tightly, but smoothly. The result is a
    // straight line through that point.
    void cross_dimple(const Sample& a, const Sample& b)
    {
        const double step = 0.5 * distance(a.at, b.at);
        const Vec2d start = (a.at + b.at) * 0.5;
        double lowest = std::min(a.cl.z, b.cl.z);
        const auto lower = [&](Vec2d to) {
            const auto there = distance(to, start) < kDimple * step ? sample(to) : std::nullopt;
            const bool found = there && there->cl.z < lowest;
            lowest = found ? there->cl.z : lowest;
            return found;
        };
        const Vec2d bottom = pattern_search(start, step, nearest_, lower);
        const auto any = [](const Traced&) {
            return true;
        };
        if (traced_near(bottom, traced_cell_, any) || !rises_in_all_directions(bottom)) {
            return;
        }
        std::vector<PencilPoint> way;
        const auto add = [&](int k) {
            const Vec2d at = bottom + Vec2d{k * kLongestStep * radius_, 0.0};
            const bool found = sample(at).has_value();
            if (found) {
                way.push_back({at, {}, false});
            }
            return found;
        };
        constexpr int kSteps = 10;
        for (int k = 0; k <= kSteps && add(-k); ++k) {
        }
        std::reverse(way.begin(), way.end());
        for (int k = 1; k <= kSteps && add(k); ++k) {
        }
        lines_.push_back({std::move(way), false});
        mark(bottom, bottom, lines_.size() - 1, 0, 0.0);
    }

    // True if the slope turns up there in every direction.
    bool rises_in_all_directions(Vec2d bottom) const
    {
        const double out = 0.2 * kGrid * radius_;
        for (const Vec2d way : {Vec2d{out, 0.0}, Vec2d{0.0, out}}) {
            const std::optional<Sample> a = sample(bottom - way);
            const std::optional<Sample> b = sample(bottom + way);
            if (!a || !b || bend(*a, *b).turn < kTurn) {
                return false;
            }
        }
        return true;
    }

    // Finds a point of the line again on a section perpendicular to the line, whose direction is
    // that of two neighbouring points.
    std::optional<PencilPoint> met_perpendicular(const PencilPoint& start) const
    {
        const double step = 4.0 * kShortestStep * radius_;
        const std::vector<PencilPoint> around = circle(start.at, step);
        if (around.empty()) {
            return std::nullopt;
        }
        const Vec2d along = unit(around.front().at - start.at);
        const Vec2d side = left_normal(along) * step;
        const auto found = between(start.at - side, start.at + side);
        return found ? found : around.front();
    }

    // Places where lines leave a circle around a place.
    std::vector<PencilPoint> circle(Vec2d centre, double out) const
    {
        constexpr int kPlaces = 24;
        std::vector<PencilPoint> found;
        const auto place = [&](int i) {
            const double angle = 2 * kPi * (i + 0.37) / kPlaces;
            return sample(centre + Vec2d{elementary::cos(angle), elementary::sin(angle)} * out);
        };
        std::optional<Sample> last = place(0);
        for (int i = 1; i <= kPlaces; ++i) {
            std::optional<Sample> next = place(i);
            if (const auto point = between(last, next)) {
                found.push_back(*point);
            }
            last = std::move(next);
        }
        return found;
    }

    struct Step {
        PencilPoint point;
        Vec2d way;
    };

    // The next point of the line, as far ahead as the tolerance of chords allows.
    std::optional<Step> next(const PencilPoint& from, Vec2d way, double& step) const
    {
        const double shortest = kShortestStep * radius_;
        while (step >= shortest) {
            const Vec2d ahead = from.at + way * step;
            const Vec2d side = left_normal(way) * (kBeside * step);
            const auto found = between(ahead - side, ahead + side);
            if (found) {
                const Vec2d step_taken = found->at - from.at;
                const double error = std::abs(dot(step_taken, left_normal(way)));
                const double room = (found->jump ? 4.0 : 40.0) * search_.fine;
                if (error <= room || step < 2.0 * shortest) {
                    const Vec2d on = unit(step_taken);
                    step *= error < 0.3 * room ? 1.5 : 1.0;
                    step = std::min(step, kLongestStep * radius_);
                    return Step{*found, on};
                }
            }
            step *= 0.5;
        }
        step = shortest;
        std::optional<Step> best;
        double straightest = -0.5;  // cosine of the sharpest turn
        for (const PencilPoint& point : circle(from.at, 4.0 * shortest)) {
            const Vec2d on = unit(point.at - from.at);
            if (dot(on, way) > straightest) {
                straightest = dot(on, way);
                best = Step{point, on};
            }
        }
        return best;
    }

    // Continues the trace from the last point of the last line.
    void follow(Vec2d way)
    {
        constexpr int kMostPoints = 200000;
        const std::size_t line = lines_.size() - 1;
        std::vector<PencilPoint>& points = lines_.back().points;
        double step = 0.25 * kLongestStep * radius_;
        double along = 0.0;
        for (int i = 0; i < kMostPoints; ++i) {
            const PencilPoint last = points.back();
            const auto on = next(last, way, step);
            if (!on) {
                return;
            }
            const double apart = distance(last.at, on->point.at);
            along += apart;
            const double reach = std::min(0.7 * apart, 0.7 * traced_cell_);
            // A line that returns beside its start would never end.
            const auto far_back = [&](const Traced& place) {
                const double since = place.point < first_of_way_back_ ? 0.0 : place.along;
                const bool far = place.line != line || along - since > 4.0 * traced_cell_;
                const bool parallel = std::abs(dot(place.way, on->way)) > kParallel;
                return far && (!parallel || passes_by(place, on->point.at));
            };
            const auto met = traced_near(on->point.at, reach, far_back);
            points.push_back(on->point);
            if (met) {
                lines_.back().closed =
                    met->line == line &&
                    distance(points.front().at, on->point.at) < 4.0 * traced_cell_;
                return;
            }
            mark(last.at, on->point.at, line, points.size() - 1, along);
            way = on->way;
        }
    }

    const DropCutter& floor_;
    const PencilSearch& search_;
    double radius_;
    double nearest_;  // mm: bisection ends
    double traced_cell_;
    std::vector<PencilCurve> lines_;
    std::map<Cell, std::vector<Traced>> traced_;
    std::size_t first_of_way_back_{0};
};

}  // namespace

std::vector<PencilCurve> pencil_curves(const DropCutter& floor, const PencilSearch& search)
{
    return LineTracer{floor, search}.run();
}

}  // namespace cusp::contour_pocket
