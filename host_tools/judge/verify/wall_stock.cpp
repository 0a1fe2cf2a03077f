// Places along the wall, and the move that comes nearest: in most places it is where the tool belongs.
#include "host_tools/judge/verify/wall_stock.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/part_model/grid_square.hpp"
#include "host_tools/geometry/toolpath/tool_tip.hpp"
#include "host_tools/job/job/chamfer_tip.hpp"
#include "host_tools/job/job/hole_depth.hpp"
#include "host_tools/job/job/loop_shape.hpp"
#include "host_tools/judge/verify/wall_distance.hpp"

namespace cusp::verify {

using job::Chain;
using job::loop_polyline;
using job::NestedLoop;
using job::Operation;
using job::Prismatic;
using part_model::square_key;
using toolpath::end_height;
using toolpath::radius_at_height;
using toolpath::Tool;

namespace {

constexpr double kSpare = 0.02;    // mm: of the room that a tool needs, at least
constexpr double kStep = 0.1;      // mm along the wall
constexpr double kSquare = 2.0;    // mm: side of a square of moves
constexpr double kThickest = 1.0;  // mm: stock that is thicker is a pass that is missing
constexpr double kNothing = 1e-9;  // mm
constexpr int kGougeLooks = 8;     // from the wall to where the tool reaches

bool follows_curves(const Operation& operation)
{
    return operation.cuts(job::Region::kGrooves) ||
           (operation.cuts(job::Region::kOutline) &&
            operation.prismatic->side == job::ProfileSide::kOn);
}

bool has_walls(const Operation& operation)
{
    return operation.cuts(job::Region::kLevelPocket) || operation.cuts(job::Region::kOutline) ||
           operation.cuts(job::Region::kValleys) || operation.cuts(job::Region::kEdges) ||
           (operation.cuts(job::Region::kHoles) && !operation.prismatic->loops.empty());
}

// z: the bottom, of several holes that of the shallowest.
double bottom_of(const Operation& operation)
{
    const Prismatic& cut = *operation.prismatic;
    double bottom = cut.top - cut.depth;
    for (const job::Hole& hole : cut.holes) {
        bottom = std::max(bottom, tip_in_hole(cut, hole, operation.tool));
    }
    return bottom;
}

// z at which the operation's walls are judged.
double judged_height(const Operation& operation, double floor_tolerance)
{
    const Prismatic& cut = *operation.prismatic;
    if (operation.cuts(job::Region::kValleys)) {
        return cut.top;
    }
    if (operation.cuts(job::Region::kEdges)) {
        return cut.top - cut.width / elementary::tan(operation.tool.tip_angle / 2);
    }
    return std::min(cut.top, bottom_of(operation) + floor_tolerance + end_height(operation.tool));
}

// Moves whose tool comes below a height, in squares.
class MovesBelow {
public:
    // counts(cut)  whether it is one of them
    template <class Counts>
    MovesBelow(const std::vector<EarlierCut>& cuts, double z, const Counts& counts) : z_{z}
    {
        for (const EarlierCut& cut : cuts) {
            if (std::min(cut.from.z, cut.to.z) > z || !counts(cut)) {
                continue;
            }
            widest_ = std::max(widest_, cut.tool.radius);
            const Vec3d way = cut.to - cut.from;
            const int pieces = std::max(1, static_cast<int>(std::ceil(norm(way) / kSquare)));
            for (int k = 0; k < pieces; ++k) {
                add({&cut, cut.from + (static_cast<double>(k) / pieces) * way,
                     cut.from + (static_cast<double>(k + 1) / pieces) * way});
            }
        }
    }

    struct Nearest {
        double thickness;  // mm between a place and what is cut at the height
        const EarlierCut* cut;
    };

    // The move that comes nearest to a place, or the first found that leaves no more than `enough`.
    //
    // radius  whether the tools' radius counts, or their axis alone
    Nearest nearest(Vec2d place, bool radius, double enough) const
    {
        Nearest least{kThickest, nullptr};
        const double reach = (radius ? widest_ : 0.0) + kThickest;
        for (auto i = column(place.x - reach); i <= column(place.x + reach); ++i) {
            for (auto j = column(place.y - reach); j <= column(place.y + reach); ++j) {
                const auto found = squares_.find(square_key(i, j));
                if (found == squares_.end()) {
                    continue;
                }
                for (const Piece& piece : found->second) {
                    const double thickness = left_by(piece, place, radius, least.thickness);
                    if (thickness < least.thickness) {
                        least = {thickness, piece.cut};
                    }
                    if (least.thickness <= enough) {
                        return least;
                    }
                }
            }
        }
        return least;
    }

private:
    struct Piece {
        const EarlierCut* cut;
        Vec3d from;
        Vec3d to;
    };

