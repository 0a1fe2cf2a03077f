// A stretch that is too deep is cut at levels, each as low as the metal that stands allows.
#include "host_tools/grid_pocket/depth_limiter.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/toolpath/toolpath_measure.hpp"

namespace cusp::grid_pocket {

using offset::Box2d;
using toolpath::MoveKind;
using toolpath::ToolMove;
using toolpath::Toolpath;

namespace {

// The metal is known at places only: what stands between them may be this much higher.
constexpr double kBetween = 0.005;  // mm

// Arcs are tracked along chords this near, mm.
constexpr double kChord = 0.002;

// Shorter than this is no way, mm.
constexpr double kNoWay = 1e-9;

// Heights of the floor are asked for at every so many places of a run; between them only where the
// depth may be over the limit by this share of it.
constexpr int kSparse = 8;
constexpr double kNearLimit = 0.4;

constexpr int kMaxRings = 1000;
constexpr double kNoLevel = 1e300;

}  // namespace

DepthLimiter::DepthLimiter(GridToolpathWriter& moves,
                           const Toolpath& path,
                           const Box2d& box,
                           double top,
                           std::optional<double> most)
    : moves_{moves},
      path_{path},
      max_depth_{most},
      stock_{box, path.tool, top},
      spacing_{path.tool.radius / 40}
{
}

void DepthLimiter::track_moves()
{
    for (; tracked_moves_ < path_.moves.size(); ++tracked_moves_) {
        const ToolMove& move = path_.moves[tracked_moves_];
        for (const Vec3d p : points_of(move, at_, kChord)) {
            const double depth = tracked_moves_ > 0 ? stock_.cut(at_, p) : 0;
            deepest_ = std::max(deepest_, depth);
            at_ = p;
        }
    }
}

std::vector<DepthLimiter::Stretch> DepthLimiter::deep_stretches(const ClPathFitter& floor,
                                                                Vec2d a,
                                                                Vec2d b) const
{
    const double length = norm(b - a);
    const int count = 1 + static_cast<int>(length / spacing_);
    const double step = length / count;
    const auto place = [&](int i) {
        return a + (b - a) * (static_cast<double>(std::min(i, count)) / count);
    };
    std::vector<Stretch> out;
    double before = 0;  // lowest heights over the floor at places of every kSparse-th number
    double after = 0;
    int known = -1;
    for (int i = 0; i <= count; ++i) {
        const double level = stock_.contact_height(place(i)) + kBetween - *max_depth_;
        if (level <= floor.bottom()) {
            continue;
        }
        const int first = i / kSparse * kSparse;
        if (known != first) {
            before = known + kSparse == first ? after : floor.lowest_height(place(first));
            after = floor.lowest_height(place(first + kSparse));
            known = first;
        }
        if (level < std::min(before, after) - kNearLimit * *max_depth_) {
            continue;
        }
        const double low = floor.lowest_height(place(i));
        if (level <= low) {
            continue;
        }
        const double begin = std::max(0.0, (i - 1) * step);
        if (out.empty() || out.back().end < begin - step) {
            out.push_back({begin, begin, level, low});
        }
        out.back().end = std::min(length, (i + 1) * step);
        out.back().min_z = std::max(out.back().min_z, level);
        out.back().low = std::min(out.back().low, low);
    }
    return out;
}

void DepthLimiter::enter(const ClPathFitter& floor,
                         const std::vector<Vec2d>& corners,
                         double stock_top,
                         bool link,
                         const GridToolpathWriter::CircleFloor& circle)
{
    if (!max_depth_) {
        moves_.enter(floor, corners, stock_top, link, circle);
        return;
    }
    track_moves();
    std::optional<double> level;
    double left = moves_.ramp_length();
    for (std::size_t i = 1; i < corners.size() && left > 0; ++i) {
        const Vec2d way = corners[i] - corners[i - 1];
        const double length = norm(way);
        if (length < kNoWay) {
            continue;
        }
        const Vec2d end = corners[i - 1] + way * std::min(1.0, left / length);
        for (const Stretch& deep : deep_stretches(floor, corners[i - 1], end)) {
            level = std::max(level.value_or(deep.min_z), deep.min_z);
        }
        left -= length;
    }
    moves_.enter(level ? floor.above(*level) : floor, corners, stock_top, link, circle);
}

void DepthLimiter::follow(ClPathFitter& floor,
                          const std::vector<Vec2d>& corners,
                          const GridToolpathWriter::CircleFloor& circle)
{
    if (!max_depth_) {
        floor.follow(moves_.tip(), corners, MoveKind::kCut);
        return;
    }
    for (std::size_t i = 1; i < corners.size(); ++i) {
        if (norm(corners[i] - corners[i - 1]) >= kNoWay) {
            follow_segment(floor, corners[i - 1], corners[i], circle);
        }
    }
}

bool DepthLimiter::too_deep(const ClPathFitter& floor, const std::vector<Vec2d>& corners)
{
    track_moves();
    for (std::size_t i = 1; max_depth_ && i < corners.size(); ++i) {
        if (norm(corners[i] - corners[i - 1]) >= kNoWay &&
            !deep_stretches(floor, corners[i - 1], corners[i]).empty()) {
            return true;
        }
    }
    return false;
}

void DepthLimiter::follow_segment(ClPathFitter& floor,
                                  Vec2d a,
                                  Vec2d b,
                                  const GridToolpathWriter::CircleFloor& circle)
{
    const double length = norm(b - a);
    const auto place = [&](double s) {
        return s >= length ? b : a + (b - a) * (s / length);
    };
    track_moves();
    double done = 0;
    for (const Stretch& deep : deep_stretches(floor, a, b)) {
        if (deep.begin > done) {
            floor.follow(moves_.tip(), {place(done), place(deep.begin)}, MoveKind::kCut);
        }
        lower(floor, place(deep.begin), place(deep.end), circle);
        done = deep.end;
    }
    if (done < length) {
        floor.follow(moves_.tip(), {place(done), b}, MoveKind::kCut);
    }
}

void DepthLimiter::lower(ClPathFitter& floor,
                         Vec2d a,
                         Vec2d b,
                         const GridToolpathWriter::CircleFloor& circle)
{
    const auto stand = [&](double z) {
        moves_.tip().line(MoveKind::kLink, {a.x, a.y, std::max(z, moves_.tip_at().z)});
    };
    double last = kNoLevel;
    for (int i = 0; i < kMaxRings; ++i) {
        track_moves();
        const std::vector<Stretch> deep = deep_stretches(floor, a, b);
        if (deep.empty()) {
            break;
        }
        double highest = -kNoLevel;
        double lowest = kNoLevel;
        for (const Stretch& stretch : deep) {
            highest = std::max(highest, stretch.min_z);
            lowest = std::min(lowest, stretch.low);
        }
        // Beside a cliff moves stay higher than the floor's places, and so does the metal.
        const double level = std::min(highest, last - *max_depth_);
        if (level <= lowest) {
            break;
        }
        last = level;
        ClPathFitter over = floor.above(level);
        stand(over.start_height(a));
        moves_.descend(over, {a, b}, stock_.contact_height(a), circle);
        over.follow(moves_.tip(), {a, b}, MoveKind::kCut);
        over.follow(moves_.tip(), {b, a}, MoveKind::kCut);
        floor.add_bound(over.gouge_bound());
        ++added_;
    }
    moves_.descend(floor, {a, b}, stock_.contact_height(a), circle);
    floor.follow(moves_.tip(), {a, b}, MoveKind::kCut);
}

}  // namespace cusp::grid_pocket
