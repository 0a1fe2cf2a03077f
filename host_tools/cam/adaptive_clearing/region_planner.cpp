// Steering for each of a few turning radii, and between them contours of the opened region.
#include "host_tools/cam/adaptive_clearing/region_planner.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/adaptive_clearing/deepest_place.hpp"
#include "host_tools/cam/adaptive_clearing/entry_spiral.hpp"
#include "host_tools/cam/adaptive_clearing/neck_ways.hpp"
#include "host_tools/cam/adaptive_clearing/open_places.hpp"
#include "host_tools/cam/adaptive_clearing/pass_starts.hpp"
#include "host_tools/cam/adaptive_clearing/sliver_moves.hpp"
#include "host_tools/cam/adaptive_clearing/steered_pass.hpp"
#include "host_tools/cam/adaptive_clearing/stock_spots.hpp"
#include "host_tools/cam/adaptive_clearing/swept_area.hpp"
#include "host_tools/cam/adaptive_clearing/trochoids.hpp"
#include "host_tools/cam/adaptive_clearing/wall_budget.hpp"
#include "host_tools/cam/adaptive_clearing/wall_passes.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::adaptive_clearing {

using offset::area;
using offset::Box2d;
using offset::box_of;
using offset::connected_parts;
using offset::Contour;
using offset::Edge;
using offset::edges_of;
using offset::EdgeTree;
using offset::grown;
using offset::length;
using offset::pieces_of;
using offset::point_on;
using offset::Region2d;
using offset::RegionOffset;
using offset::RegionPart;

namespace {

// In radii of the tool.
constexpr double kSteered[] = {0.3, 0.1, 0.03};  // turning radii
constexpr double kStrip = 0.04;                  // left along the walls by the first of them
constexpr double kWide = 1.0;                    // turning radius of the first passes into corners
constexpr double kLeastStrip = 0.002;            // more than a step around an island bulges
constexpr double kRatio = 0.2;                   // from one opening to the next
constexpr double kFine = 0.05;                   // with smaller radii what is over is short
constexpr double kSharp = 0.6 * kPi;             // radians: the turn in a corner of 72 degrees
constexpr double kHelix = 0.3;
constexpr double kLeastNeck = 0.02;  // room of the tool's centre in a neck
constexpr double kMostNeck = 0.52;   // wider ones are steered through
constexpr double kMostMouth = 0.8;
constexpr double kLeastHelix = 0.02;
constexpr double kRound = 0.6;  // of a part's area in its greatest circle
constexpr double kLeastRound = 2.0;
constexpr double kPoleStep = 0.5;
constexpr double kPiece = 0.1;
constexpr double kPart = 0.0125;  // of pieces over the limit
constexpr double kTargetMargin = 0.2;
constexpr double kSteerShare = 0.995;  // of the engagement
constexpr double kMoreLength = 1.3;    // times the area over the width of a straight cut
constexpr double kMostProgress = 0.99;

class Planner {
public:
    Planner(const Region2d& region, const AdaptiveSettings& settings, bool spirals)
        : settings_{settings},
          spirals_{spirals},
          radius_{settings.tool_radius},
          sliver_{least_sliver(settings)},
          walls_{region},
          box_{grown_box(box_of(region), settings.tool_radius)},
          swept_{box_, settings.tool_radius},
          links_{swept_, walls_, settings.wall_clearance},
          expected_{kMoreLength * area(region) /
                    (settings.tool_radius * (1.0 - elementary::cos(settings.max_engagement)))},
          open_{sweep_open(swept_, settings.open)},
          places_{open_}
    {
    }

    PlannedRegion plan()
    {
        const double finest = finest_turn();
        double opened = 0.0;
        for (const double share : kSteered) {
            const double turn = share * radius_;
            if (opened > 0.0 && turn < finest) {
                break;
            }
            if (opened > 0.0) {
                narrow(opened, turn, sliver_, box_);
            }
            steer(turn,
                  opened > 0.0 ? std::max(kStrip * turn, kLeastStrip * radius_) : kStrip * radius_);
            cut_walls(turn, turn, box_, 0);
            if (opened <= 0.0) {
                narrow(kWide * radius_, turn, sliver_, box_);
                open_necks();
            }
            opened = turn;
        }
        narrow(opened, finest, sliver_, box_);
        cut_rest();
        cut_slivers();
        return {std::move(result_), is_round_};
    }

private:
    // The part of the region that a turn of this radius reaches.
    const Region2d& opened(double radius)
    {
        const auto known = opened_.find(radius);
        if (known != opened_.end()) {
            return known->second;
        }
        const Region2d inner = walls_.at(settings_.wall_clearance + radius);
        return opened_.emplace(radius, inner.contours.empty() ? inner : grown(inner, radius))
            .first->second;
    }