    void add(const Piece& piece)
    {
        for (auto i = column(std::min(piece.from.x, piece.to.x));
             i <= column(std::max(piece.from.x, piece.to.x)); ++i) {
            for (auto j = column(std::min(piece.from.y, piece.to.y));
                 j <= column(std::max(piece.from.y, piece.to.y)); ++j) {
                squares_[square_key(i, j)].push_back(piece);
            }
        }
    }

    // mm; a value over `known` may be too great.
    double left_by(const Piece& piece, Vec2d place, bool radius, double known) const
    {
        const Vec3d way = piece.to - piece.from;
        const Vec2d flat_way = in_plan(way);
        const double squared = dot(flat_way, flat_way);
        const auto left_at = [&](double share) {
            const Vec3d tip = piece.from + share * way;
            const double away = norm(place - in_plan(tip));
            if (tip.z > z_) {
                return kUnbounded;
            }
            return radius ? away - radius_at_height(piece.cut->tool, z_ - tip.z) : away;
        };
        const double foot =
            squared > 0 ? std::clamp(dot(place - in_plan(piece.from), flat_way) / squared, 0.0, 1.0)
                        : 0.0;
        const double away = norm(place - in_plan(piece.from + foot * way));
        if (away - (radius ? piece.cut->tool.radius : 0.0) >= known) {
            return kUnbounded;
        }
        const double least = std::min({left_at(0), left_at(foot), left_at(1)});
        if (!radius || std::abs(way.z) < kNothing || end_height(piece.cut->tool) < kNothing) {
            return least;
        }
        return std::min(least, lowest_between(left_at));
    }

    // The least value of a convex function over [0, 1], to 1e-5 of it; it is unbounded where the tip is too
    // high.
    template <class Function>
    static double lowest_between(const Function& of)
    {
        constexpr int kRounds = 24;
        double low = 0;
        double high = 1;
        for (int k = 0; k < kRounds; ++k) {
            const double a = low + (high - low) / 3;
            const double b = high - (high - low) / 3;
            const double at_a = of(a);
            const double at_b = of(b);
            if (at_a < at_b || (at_a >= kUnbounded && of(0) < kUnbounded)) {
                high = b;
            } else {
                low = a;
            }
        }
        return of((low + high) / 2);
    }

    static std::int32_t column(double x)
    {
        return static_cast<std::int32_t>(std::floor(x / kSquare));
    }

    double z_;
    double widest_{};
    std::unordered_map<std::uint64_t, std::vector<Piece>> squares_;
};

std::vector<std::vector<Vec2d>> lines_of(const Operation& operation)
{
    std::vector<std::vector<Vec2d>> lines;
    if (operation.outline.boundary) {
        lines.push_back(loop_polyline(*operation.outline.boundary, kWallChord));
        for (const job::Loop& island : operation.outline.islands) {
            lines.push_back(loop_polyline(island, kWallChord));
        }
        return lines;
    }
    for (const NestedLoop& loop : operation.prismatic->loops) {
        lines.push_back(loop_polyline(loop.loop, kWallChord));
    }
    for (const Chain& chain : operation.prismatic->chains) {
        lines.push_back(open_polyline(chain, kWallChord));
    }
    return lines;
}

// Calls look(place, left) for places along lines; `left` is square to the line, of length 1.
template <class Look>
void for_each_place(const std::vector<std::vector<Vec2d>>& lines, const Look& look)
{
    for (const std::vector<Vec2d>& line : lines) {
        for (std::size_t k = 0; k + 1 < line.size(); ++k) {
            const Vec2d way = line[k + 1] - line[k];
            const double length = norm(way);
            if (length < kNothing) {
                continue;
            }
            const Vec2d left{-way.y / length, way.x / length};
            look(line[k], left);
            const int steps = static_cast<int>(std::ceil(length / kStep));
            for (int n = 0; n < steps; ++n) {
                look(line[k] + ((n + 0.5) / steps) * way, left);
            }
        }
    }
}

class WallJudge {
public:
    WallJudge(const CutRegion& region, const WallQuestion& question)
        : region_{region},
          operation_{region.operation()},
          q_{question},
          lines_{lines_of(operation_)},
          on_curves_{follows_curves(operation_)}
    {
    }

