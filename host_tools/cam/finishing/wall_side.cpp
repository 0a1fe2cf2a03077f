// Columns of a facet, divided until one move removes what is reached between two.
#include "host_tools/cam/finishing/wall_side.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::finishing {

using toolpath::Tool;
using toolpath::ToolShape;

namespace {

constexpr double kLongestApart = 2;          // in stepovers: columns
constexpr double kProvedApart = 0.125;       // the same: reach is bounded between, down to this
constexpr int kTriedEach = 2;                // halvings of a stretch before that is tried again
constexpr double kLeastBall = 0.5;           // radii: to bound reach
constexpr double kReachApart = 1.0 / 16;     // the same: those of which reach is looked at
constexpr double kLeastApart = 1.0 / 64;     // the same
constexpr double kBorderApart = 1.0 / 1024;  // the same, where reach begins or ends
constexpr int kFirstParts = 8;               // at least; the ends of a triangle have no height
constexpr double kClearOfWall = 0.9;         // radii
constexpr double kOverhang = 2e-4;           // mm
constexpr double kBeside = 1e-4;             // mm: vertices of files are rounded
constexpr double kLeastHeight = 1e-4;        // mm, of what is reached
constexpr double kReachSlack = 1e-6;         // mm
constexpr int kReachHalvings = 20;
constexpr int kLevels = 16;             // of a leaning column
constexpr double kShortestPass = 1e-3;  // mm
constexpr double kPassPitch = 0.1;      // radii
constexpr int kPassHalvings = 7;        // of it: dropped tips may jump

}  // namespace

WallSide::WallSide(const WallFacet& facet, bool turned, const GougeFreePathFitter& fitter)
    : corners_{facet.corners},
      out_{turned ? -facet.normal : facet.normal},
      // Behind the facet `along_` is turned as well.
      bend_{turned ? -facet.bend : facet.bend},
      middle_{turned ? -facet.middle : facet.middle},
      off_{facet.off},
      beside_{kBeside + facet.off + fitter.model().edge_error()},
      fitter_{fitter}
{
    const double level = elementary::hypot(out_.x, out_.y);
    along_ = Vec3d{-out_.y, out_.x, 0} / level;
    upward_ = Vec3d{-out_.x * out_.z, -out_.y * out_.z, level * level} / (level * level);
    begin_ = kInfinite;
    end_ = -kInfinite;
    double low = kInfinite;
    double high = -kInfinite;
    for (const Vec3d& corner : corners_) {
        const double along = dot(corner, along_);
        begin_ = std::min(begin_, along);
        end_ = std::max(end_, along);
        low = std::min(low, corner.z);
        high = std::max(high, corner.z);
    }
    leans_ = out_.z * (high - low) > kBeside;
    if (-out_.z * (high - low) > kBeside) {
        overhang_ = std::min(-out_.z * (high - low), kOverhang);
        off_ += overhang_;
        beside_ += overhang_;
    }
}

Vec3d WallSide::point_at(double along, double z) const
{
    const Vec3d from = corners_.front();
    return from + along_ * (along - dot(from, along_)) + upward_ * (z - from.z);
}

Vec3d WallSide::out_at(double along) const
{
    if (bend_ == 0) {
        return out_;
    }
    const Vec3d out = out_ + along_ * (bend_ * (along - middle_));
    return out / norm(out);
}

// Centre of a ball that touches the wall there, or lies a little off it.
Vec3d WallSide::centre_beside(double along, double z) const
{
    return point_at(along, z) + out_at(along) * (fitter_.offset_tool().radius + beside_);
}

// z of the centre of a ball dropped there; none where nothing lies below it.
std::optional<double> WallSide::drop_centre(Vec3d over, double radius) const
{
    if (fitter_.model().is_mesh()) {
        const auto rest = fitter_.model().drop_ball(over.x, over.y, radius);
        return rest ? std::optional{rest->centre.z} : std::nullopt;
    }
    const Tool ball{1, ToolShape::kBall, radius, radius};
    const auto tip = fitter_.model().drop_height(ball, over.x, over.y);
    return tip ? std::optional{*tip + radius} : std::nullopt;
}

Vec3d WallSide::centre_at_top(double along) const
{
    return centre_beside(along, whole_column_at(along).top);
}

bool WallSide::rests(Vec3d centre) const
{
    return drop_centre(centre, kClearOfWall * fitter_.offset_tool().radius).has_value();
}