    void steer(double turn, double strip)
    {
        const Region2d centres = walls_.at(settings_.wall_clearance + strip + turn);
        if (centres.contours.empty()) {
            return;
        }
        const SteeringSpace space{swept_,
                                  walls_,
                                  settings_.wall_clearance + strip,
                                  turn,
                                  kSteerShare * settings_.max_engagement,
                                  settings_.tolerance};
        PassStarts starts{box_, grown(centres, turn + (1.0 - kTargetMargin) * radius_), radius_};
        for (const Vec2d place : places_) {
            starts.add(place);
        }
        for (const RegionPart& part : connected_parts(centres)) {
            enter(centres, part, turn + strip, starts);
            for (;;) {
                const std::optional<Pose> pose = starts.next(at_, space);
                if (!pose) {
                    break;
                }
                link_to(pose->at);
                const SteeredPass pass = steered_pass(space, *pose);
                if (pass.path.empty()) {
                    starts.drop(pose->at);
                    continue;
                }
                result_.engagement_bound =
                    std::max(result_.engagement_bound, pass.engagement_bound);
                starts.add(pass.path);
                add_run(pass.path);
            }
        }
    }

    // Enters the part by a helix, unless a hole is swept there already, or it is open.
    //
    // inset  mm: of the part from where the tool may be
    void enter(const Region2d& centres, const RegionPart& part, double inset, PassStarts& starts)
    {
        Vec2d pole = deepest_place(centres, part, walls_);
        if (swept_.contains(pole) || std::any_of(open_.begin(), open_.end(), [&](Vec2d place) {
                return is_inside(centres, part, place);
            })) {
            return;
        }
        double room = walls_.nearest(pole, kUnbounded) - settings_.wall_clearance;
        const double in_part = room - inset;
        const bool is_round =
            in_part > kLeastRound * radius_ &&
            kPi * in_part * in_part > kRound * std::abs(area(centres.contours[part.outer]));
        is_round_ = is_round_ || is_round;
        const bool spiral = is_round && spirals_;
        if (spiral) {
            pole = deepest_near(pole, kPoleStep * radius_, walls_);
            room = walls_.nearest(pole, kUnbounded) - settings_.wall_clearance;
        }
        double r = std::min(kHelix * radius_, room);
        r = r < kLeastHelix * radius_ ? 0.0 : r;
        const double reached = add_helix(pole, r, spiral ? room - kStrip * radius_ : r);
        if (reached > r) {
            starts.add(result_.runs.back().path);
            return;
        }
        for (int i = 0; i < 16; ++i) {
            const double angle = 2 * kPi * i / 16;
            const Vec2d way{elementary::cos(angle), elementary::sin(angle)};
            places_.push_back(pole + way * reached);
            starts.add(places_.back());
        }
    }

    // The helix has the radius r (mm). Returns how far from its centre the tool is free to go, at
    // most `widest` (mm).
    double add_helix(Vec2d centre, double r, double widest)
    {
        link_.clear();
        double reached = 0.0;
        at_ = centre;
        if (r <= 0.0) {
            swept_.add_disc(centre, radius_);
            result_.runs.emplace_back();
        } else {
            const EntrySpiral spiral = entry_spiral(
                swept_, centre, widest, {settings_.max_engagement, settings_.tolerance});
            result_.engagement_bound = std::max(result_.engagement_bound, spiral.engagement_bound);
            add_run(spiral.path);
            reached = spiral.radius;
        }
        result_.runs.back().helix = EntryHelix{centre, r};
        return reached;
    }

    // Trochoids into the stock of each neck.
    void open_necks()
    {
        const TrochoidSpace space{swept_, walls_, settings_.wall_clearance,
                                  settings_.max_engagement, settings_.tolerance};
        for (const NeckWay& way :
             neck_ways(walls_, {settings_.wall_clearance, kLeastNeck * radius_, kMostNeck * radius_,
                                kMostMouth * radius_, kPiece * radius_})) {
            for (auto stock = stock_along(way, 0, space); stock;) {
                open_neck(way, *stock, space);
                const auto left = stock_along(way, stock->first, space);
                const bool same = left && left->first == stock->first && left->last == stock->last;
                stock = same ? stock_along(way, stock->last + 1, space) : left;
            }
        }
    }