    // z  at which the walls are judged
    void find_stock(double z, bool over_tabs)
    {
        const int number = on_curves_ ? operation_.tool.number : 0;
        const bool on_surfaces = on_curves_ && !operation_.part.floor.empty();
        const double deep_enough = highest_tip(z);
        const MovesBelow moves{q_.cuts, on_surfaces ? kUnbounded : z, [&](const EarlierCut& cut) {
                                   return (number == 0 || cut.tool.number == number) &&
                                          std::min(cut.from.z, cut.to.z) <= deep_enough;
                               }};
        const double stands = on_surfaces ? -kUnbounded / 2 : z - kSpare;
        for_each_place(lines_, [&](Vec2d place, Vec2d left) {
            if (on_curves_) {
                look_for_stock(moves, {place.x, place.y, z}, {0, 0}, stands, over_tabs);
                return;
            }
            look_for_stock(moves, {place.x, place.y, z}, left, stands, over_tabs);
            look_for_stock(moves, {place.x, place.y, z}, -1.0 * left, stands, over_tabs);
        });
    }

    void find_gouges()
    {
        for (const double z : heights_of_walls()) {
            const MovesBelow moves{q_.cuts, z, [](const EarlierCut& cut) {
                                       return cut.line > 0;
                                   }};
            for_each_place(lines_,
                           [&](Vec2d place, Vec2d left) { look_for_gouge(moves, place, left, z); });
        }
    }

    const WallFaults& faults() const { return faults_; }

private:
    // out  from the wall, of length 1; 0 on a curve
    void look_for_stock(const MovesBelow& moves, Vec3d at, Vec2d out, double stands, bool over_tabs)
    {
        constexpr double kChords = 1e-3;  // mm
        const Tool& tool = operation_.tool;
        const double needed = room_needed();
        const Vec2d spare = in_plan(at) + needed * out;
        if (!on_curves_ && region_.room(spare.x, spare.y) < needed - kChords) {
            return;
        }
        const Vec2d place = in_plan(at) - into_material() * out;
        const double known = faults_.stock ? faults_.stock->thickness : q_.allowed;
        const auto found = moves.nearest(place, !on_curves_, known);
        const double thickness = std::min(found.cut == nullptr ? kUnbounded : found.thickness,
                                          most_that_stays(found.cut == nullptr));
        if (thickness <= known || !q_.stock.is_over(place, stands) ||
            (!over_tabs && operation_.prismatic->tabs &&
             q_.is_open(place + tool.radius * out, 2 * tool.radius))) {
            return;
        }
        faults_.stock = {thickness, {{place.x, place.y, at.z}, 0, tool.number}};
        if (found.cut != nullptr) {
            faults_.stock->at.line = found.cut->line;
            faults_.stock->at.tool = found.cut->tool.number;
        }
    }

    // z of the highest tip that counts: what passes at the height of an edge breaks it as little as a facing move.
    double highest_tip(double z) const
    {
        return operation_.cuts(job::Region::kEdges) ? (z + judged_height(operation_, 0)) / 2
                                                    : kUnbounded;
    }

    // mm: an edge keeps its chamfer at most. Stock beside other walls, where no move comes near, stands on a floor,
    // which is judged by its points.
    double most_that_stays(bool uncut) const
    {
        return operation_.cuts(job::Region::kEdges) ? operation_.prismatic->width
               : uncut                              ? 0.0
                                                    : kThickest;
    }

    // mm square to the wall, for the tool's axis where it cuts the wall's places.
    double room_needed() const
    {
        const Tool& tool = operation_.tool;
        return std::max(kSpare, operation_.tolerance.plan) +
               (operation_.cuts(job::Region::kValleys) ? tool.tip_radius
                : operation_.cuts(job::Region::kEdges) ? tool.tip_radius + job::kChamferTip
                                                       : tool.radius);
    }