std::optional<double> WallSide::rest_beside(double along, double z) const
{
    return drop_centre(centre_beside(along, z), fitter_.offset_tool().radius);
}

bool WallSide::is_reached(double along, double z) const
{
    const std::optional<double> rest = rest_beside(along, z);
    return rest && *rest <= centre_beside(along, z).z + kReachSlack;
}

// The column from the facet's lower side to its upper one, reached or not.
WallSide::Column WallSide::whole_column_at(double place) const
{
    // Rounding may put it beyond the end, where there is no side.
    const double along = std::clamp(place, begin_, end_);
    Column out{along, kInfinite, -kInfinite, true, true};
    const auto include = [&](double z) {
        out.low = std::min(out.low, z);
        out.top = std::max(out.top, z);
    };
    for (std::size_t k = 0; k < corners_.size(); ++k) {
        const Vec3d a = corners_[k];
        const Vec3d b = corners_[(k + 1) % corners_.size()];
        const double from = dot(a, along_);
        const double to = dot(b, along_);
        if (along < std::min(from, to) || along > std::max(from, to)) {
            continue;
        }
        if (from == to) {
            include(a.z);
            include(b.z);
        } else {
            include(a.z + (b.z - a.z) * (along - from) / (to - from));
        }
    }
    if (overhang_ > 0) {
        out.low = std::max(out.low, out.top + overhang_ / out_.z);
    }
    return out;
}

WallSide::Column WallSide::column_at(double place) const
{
    const Column whole = whole_column_at(place);
    const double along = whole.along;
    const std::optional<double> rest = rest_beside(along, whole.top);
    const Column none{along, whole.top, whole.top, false, rest.has_value()};
    double reached = whole.top;
    if (!leans_) {
        reached = rest ? std::max(*rest, whole.low) : whole.top;
    } else if (is_reached(along, whole.low)) {
        reached = whole.low;
    } else if (is_reached(along, whole.top)) {
        double blocked = whole.low;
        for (int k = 0; k < kReachHalvings; ++k) {
            const double middle = 0.5 * (blocked + reached);
            (is_reached(along, middle) ? reached : blocked) = middle;
        }
    }
    return whole.top - reached > kLeastHeight
               ? Column{along, reached, whole.top, reached == whole.low, true}
               : none;
}

// The lowest level of a column with stock left: 0 to 1.
std::optional<double> WallSide::missing_level(const Column& column,
                                              const ScallopAtPoint& places) const
{
    if (!column.is_reached()) {
        return std::nullopt;
    }
    const int levels = leans_ ? kLevels : 0;
    for (int k = 0; k <= levels; ++k) {
        const double level = static_cast<double>(k) / kLevels;
        if (!places.is_wall_cut(point_at(column.along, column.at(level)), out_at(column.along),
                                kPlaceShare, off_)) {
            return level;
        }
    }
    return std::nullopt;
}

bool WallSide::one_move_cuts(const Column& a, const Column& b, const ScallopAtPoint& places) const
{
    std::vector<ScallopAtPoint::WallPoint> ends;
    for (const Column& column : {a, b}) {
        ends.push_back({point_at(column.along, column.low), out_at(column.along)});
        if (leans_) {
            ends.push_back({point_at(column.along, column.top), out_at(column.along)});
        }
    }
    return places.one_move_cuts_wall(ends, off_);
}

bool WallSide::KnownReach::holds(Vec3d place, double away, double top) const
{
    return std::any_of(spots_.begin(), spots_.end(), [&](const Spot& spot) {
        return spot.lowest >= top &&
               elementary::hypot(place.x - spot.place.x, place.y - spot.place.y) + away <=
                   spot.wide;
    });
}

void WallSide::KnownReach::add(Vec3d place, double wide, double lowest)
{
    spots_[next_] = {{place.x, place.y}, wide, lowest};
    next_ = (next_ + 1) % spots_.size();
}

// True if no ball near the centre reaches the wall and rests. Balls half as large and half as large
// again prove it far around.
bool WallSide::is_unreached(Vec3d centre, double away, double top, KnownReach& known) const
{
    if (known.holds(centre, away, top)) {
        return true;
    }
    const double radius = fitter_.offset_tool().radius;
    const double wide = (1 - kLeastBall) * radius;
    const std::optional<double> rest = drop_centre(centre, radius - wide);
    if (rest && *rest >= top) {
        known.add(centre, wide, *rest);
        return true;
    }
    if (!rest && !drop_centre(centre, radius + wide)) {
        known.add(centre, wide, kInfinite);
        return true;
    }
    return false;
}