    // From the nearer end that is in swept ground; where none is, from a helix in between.
    void open_neck(const NeckWay& way, NeckStock stock, const TrochoidSpace& space)
    {
        const std::size_t first = stock.first > 0 ? stock.first - 1 : 0;
        const std::size_t last = std::min(stock.last + 1, way.size() - 1);
        const bool forward = norm(way[first].centre - at_) <= norm(way[last].centre - at_);
        if (cut_neck(way, forward ? first : last, forward ? last : first, kUnbounded, space) ||
            cut_neck(way, forward ? last : first, forward ? first : last, kUnbounded, space)) {
            return;
        }
        const auto widest = static_cast<std::size_t>(
            std::max_element(
                way.begin() + static_cast<std::ptrdiff_t>(stock.first),
                way.begin() + static_cast<std::ptrdiff_t>(stock.last) + 1,
                [](const NeckPlace& a, const NeckPlace& b) { return a.room < b.room; }) -
            way.begin());
        const double r = std::min(kHelix * radius_, way[widest].room);
        const double room = add_helix(way[widest].centre, r, r);
        cut_neck(way, widest, last, room, space);
        cut_neck(way, widest, first, room, space);
    }

    // True if the tool gets anywhere.
    bool cut_neck(const NeckWay& way,
                  std::size_t from,
                  std::size_t to,
                  double most_room,
                  const TrochoidSpace& space)
    {
        link_to(trochoid_start(way[from].centre, most_room, space));
        const TrochoidPass pass = trochoidal_pass(way, from, to, most_room, space);
        if (pass.path.empty()) {
            return false;
        }
        result_.engagement_bound = std::max(result_.engagement_bound, pass.engagement_bound);
        add_run(pass.path);
        result_.runs.back().tolerance = pass.tolerance;
        return true;
    }

    // Finds the places in the box where the region opened by the radius `to` still has stock thicker
    // than `sliver` (mm). Cuts each by passes along its walls, with turning radii that fall from
    // `from` to `to`.
    void narrow(double from, double to, double sliver, const Box2d& box)
    {
        if (from <= to) {
            return;
        }
        const double next = std::max(kRatio * from, to);
        for (auto spots = spots_along({&opened(to)}, wall_space(sliver, 2 * kPi, box));
             !spots.empty();) {
            const Box2d spot = take_nearest(spots, at_);
            cut_walls(from, next, spot, 0);
            narrow(next, to, sliver, spot);
        }
    }

    // Passes along the walls of the region opened by the radius `to`, inside the box. `from` is the
    // radius of the passes before; where the engagement is too large, radii in between come first.
    void cut_walls(double from, double to, const Box2d& spot, int depth)
    {
        bool left = false;
        for (const Contour& contour : opened(to).contours) {
            const WallPasses passes =
                uncut_stretches(contour, wall_space(sliver_, settings_.max_engagement, spot));
            left = left || passes.left;
            for (const std::vector<Edge>& path : passes.paths) {
                if (is_bounded(path)) {
                    cut(path);
                } else {
                    left = true;
                }
            }
        }
        const int most_halvings =
            (from > kFine * radius_ ? 3 : 1) + (turns_by(opened(to), spot) > kSharp ? 1 : 0);
        if (!left || depth >= most_halvings || from <= 1.05 * to) {
            return;
        }
        for (auto spots = spots_along({&opened(to)}, wall_space(sliver_, 2 * kPi, spot));
             !spots.empty();) {
            const Box2d corner = take_nearest(spots, at_);
            cut_walls(from, std::sqrt(from * to), corner, depth + 1);
            cut_walls(std::sqrt(from * to), to, corner, depth + 1);
        }
    }

    // Cuts the stock that no turning radius reaches: slots hardly wider than the tool, and corners
    // that no pass of bounded engagement opens. Stock thinner than the rounding of corners is left.
    void cut_rest()
    {
        const Region2d& finest = opened(finest_turn());
        const Region2d whole = walls_.at(settings_.wall_clearance);
        for (auto spots = spots_along({&finest, &whole}, wall_space(sliver_, 2 * kPi, box_));
             !spots.empty();) {
            const Box2d spot = take_nearest(spots, at_);
            for (const Region2d* region : {&finest, &whole}) {
                const double sliver = region == &finest ? sliver_ : 2.0 * settings_.corner;
                for (const Contour& contour : region->contours) {
                    for (const std::vector<Edge>& path :
                         uncut_stretches(contour, wall_space(sliver, 2 * kPi, spot)).paths) {
                        const Vec2d start = path.front().start;
                        if (swept_.engagement(start, {1.0, 0.0}, -0.01 * radius_, kPi) >= 0.1) {
                            add_helix(start, 0.0, 0.0);
                        }
                        cut(path);
                    }
                }
            }
        }
    }

