// Moves are halved until a piece is proven clear or is short.
#include "host_tools/cam/rest_machining/run_intervals.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/toolpath/arc_geometry.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

namespace cusp::rest_machining {

using toolpath::arc_shape;
using toolpath::ArcShape;
using toolpath::ArcTo;
using toolpath::end_of;
using toolpath::feed_of;
using toolpath::LineTo;
using toolpath::NurbsTo;
using toolpath::points_of;
using toolpath::ToolMove;
using toolpath::Toolpath;

namespace {

constexpr double kShortestShare = 1.0 / 8;  // of the radius: of a piece that is tested
constexpr double kLongestShare = 4;
constexpr double kSameLength = 1e-9;  // mm

double length_of(const ToolMove& move, Vec3d start)
{
    if (const auto* arc = std::get_if<ArcTo>(&move.shape)) {
        return length(arc_shape(start, *arc));
    }
    double sum = 0;
    Vec3d at = start;
    for (const Vec3d p : points_of(move, start, kChordError)) {
        sum += norm(p - at);
        at = p;
    }
    return sum;
}

}  // namespace

void FeedRun::add(const ToolMove& move)
{
    const Vec3d start = moves_.empty() ? start_ : end_of(moves_.back());
    const double before = length();
    moves_.push_back(move);
    ends_.push_back(before + length_of(move, start));
}

Vec3d FeedRun::end_of_move(std::size_t k) const { return end_of(moves_[k]); }

std::size_t FeedRun::move_at(double length) const
{
    const auto found = std::lower_bound(ends_.begin(), ends_.end(), length);
    return std::min(static_cast<std::size_t>(found - ends_.begin()), moves_.size() - 1);
}

ToolMove FeedRun::piece(std::size_t k, double begin_share, double end_share) const
{
    ToolMove move = moves_[k];
    if (begin_share <= 0 && end_share >= 1) {
        return move;
    }
    if (auto* line = std::get_if<LineTo>(&move.shape)) {
        const Vec3d from = start_of(k);
        line->end = end_share >= 1 ? line->end : from + end_share * (line->end - from);
    } else if (auto* arc = std::get_if<ArcTo>(&move.shape)) {
        arc->end = end_share >= 1 ? arc->end : point_on(arc_shape(start_of(k), *arc), end_share);
    }
    return move;
}

Vec3d FeedRun::point_at(double length) const
{
    const std::size_t k = move_at(length);
    const double whole = ends_[k] - begin_of(k);
    const double share = whole > 0 ? (length - begin_of(k)) / whole : 1.0;
    if (share <= 0) {
        return start_of(k);
    }
    return share >= 1 - kSameLength ? end_of_move(k) : end_of(piece(k, 0, share));
}

std::vector<RunInterval> FeedRun::in_stock(const SweptStock& stock, const EndProfile& inner) const
{
    constexpr double kShortest = 0.05;  // mm
    const double shortest = std::max(kShortest, kShortestShare * inner.radius);
    std::vector<RunInterval> out;
    const auto add = [&](double begin, double end) {
        if (!out.empty() && begin <= out.back().end + kSameLength) {
            out.back().end = end;
        } else {
            out.push_back({begin, end});
        }
    };
    struct Part {
        double begin;
        double end;
    };
    for (std::size_t k = 0; k < moves_.size(); ++k) {
        const double whole = ends_[k] - begin_of(k);
        const bool divisible = !std::holds_alternative<NurbsTo>(moves_[k].shape);
        std::vector<Part> open{{0, 1}};  // of the move, the next last
        while (!open.empty()) {
            const Part part = open.back();
            open.pop_back();
            const double length = whole * (part.end - part.begin);
            const bool is_long = divisible && length > kLongestShare * inner.radius;
            Vec3d at = part.begin > 0 ? point_at(begin_of(k) + part.begin * whole) : start_of(k);
            bool clear = !is_long;
            if (clear) {
                for (const Vec3d p : points_of(piece(k, part.begin, part.end), at, kChordError)) {
                    clear = clear && stock.is_clear({inner, at, p});
                    at = p;
                }
            }
            if (clear) {
                continue;
            }
            if (divisible && length > shortest) {
                const double middle = (part.begin + part.end) / 2;
                open.push_back({middle, part.end});
                open.push_back({part.begin, middle});
                continue;
            }
            add(begin_of(k) + part.begin * whole, begin_of(k) + part.end * whole);
        }
    }
    return out;
}

RunInterval FeedRun::widened(const RunInterval& interval, double by) const
{
    RunInterval out{std::max(0.0, interval.begin - by), std::min(length(), interval.end + by)};
    const std::size_t first = move_at(out.begin);
    const std::size_t last = move_at(out.end);
    if (std::holds_alternative<NurbsTo>(moves_[first].shape) && out.begin < ends_[first]) {
        out.begin = begin_of(first);
    }
    if (std::holds_alternative<NurbsTo>(moves_[last].shape) && out.end > begin_of(last)) {
        out.end = ends_[last];
    }
    return out;
}

double FeedRun::seconds(const Toolpath& path, const RunInterval& interval) const
{
    constexpr double kSecondsPerMinute = 60;
    double sum = 0;
    for (std::size_t k = move_at(interval.begin); k < moves_.size(); ++k) {
        if (begin_of(k) >= interval.end) {
            break;
        }
        const double way = std::min(interval.end, ends_[k]) - std::max(interval.begin, begin_of(k));
        sum += kSecondsPerMinute * std::max(0.0, way) / feed_of(path, moves_[k], start_of(k));
    }
    return sum;
}

std::vector<ToolMove> FeedRun::moves_in(const RunInterval& interval) const
{
    std::vector<ToolMove> out;
    for (std::size_t k = move_at(interval.begin); k < moves_.size(); ++k) {
        if (begin_of(k) >= interval.end - kSameLength && !(ends_[k] <= interval.end)) {
            break;
        }
        const double whole = ends_[k] - begin_of(k);
        if (ends_[k] <= interval.begin + kSameLength && whole > 0) {
            continue;
        }
        const double begin = whole > 0 ? (interval.begin - begin_of(k)) / whole : 0;
        const double end = whole > 0 ? (interval.end - begin_of(k)) / whole : 1;
        out.push_back(piece(k, begin, end >= 1 - kSameLength ? 1.0 : end));
    }
    return out;
}

}  // namespace cusp::rest_machining