    // mm from the loop to the places that are judged: of a chamfer the upper edge, which no other operation cuts.
    double into_material() const
    {
        return operation_.cuts(job::Region::kEdges) ? operation_.prismatic->width : 0.0;
    }

    // z, from the top: where the walls begin below other regions.
    std::vector<double> heights_of_walls() const
    {
        const Prismatic& cut = *operation_.prismatic;
        const double begin =
            operation_.cuts(job::Region::kEdges) ? judged_height(operation_, 0) : cut.top;
        std::vector<double> heights{begin};
        for (const CutRegion& other : q_.regions) {
            const Operation& of = other.operation();
            if (of.prismatic) {
                const double floor = of.cuts(job::Region::kEdges)
                                         ? judged_height(of, 0)
                                         : of.prismatic->top - of.prismatic->depth;
                heights.push_back(floor - 2 * q_.floor_tolerance);
            }
        }
        const double lowest = cut.top - cut.depth;
        heights.erase(std::remove_if(heights.begin() + 1, heights.end(),
                                     [&](double z) { return z <= lowest || z >= begin; }),
                      heights.end());
        std::sort(heights.begin(), heights.end());
        heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
        return heights;
    }

    // left  square to the wall, of length 1
    void look_for_gouge(const MovesBelow& moves, Vec2d place, Vec2d left, double z)
    {
        const auto found = moves.nearest(place, true, -kUnbounded);
        const double reach = -found.thickness;
        const double known = faults_.gouge ? faults_.gouge->depth : q_.plan_tolerance;
        if (reach <= known || !q_.stock.is_over(place, z - kSpare)) {
            return;
        }
        const bool is_out = region_.around(place + kSpare * left).inside < 0;
        if (operation_.cuts(job::Region::kHoles) && !is_out &&
            region_.around(place - kSpare * left).inside >= 0) {
            return;  // in another hole of the operation
        }
        const Vec2d way = (is_out ? reach : -reach) * left;
        const std::vector<const CutRegion*> open = open_at(place, z);
        double depth = 0;
        for (int k = 1; k <= kGougeLooks; ++k) {
            const Vec2d beyond = place + (static_cast<double>(k) / kGougeLooks) * way;
            if (q_.stock.may_be_over(beyond, z - kSpare)) {
                depth = std::max(depth, beyond_walls(open, beyond, reach));
            }
        }
        if (depth > known) {
            faults_.gouge = {depth,
                             {{place.x, place.y, z}, found.cut->line, found.cut->tool.number}};
        }
    }

    // The other regions that may be cut at the height, at a place on the walls of this one.
    std::vector<const CutRegion*> open_at(Vec2d place, double z) const
    {
        std::vector<const CutRegion*> open;
        for (const CutRegion& other : q_.regions) {
            const RegionAt here = other.around(place);
            if (&other != &region_ && here.floor - here.below <= z + q_.floor_tolerance) {
                open.push_back(&other);
            }
        }
        return open;
    }

    // mm from the nearest of the regions; 0 in one; `most` without any.
    static double beyond_walls(const std::vector<const CutRegion*>& regions,
                               Vec2d place,
                               double most)
    {
        double least = most;
        for (const CutRegion* region : regions) {
            least = std::min(least, std::max(0.0, -region->around(place).inside));
        }
        return least;
    }

    const CutRegion& region_;
    const Operation& operation_;
    const WallQuestion& q_;
    std::vector<std::vector<Vec2d>> lines_;
    bool on_curves_;
    WallFaults faults_;
};

}  // namespace

WallFaults faults_at_walls(const CutRegion& region, const WallQuestion& question)
{
    const Operation& operation = region.operation();
    if (!follows_curves(operation) && !has_walls(operation)) {
        return {};
    }
    WallJudge judge{region, question};
    const Prismatic& cut = *operation.prismatic;
    judge.find_stock(operation.cuts(job::Region::kEdges)
                         ? cut.top
                         : judged_height(operation, question.floor_tolerance),
                     false);
    if (cut.tabs) {
        const double over = cut.top - cut.depth + cut.tabs->height + question.floor_tolerance +
                            end_height(operation.tool);
        if (over <= cut.top) {  // else a round end goes over a tab with less than its radius
            judge.find_stock(over, true);
        }
    }
    if (!follows_curves(operation)) {
        judge.find_gouges();
    }
    return judge.faults();
}

}  // namespace cusp::verify
