// A stretch that is too deep is cut at levels, each as low as the metal that stands allows.
#include "host_tools/grid_pocket/depth_limit.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/toolpath/toolpath_measure.hpp"

namespace cusp::host {
namespace {

// The metal is known at places only: what stands between them may be this much higher.
constexpr double kBetween = 0.005;  // mm

// Arcs are felt along chords this near, mm.
constexpr double kChord = 0.002;

// Shorter than this is no way, mm.
constexpr double kNoWay = 1e-9;

// Heights of the floor are asked for at every so many places of a run; between them only where the
// depth may be over the limit by this share of it.
constexpr int kSparse = 8;
constexpr double kNearLimit = 0.4;

constexpr int kMostLevels = 1000;
constexpr double kNoLevel = 1e300;

}  // namespace

DepthLimit::DepthLimit(GridMoves& moves,
                       const Toolpath& path,
                       const Box2d& box,
                       double top,
                       std::optional<double> most)
    : moves_{moves},
      path_{path},
      most_{most},
      metal_{box, path.tool, top},
      look_{path.tool.radius / 40}
{
}

void DepthLimit::feel_moves()
{
    for (; felt_ < path_.moves.size(); ++felt_) {
        const ToolMove& move = path_.moves[felt_];
        for (const Vec3d p : points_of(move, at_, kChord)) {
            const double depth = felt_ > 0 ? metal_.cut(at_, p) : 0;
            deepest_ = std::max(deepest_, depth);
            at_ = p;
        }
    }
}

std::vector<DepthLimit::Stretch> DepthLimit::deep_stretches(const FloorFollower& floor,
                                                            Vec2d a,
                                                            Vec2d b) const
{
    const double length = norm(b - a);
    const int count = 1 + static_cast<int>(length / look_);
    const double step = length / count;
    const auto place = [&](int i) {
        return a + (b - a) * (static_cast<double>(std::min(i, count)) / count);
    };
    std::vector<Stretch> out;
    double before = 0;  // lowest heights over the floor at places of every kSparse-th number
    double after = 0;
    int known = -1;
    for (int i = 0; i <= count; ++i) {
        const double level = metal_.touch(place(i)) + kBetween - *most_;
        if (level <= floor.bottom()) {
            continue;
        }
        const int first = i / kSparse * kSparse;
        if (known != first) {
            before = known + kSparse == first ? after : floor.lowest_height(place(first));
            after = floor.lowest_height(place(first + kSparse));
            known = first;
        }
        if (level < std::min(before, after) - kNearLimit * *most_) {
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
        out.back().level = std::max(out.back().level, level);
        out.back().low = std::min(out.back().low, low);
    }
    return out;
}

void DepthLimit::enter(const FloorFollower& floor,
                       const std::vector<Vec2d>& corners,
                       double metal,
                       bool link,
                       const GridMoves::CircleFloor& circle)
{
    if (!most_) {
        moves_.enter(floor, corners, metal, link, circle);
        return;
    }
    feel_moves();
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
            level = std::max(level.value_or(deep.level), deep.level);
        }
        left -= length;
    }
    moves_.enter(level ? floor.above(*level) : floor, corners, metal, link, circle);
}

void DepthLimit::follow(FloorFollower& floor,
                        const std::vector<Vec2d>& corners,
                        const GridMoves::CircleFloor& circle)
{
    if (!most_) {
        floor.follow(moves_.tip(), corners, MoveKind::kCut);
        return;
    }
    for (std::size_t i = 1; i < corners.size(); ++i) {
        if (norm(corners[i] - corners[i - 1]) >= kNoWay) {
            follow_segment(floor, corners[i - 1], corners[i], circle);
        }
    }
}

bool DepthLimit::too_deep(const FloorFollower& floor, const std::vector<Vec2d>& corners)
{
    feel_moves();
    for (std::size_t i = 1; most_ && i < corners.size(); ++i) {
        if (norm(corners[i] - corners[i - 1]) >= kNoWay &&
            !deep_stretches(floor, corners[i - 1], corners[i]).empty()) {
            return true;
        }
    }
    return false;
}

void DepthLimit::follow_segment(FloorFollower& floor,
                                Vec2d a,
                                Vec2d b,
                                const GridMoves::CircleFloor& circle)
{
    const double length = norm(b - a);
    const auto place = [&](double s) {
        return s >= length ? b : a + (b - a) * (s / length);
    };
    feel_moves();
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

void DepthLimit::lower(FloorFollower& floor, Vec2d a, Vec2d b, const GridMoves::CircleFloor& circle)
{
    const auto stand = [&](double z) {
        moves_.tip().line(MoveKind::kLink, {a.x, a.y, std::max(z, moves_.tip_at().z)});
    };
    double last = kNoLevel;
    for (int i = 0; i < kMostLevels; ++i) {
        feel_moves();
        const std::vector<Stretch> deep = deep_stretches(floor, a, b);
        if (deep.empty()) {
            break;
        }
        double highest = -kNoLevel;
        double lowest = kNoLevel;
        for (const Stretch& stretch : deep) {
            highest = std::max(highest, stretch.level);
            lowest = std::min(lowest, stretch.low);
        }
        // Beside a cliff moves stay higher than the floor's places, and so does the metal.
        const double level = std::min(highest, last - *most_);
        if (level <= lowest) {
            break;
        }
        last = level;
        FloorFollower over = floor.above(level);
        stand(over.start_height(a));
        moves_.descend(over, {a, b}, metal_.touch(a), circle);
        over.follow(moves_.tip(), {a, b}, MoveKind::kCut);
        over.follow(moves_.tip(), {b, a}, MoveKind::kCut);
        floor.add_bound(over.gouge_bound());
        ++added_;
    }
    moves_.descend(floor, {a, b}, metal_.touch(a), circle);
    floor.follow(moves_.tip(), {a, b}, MoveKind::kCut);
}

}  // namespace cusp::host
