// Columns of a facet, divided until one move removes what is reached between two.
#include "host_tools/finishing/wall_side.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host_tools/part_model/facet_distance.hpp"

namespace cusp::finishing {

using part_model::Facet;

namespace {

constexpr double kLongestApart = 2;          // in stepovers: columns
constexpr double kReachApart = 1.0 / 16;     // the same: those of which reach is looked at
constexpr double kLeastApart = 1.0 / 64;     // the same
constexpr double kBorderApart = 1.0 / 1024;  // the same, where reach begins or ends
constexpr int kFirstParts = 8;               // at least; the ends of a triangle have no height
constexpr double kBeside = 1e-4;             // mm: vertices of files are rounded
constexpr double kLeastHeight = 1e-4;        // mm, of what is reached
constexpr double kReachSlack = 1e-6;         // mm
constexpr int kReachHalvings = 20;
constexpr int kLevels = 16;             // of a leaning column
constexpr double kShortestPass = 1e-3;  // mm
constexpr double kPassPitch = 0.1;      // radii
constexpr int kPassHalvings = 7;        // of it: dropped tips may jump

}  // namespace

WallSide::WallSide(const std::array<Vec3d, 3>& corners,
                   Vec3d out,
                   const GougeFreePathFitter& fitter)
    : corners_{corners}, out_{out}, fitter_{fitter}
{
    const double level = std::hypot(out.x, out.y);
    along_ = Vec3d{-out.y, out.x, 0} / level;
    upward_ = Vec3d{-out.x * out.z, -out.y * out.z, level * level} / (level * level);
    std::array<double, 3> ways{};
    for (std::size_t k = 0; k < 3; ++k) {
        ways[k] = dot(corners[k], along_);
    }
    begin_ = *std::min_element(ways.begin(), ways.end());
    end_ = *std::max_element(ways.begin(), ways.end());
    const auto [low, high] = std::minmax({corners[0].z, corners[1].z, corners[2].z});
    leans_ = out.z * (high - low) > kBeside;
}

Vec3d WallSide::point_at(double along, double z) const
{
    const Vec3d from = corners_.front();
    return from + along_ * (along - dot(from, along_)) + upward_ * (z - from.z);
}

// Of a ball that touches the wall there, and a little off.
Vec3d WallSide::centre_beside(double along, double z) const
{
    return point_at(along, z) + out_ * (fitter_.offset_tool().radius + kBeside);
}

// z of the centre of a ball that rests beside the wall; none where nothing lies below it.
std::optional<double> WallSide::rest_beside(double along, double z) const
{
    const Vec3d centre = centre_beside(along, z);
    const auto rest = fitter_.model().drop_ball(centre.x, centre.y, fitter_.offset_tool().radius);
    return rest ? std::optional{rest->centre.z} : std::nullopt;
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
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d a = corners_[k];
        const Vec3d b = corners_[(k + 1) % 3];
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
        if (!places.is_wall_cut(point_at(column.along, column.at(level)), out_, kPlaceShare)) {
            return level;
        }
    }
    return std::nullopt;
}

bool WallSide::one_move_cuts(const Column& a, const Column& b, const ScallopAtPoint& places) const
{
    Points ends;
    for (const Column& column : {a, b}) {
        ends.push_back(point_at(column.along, column.low));
        if (leans_) {
            ends.push_back(point_at(column.along, column.top));
        }
    }
    return places.one_move_cuts_wall(ends, out_);
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

std::vector<WallSide::Run> WallSide::missing_runs(const ScallopAtPoint& places) const
{
    const double length = end_ - begin_;
    const int parts =
        std::clamp(static_cast<int>(length / (kLeastApart * places.step())), 2, kFirstParts);
    std::vector<Run> out;
    Column last = column_at(begin_);
    for (int k = 1; k <= parts; ++k) {
        const Column next = column_at(begin_ + length * k / parts);
        look_between(last, next, places, out);
        last = next;
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
                most = std::max(
                    most, places.left_beside_wall(point_at(column.along, column.at(level)), out_));
            }
        }
    }
    return most;
}

std::vector<WallSide> wall_sides_of(const std::array<Vec3d, 3>& corners,
                                    const GougeFreePathFitter& fitter)
{
    const Facet facet{corners};
    const auto [low, high] = std::minmax({corners[0].z, corners[1].z, corners[2].z});
    std::vector<WallSide> out;
    if (!(high - low > kLeastHeight) || !(std::hypot(facet.normal.x, facet.normal.y) > 0.5)) {
        return out;
    }
    out.emplace_back(corners, facet.normal, fitter);
    // The other side of a wall that leans lies under it.
    if (facet.normal.z * (high - low) <= kBeside) {
        out.emplace_back(corners, -facet.normal, fitter);
    }
    return out;
}

}  // namespace cusp::finishing