    // Cuts slivers left between passes. A move to a point of one may leave pieces with other points;
    // it takes all within 0.01 radii of its point, so that there is an end.
    void cut_slivers()
    {
        const Region2d whole = walls_.at(settings_.wall_clearance);
        if (whole.contours.empty()) {
            return;
        }
        const EdgeTree centres{edges_of(whole)};
        const SliverSpace space{places_, walls_, centres, settings_.wall_clearance, radius_};
        const Region2d reached = grown(whole, 0.98 * radius_);  // as far as such moves
        std::size_t runs{};
        do {
            runs = result_.runs.size();
            result_.left.clear();
            for (const Vec2d p : swept_.uncut_points(reached, settings_.tolerance)) {
                if (swept_.contains(p)) {
                    continue;
                }
                if (const auto way = move_to_sliver(p, space)) {
                    cut({*way});
                } else {
                    result_.left.push_back(p);
                }
            }
        } while (result_.runs.size() > runs);
    }

    double finest_turn() const
    {
        return std::max(settings_.corner / (std::sqrt(2.0) - 1.0), 1e-3 * radius_);
    }

    WallSpace wall_space(double sliver, double most, const Box2d& spot) const
    {
        return {swept_, walls_, settings_.wall_clearance, sliver, most, settings_.tolerance, spot};
    }

    bool is_bounded(const std::vector<Edge>& path) const
    {
        return std::all_of(path.begin(), path.end(), [&](const Edge& edge) {
            return swept_.keeps(edge, settings_.max_engagement, settings_.tolerance);
        });
    }

    // To be called before the path is swept: the link passes through the stock of that time.
    void link_to(Vec2d start)
    {
        link_.clear();
        if (!result_.runs.empty()) {
            link_ = links_.between(at_, start);
        }
    }

    // Measures and sweeps the path piece by piece.
    void cut(std::vector<Edge> path)
    {
        link_to(path.front().start);
        if (link_.empty() && !result_.runs.empty()) {
            if (const auto in = links_.approach(path.front().start)) {
                path.insert(path.begin(), *in);
            }
        }
        OverEngagement over{};
        for (const Edge& edge : path) {
            for (const Edge& piece : pieces_of(edge, kPiece * radius_)) {
                if (swept_.keeps(piece, settings_.max_engagement, settings_.tolerance)) {
                    sweep(piece, over);
                    continue;
                }
                // The end of a corner is shorter than a piece.
                for (const Edge& part : pieces_of(piece, kPart * radius_)) {
                    sweep(part, over);
                }
            }
        }
        if (over.length > 0.0) {
            over.slot_width = slot_width(walls_, over.at,
                                         2.0 * (settings_.wall_clearance + kLeastNeck * radius_));
            result_.over.push_back(over);
        }
        add_run(path);
    }

    // Counts what of the piece is over the limit.
    void sweep(const Edge& piece, OverEngagement& over)
    {
        const double most =
            swept_.engagement_bound(piece, settings_.max_engagement, settings_.tolerance);
        swept_.add(piece, settings_.tolerance);
        if (most <= settings_.max_engagement) {
            result_.engagement_bound = std::max(result_.engagement_bound, most);
            return;
        }
        over.length += length(piece);
        if (most > over.engagement) {
            over.engagement = most;
            over.at = piece.end;
        }
    }

    void add_run(const std::vector<Edge>& path)
    {
        AdaptiveRun run;
        run.path = path;
        run.link = std::exchange(link_, {});
        for (const Edge& edge : path) {
            const int n =
                std::max(1, static_cast<int>(std::ceil(length(edge) / (2.0 * kPiece * radius_))));
            for (int i = 1; i <= n; ++i) {
                places_.push_back(point_on(edge, static_cast<double>(i) / n));
            }
            result_.length += length(edge);
        }
        at_ = path.back().end;
        result_.runs.push_back(std::move(run));
        if (settings_.progress) {
            settings_.progress(std::min(result_.length / expected_, kMostProgress));
        }
    }

    const AdaptiveSettings& settings_;
    bool spirals_;
    bool is_round_{false};
    double radius_;
    double sliver_;  // mm: thinner stock beside a wall is left
    RegionOffset walls_;
    Box2d box_;
    SweptArea swept_;
    KeepDownLinks links_;
    std::vector<LinkLeg> link_;  // to the next run
    double expected_;            // mm: length of all passes
    AdaptivePath result_;
    std::map<double, Region2d> opened_;  // by radius
    std::vector<Vec2d> open_;            // on the borders of the open places
    std::vector<Vec2d> places_;          // where the tool has been
    Vec2d at_{};
};

}  // namespace

PlannedRegion plan_region(const Region2d& region, const AdaptiveSettings& settings, bool spirals)
{
    return Planner{region, settings, spirals}.plan();
}

}  // namespace cusp::adaptive_clearing