// True if all that is reached between two places is proved to be cut. If the ball is clear somewhere
// between, the smaller ball inside it is clear in the middle at that height; if the larger ball in
// the middle rests on nothing, neither does any ball inside it.
//
// Over 60 lines: a list of cases, each of which may decide.
//
// far  whether to look far around, for other stretches too
bool WallSide::is_cut_between(
    double from, double to, bool far, const ScallopAtPoint& places, KnownReach& known) const
{
    const double radius = fitter_.offset_tool().radius;
    Column a = whole_column_at(from);
    Column b = whole_column_at(to);
    double low = std::min(a.low, b.low);
    double top = std::max(a.top, b.top);
    bool has_corner_between = false;
    for (const Vec3d& corner : corners_) {
        const double along = dot(corner, along_);
        if (along > from && along < to) {
            has_corner_between = true;
            low = std::min(low, corner.z);
            top = std::max(top, corner.z);
        }
    }
    if (has_corner_between) {
        a.low = b.low = low;
        a.top = b.top = top;
    }
    const auto cut = [&] {
        return one_move_cuts(a, b, places);
    };
    if (cut()) {
        return true;
    }
    const Vec3d centre = centre_beside(0.5 * (from + to), 0.5 * (low + top));
    double away = 0;
    for (const double along : {from, to}) {
        for (const double z : leans_ ? std::array{low, top} : std::array{low, low}) {
            const Vec3d off = centre_beside(along, z) - centre;
            away = std::max(away, elementary::hypot(off.x, off.y) + kReachSlack);
        }
    }
    if (radius - away < kLeastBall * radius) {
        return false;
    }
    // A ball that touches the wall at z has its centre so much higher.
    const double higher = out_.z * (radius + beside_) + kReachSlack;
    if (far ? is_unreached(centre, away, top + higher, known)
            : known.holds(centre, away, top + higher)) {
        return true;
    }
    const std::optional<double> rest = drop_centre(centre, radius - away);
    if (!rest) {
        return !drop_centre(centre, radius + away);
    }
    const double reached = *rest - higher;
    if (reached <= low) {
        return false;
    }
    if (reached >= top) {
        return true;
    }
    // If the lower side of the facet crosses that height, all above the lower end counts.
    const double lowest =
        has_corner_between || reached < std::max(a.low, b.low) ? std::max(reached, low) : reached;
    a.low = b.low = lowest;
    a.top = std::max(a.top, lowest);
    b.top = std::max(b.top, lowest);
    return cut();
}

// As look_between(), where much is proved without columns.
//
// tries  halvings since that was tried; negative: never
void WallSide::look_over(double from,
                         double to,
                         int tries,
                         const ScallopAtPoint& places,
                         KnownReach& known,
                         std::vector<Run>& out) const
{
    const double apart = (to - from) / places.step();
    const bool tried = apart <= kLongestApart && (tries < 0 || tries >= kTriedEach);
    if (tried && is_cut_between(from, to, tries < 0, places, known)) {
        return;
    }
    if (apart <= kProvedApart) {
        look_between(column_at(from), column_at(to), places, out);
        return;
    }
    const int since = tried ? 1 : tries < 0 ? tries : tries + 1;
    const double middle = 0.5 * (from + to);
    look_over(from, middle, since, places, known, out);
    look_over(middle, to, since, places, known, out);
}

// The end of what is reached between a column that is and one that is not.
double WallSide::end_of_reach(double reached, double beside) const
{
    for (int k = 0; k < kReachHalvings; ++k) {
        const double middle = 0.5 * (reached + beside);
        (column_at(middle).is_reached() ? reached : beside) = middle;
    }
    return reached;
}

