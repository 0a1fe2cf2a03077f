// Halving finds a line between two places; from there it is followed step by step both ways. At
// sharp corners a circle of places finds where it goes on.
#include "host_tools/contour_pocket/pencil_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "firmware/base/math.hpp"
#include "host_tools/part_model/pattern_search.hpp"

namespace cusp::contour_pocket {

using drop_cutter::DropCutter;
using offset::Box2d;
using offset::distance;
using offset::left_normal;
using offset::unit;
using part_model::pattern_search;

namespace {

constexpr double kGrid = 0.125;         // of the tool's radius
constexpr double kMostCells = 600.0;    // a side
constexpr double kTurn = 0.15;          // of the slope
constexpr double kUpright = 20.0;       // turns of the slope by more are jumps
constexpr double kLongestStep = 0.1;    // of the radius
constexpr double kShortestStep = 2e-3;  // of the radius
constexpr double kBeside = 0.35;        // of a step: how far beside its end the line is looked for
constexpr double kSame = 0.04;          // of the radius: how far along a line its places tell of it
constexpr double kBesideSame = 0.005;   // of the radius: lines farther beside each other are two
constexpr double kParallel = 0.9;       // cosine
constexpr double kDimple = 6.0;         // half sides of the grid: farther off it is another's

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
        const double grid = std::max(kGrid * radius_, longest / kMostCells);
        const int columns = static_cast<int>((box.x1 - box.x0) / grid) + 2;
        const int rows = static_cast<int>((box.y1 - box.y0) / grid) + 2;
        std::vector<GridPlace> before;
        for (int i = 0; i < columns; ++i) {
            std::vector<GridPlace> column;
            for (int j = 0; j < rows; ++j) {
                const Vec2d at{box.x0 + grid * i, box.y0 + grid * j};
                column.push_back({at, look(at)});
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
    struct Look {
        Vec2d at;
        DropCutter::ClPoint rest;
    };

    std::optional<Look> look(Vec2d at) const
    {
        if (!search_.inside(at)) {
            return std::nullopt;
        }
        const std::optional<DropCutter::ClPoint> cl = floor_.drop(at);
        return cl ? std::optional{Look{at, *cl}} : std::nullopt;
    }

    struct GridPlace {
        Vec2d at;
        std::optional<Look> look;
    };

    // A curve may run along walls, nearer to the border of the tool's positions than a cell.
    void start_on_edge(const GridPlace& a, const GridPlace& b)
    {
        if (a.look && b.look) {
            start_between(a.look, b.look);
        } else if (a.look) {
            start_between(a.look, look(last_inside(a.at, b.at)));
        } else if (b.look) {
            start_between(look(last_inside(b.at, a.at)), b.look);
        }
    }

    // On the way from a place inside to one that is not.
    Vec2d last_inside(Vec2d in, Vec2d out) const
    {
        while (distance(in, out) > nearest_) {
            const Vec2d middle = (in + out) * 0.5;
            (search_.inside(middle) ? in : out) = middle;
        }
        return in;
    }

    struct Bend {
        double jump;  // mm that the slopes at the ends do not explain
        double turn;  // of the slope, upward
    };

    static Bend bend(const Look& a, const Look& b)
    {
        const Vec2d way = b.at - a.at;
        const double apart = std::sqrt(dot(way, way));
        const double by_slopes = 0.5 * dot(a.rest.slope + b.rest.slope, way);
        return {std::abs(b.rest.z - a.rest.z - by_slopes),
                dot(b.rest.slope - a.rest.slope, way) / apart};
    }

    // A smooth valley as tight as the tool turns no more over that way.
    bool is_uneven(const Look& a, const Look& b) const
    {
        return bend(a, b).jump > search_.jump || is_tight(a, b);
    }

    bool is_tight(const Look& a, const Look& b) const
    {
        return bend(a, b).turn > kTurn + distance(a.at, b.at) / radius_;
    }

    // Where between two places a line passes, and the nearest ones on its sides.
    struct Crossing {
        PencilPoint point;
        Look before;
        Look behind;
    };

    std::optional<Crossing> crossing(const std::optional<Look>& from,
                                     const std::optional<Look>& to) const
    {
        if (!from || !to || !is_uneven(*from, *to)) {
            return std::nullopt;
        }
        Look a = *from;
        Look b = *to;
        const auto weight = [](const Look& p, const Look& q) {
            const Bend found = bend(p, q);
            return found.jump + 0.5 * std::max(0.0, found.turn) * distance(p.at, q.at);
        };
        while (distance(a.at, b.at) > nearest_) {
            const std::optional<Look> middle = look((a.at + b.at) * 0.5);
            if (!middle) {
                return std::nullopt;
            }
            (weight(a, *middle) > weight(*middle, b) ? b : a) = *middle;
        }
        const double rise = b.rest.z - a.rest.z;
        const double turn = bend(a, b).turn;
        const bool jump = std::abs(rise) > search_.jump || turn > kUpright;
        if (!jump && turn < kTurn) {
            return std::nullopt;
        }
        const Vec2d way = unit(b.at - a.at);
        const double climb = dot(a.rest.slope + b.rest.slope, way);
        const bool low_first = jump ? rise > 0.0 : climb > 0.0;
        const PencilPoint point =
            low_first ? PencilPoint{a.at, way * -1.0, jump} : PencilPoint{b.at, way, jump};
        return Crossing{point, a, b};
    }

    std::optional<PencilPoint> between(const std::optional<Look>& a,
                                       const std::optional<Look>& b) const
    {
        const std::optional<Crossing> found = crossing(a, b);
        return found ? std::optional{found->point} : std::nullopt;
    }

    std::optional<PencilPoint> between(Vec2d a, Vec2d b) const { return between(look(a), look(b)); }

    // Places of the lines found so far, by square cells of side kSame radii.
    using Cell = std::array<int, 2>;
    struct Traced {
        Vec2d at;
        Vec2d way;  // of the line there; zero at its start
        std::size_t line;
        std::size_t point;
        double gone;  // mm: of the way that line was followed
    };

    Cell cell_of(Vec2d p) const
    {
        return {static_cast<int>(std::floor(p.x / traced_cell_)),
                static_cast<int>(std::floor(p.y / traced_cell_))};
    }

    // Whether the line that was followed to there passes by p: a ledge has two beside each other.
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

    void mark(Vec2d from, Vec2d to, std::size_t line, std::size_t point, double gone)
    {
        const int n = 1 + static_cast<int>(2.0 * distance(from, to) / traced_cell_);
        const Vec2d way = distance(from, to) > 0.0 ? unit(to - from) : Vec2d{};
        for (int i = 1; i <= n; ++i) {
            const Vec2d p = from + (to - from) * (static_cast<double>(i) / n);
            traced_[cell_of(p)].push_back({p, way, line, point, gone});
        }
    }

    // Halving finds the steepest line: beside a jump there may be others, of ledges.
    void start_between(const std::optional<Look>& a, const std::optional<Look>& b, int ledges = 0)
    {
        constexpr int kMostLedges = 3;
        const std::optional<Crossing> found = crossing(a, b);
        if (!found) {
            if (a && b && is_tight(*a, *b)) {
                go_through_dimple(*a, *b);
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
        const std::optional<PencilPoint> start = squared(found);
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

    // A tool that sinks into a hole is lowest at one place, from where no curve leads on. The
    // nearer the line from a to b passes it the tighter it turns, and smoothly. That place gets a
    // straight line through it.
    void go_through_dimple(const Look& a, const Look& b)
    {
        const double step = 0.5 * distance(a.at, b.at);
        const Vec2d start = (a.at + b.at) * 0.5;
        double lowest = std::min(a.rest.z, b.rest.z);
        const auto lower = [&](Vec2d to) {
            const auto there = distance(to, start) < kDimple * step ? look(to) : std::nullopt;
            const bool found = there && there->rest.z < lowest;
            lowest = found ? there->rest.z : lowest;
            return found;
        };
        const Vec2d bottom = pattern_search(start, step, nearest_, lower);
        const auto any = [](const Traced&) {
            return true;
        };
        if (traced_near(bottom, traced_cell_, any) || !rises_all_round(bottom)) {
            return;
        }
        std::vector<PencilPoint> way;
        const auto add = [&](int k) {
            const Vec2d at = bottom + Vec2d{k * kLongestStep * radius_, 0.0};
            const bool stands = look(at).has_value();
            if (stands) {
                way.push_back({at, {}, false});
            }
            return stands;
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

    // Whether slopes turn there whichever way it is passed.
    bool rises_all_round(Vec2d bottom) const
    {
        const double out = 0.2 * kGrid * radius_;
        for (const Vec2d way : {Vec2d{out, 0.0}, Vec2d{0.0, out}}) {
            const std::optional<Look> a = look(bottom - way);
            const std::optional<Look> b = look(bottom + way);
            if (!a || !b || bend(*a, *b).turn < kTurn) {
                return false;
            }
        }
        return true;
    }

    // The same place of the line, met square to it: by two more places beside.
    std::optional<PencilPoint> squared(const PencilPoint& start) const
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

    // Where lines leave a circle about a place.
    std::vector<PencilPoint> circle(Vec2d centre, double out) const
    {
        constexpr int kPlaces = 24;
        std::vector<PencilPoint> found;
        const auto place = [&](int i) {
            const double angle = 2 * kPi * (i + 0.37) / kPlaces;
            return look(centre + Vec2d{std::cos(angle), std::sin(angle)} * out);
        };
        std::optional<Look> last = place(0);
        for (int i = 1; i <= kPlaces; ++i) {
            std::optional<Look> next = place(i);
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

    // The next place of the line, as far on as its chord allows.
    std::optional<Step> next(const PencilPoint& from, Vec2d way, double& step) const
    {
        const double shortest = kShortestStep * radius_;
        while (step >= shortest) {
            const Vec2d ahead = from.at + way * step;
            const Vec2d side = left_normal(way) * (kBeside * step);
            const auto found = between(ahead - side, ahead + side);
            if (found) {
                const Vec2d gone = found->at - from.at;
                const double off = std::abs(dot(gone, left_normal(way)));
                const double room = (found->jump ? 4.0 : 40.0) * search_.fine;
                if (off <= room || step < 2.0 * shortest) {
                    const Vec2d on = unit(gone);
                    step *= off < 0.3 * room ? 1.5 : 1.0;
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

    // On from the last place of the last line.
    void follow(Vec2d way)
    {
        constexpr int kMostPoints = 200000;
        const std::size_t line = lines_.size() - 1;
        std::vector<PencilPoint>& points = lines_.back().points;
        double step = 0.25 * kLongestStep * radius_;
        double gone = 0.0;
        for (int i = 0; i < kMostPoints; ++i) {
            const PencilPoint last = points.back();
            const auto on = next(last, way, step);
            if (!on) {
                return;
            }
            const double apart = distance(last.at, on->point.at);
            gone += apart;
            const double reach = std::min(0.7 * apart, 0.7 * traced_cell_);
            // One that comes round beside its start would go round for ever.
            const auto far_back = [&](const Traced& place) {
                const double since = place.point < first_of_way_back_ ? 0.0 : place.gone;
                const bool far = place.line != line || gone - since > 4.0 * traced_cell_;
                const bool along = std::abs(dot(place.way, on->way)) > kParallel;
                return far && (!along || passes_by(place, on->point.at));
            };
            const auto met = traced_near(on->point.at, reach, far_back);
            points.push_back(on->point);
            if (met) {
                lines_.back().closed =
                    met->line == line &&
                    distance(points.front().at, on->point.at) < 4.0 * traced_cell_;
                return;
            }
            mark(last.at, on->point.at, line, points.size() - 1, gone);
            way = on->way;
        }
    }

    const DropCutter& floor_;
    const PencilSearch& search_;
    double radius_;
    double nearest_;  // mm: halving ends
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