void WallSide::look_between(const Column& a,
                            const Column& b,
                            const ScallopAtPoint& places,
                            std::vector<Run>& out) const
{
    const double apart = (b.along - a.along) / places.step();
    const bool near = apart <= kReachApart;
    const bool border = a.is_reached() != b.is_reached() || a.rests != b.rests;
    if (near && !border && !a.is_reached()) {
        return;
    }
    if ((near || (a.to_bottom && b.to_bottom && apart <= kLongestApart)) && a.is_reached() &&
        b.is_reached() && one_move_cuts(a, b, places)) {
        return;
    }
    if (near) {
        const std::optional<double> at_a = missing_level(a, places);
        const std::optional<double> at_b = missing_level(b, places);
        if (at_a || at_b) {
            const double level = std::min(at_a.value_or(1), at_b.value_or(1));
            const double from = a.is_reached() ? a.along : end_of_reach(b.along, a.along);
            const double to = b.is_reached() ? b.along : end_of_reach(a.along, b.along);
            if (!out.empty() && out.back().to == from) {
                out.back() = {out.back().from, to, std::min(out.back().level, level)};
            } else {
                out.push_back({from, to, level});
            }
            return;
        }
        if (apart <= (border ? kBorderApart : kLeastApart)) {
            return;
        }
    }
    const Column middle = column_at(0.5 * (a.along + b.along));
    look_between(a, middle, places, out);
    look_between(middle, b, places, out);
}

// The corners are looked at first; the ends of a triangle have no height.
std::vector<double> WallSide::first_places(double step) const
{
    std::vector<double> out;
    if (corners_.size() > 3) {
        for (const Vec3d& corner : corners_) {
            out.push_back(dot(corner, along_));
        }
        std::sort(out.begin(), out.end());
        const auto beside = [&](double a, double b) {
            return b - a < kLeastApart * step && b < end_;
        };
        out.erase(std::unique(out.begin(), out.end(), beside), out.end());
    } else {
        const double length = end_ - begin_;
        const int parts =
            std::clamp(static_cast<int>(length / (kLeastApart * step)), 2, kFirstParts);
        for (int k = 0; k <= parts; ++k) {
            out.push_back(begin_ + length * k / parts);
        }
    }
    return out;
}

std::vector<WallSide::Run> WallSide::missing_runs(const ScallopAtPoint& places,
                                                  KnownReach& known) const
{
    std::vector<Run> out;
    const std::vector<double> at = first_places(places.step());
    for (std::size_t k = 1; k < at.size(); ++k) {
        look_over(at[k - 1], at[k], -1, places, known, out);
    }
    return out;
}

Points WallSide::pass_along(const Run& run) const
{
    const Vec3d up{0, 0, fitter_.tool().radius};
    const auto tip_at = [&](double along) {
        const Column column = column_at(along);
        if (column.is_reached()) {
            return centre_beside(along, column.at(run.level)) - up;
        }
        const Vec3d beside = centre_beside(along, column.top);
        const double rest = rest_beside(along, column.top).value_or(beside.z);
        return Vec3d{beside.x, beside.y, std::max(beside.z, rest)} - up;
    };
    if (run.to - run.from < kShortestPass) {
        const Vec3d tip = tip_at(run.from);
        return {tip, tip + along_ * kShortestPass};
    }
    const double pitch = kPassPitch * fitter_.tool().radius;
    const int pieces = std::max(1, static_cast<int>(std::ceil((run.to - run.from) / pitch)));
    std::vector<double> breaks;
    for (int k = 0; k <= pieces; ++k) {
        breaks.push_back(run.from + (run.to - run.from) * k / pieces);
    }
    return fitter_.sample(tip_at, breaks, kPassHalvings);
}

double WallSide::left_in(const Run& run, const ScallopAtPoint& places) const
{
    double most = 0;
    const int parts = std::max(
        1, static_cast<int>(std::ceil((run.to - run.from) / (kReachApart * places.step()))));
    for (int k = 0; k <= parts; ++k) {
        const Column column = column_at(run.from + (run.to - run.from) * k / parts);
        if (column.is_reached()) {
            for (const double level : {0.0, run.level, 1.0}) {
                most =
                    std::max(most, places.left_beside_wall(point_at(column.along, column.at(level)),
                                                           out_at(column.along), off_));
            }
        }
    }
    return most;
}

std::vector<WallSide> wall_sides_of(const WallFacet& facet, const GougeFreePathFitter& fitter)
{
    double low = kInfinite;
    double high = -kInfinite;
    for (const Vec3d& corner : facet.corners) {
        low = std::min(low, corner.z);
        high = std::max(high, corner.z);
    }
    std::vector<WallSide> out;
    if (!(high - low > kLeastHeight) ||
        !(elementary::hypot(facet.normal.x, facet.normal.y) > 0.5)) {
        return out;
    }
    out.emplace_back(facet, false, fitter);
    out.emplace_back(facet, true, fitter);
    return out;
}

}  // namespace cusp::finishing
