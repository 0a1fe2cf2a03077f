// A stretch that would be cut too deep is cut at several levels, each as low as the stock allows.
#include "host_tools/cam/grid_pocket/depth_limiter.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/grid_pocket/run_entry.hpp"

namespace cusp::grid_pocket {

using clearing::AxialDepthTracker;
using toolpath::MoveKind;
using toolpath::Toolpath;
using toolpath::ToolpathWriter;

namespace {

// Shorter segments are ignored, mm.
constexpr double kNoWay = 1e-9;

// Heights of the floor are computed at every kSparse-th sample of a run, and between them only
// where the depth may be above this share of the limit.
constexpr int kSparse = 8;
constexpr double kNearLimit = 0.4;

// A floor that rises by more than this from sample to sample, in distances of samples, is a cliff.
constexpr double kCliff = 10.0;
constexpr double kFootError = 2e-3;  // mm: of the place of its foot

constexpr int kMaxLevels = 1000;
constexpr double kEntryLength = 4.0;  // radii: length of a run that an entry may cut

}  // namespace

DepthLimiter::DepthLimiter(ToolpathWriter& writer, const Toolpath& path, AxialDepthTracker depth)
    : writer_{writer}, path_{path}, depth_{std::move(depth)}, spacing_{path.tool.radius / 40}
{
}

// Samples of the segment from a to b that may cut too deep, with the height of a tip that does not.
// Groups of samples whose stock is low everywhere are left out, all that remain are looked at on all
// cores.
std::vector<DepthLimiter::Sample> DepthLimiter::deep_samples(const ClPathFitter& floor,
                                                             const SampleRow& row) const
{
    const double max_depth = *depth_.max_depth();
    const int groups = row.count / kSparse + 1;
    std::vector<double> most(static_cast<std::size_t>(groups));
    parallel::for_each(most.size(), [&](std::size_t k) {
        const int first = static_cast<int>(k) * kSparse;
        const Vec2d begin = row.place(first);
        const Vec2d end = row.place(first + kSparse - 1);
        most[k] =
            depth_.most_stock_top_near((begin + end) * 0.5, 0.5 * norm(end - begin)) - max_depth;
    });
    std::vector<Sample> samples;
    int known = -1;
    double before = 0;  // lowest height at the first sample of the group
    double after = 0;
    for (int k = 0; k < groups; ++k) {
        const double level = most[static_cast<std::size_t>(k)];
        if (level <= floor.bottom()) {
            continue;
        }
        before = known == k - 1 && k > 0 ? after : floor.lowest_height(row.place(k * kSparse));
        after = floor.lowest_height(row.place((k + 1) * kSparse));
        known = k;
        const double least = std::min(before, after) - kNearLimit * max_depth;
        const int end = std::min(row.count + 1, (k + 1) * kSparse);
        for (int i = k * kSparse; level >= least && i < end; ++i) {
            samples.push_back({i, least, 0.0});
        }
    }
    parallel::for_each(samples.size(), [&](std::size_t k) {
        samples[k].level = depth_.stock_top_at(row.place(samples[k].number)) - max_depth;
    });
    samples.erase(std::remove_if(samples.begin(), samples.end(),
                                 [&](const Sample& sample) {
                                     return sample.level <= floor.bottom() ||
                                            sample.level < sample.least;
                                 }),
                  samples.end());
    return samples;
}

std::vector<DepthLimiter::Stretch> DepthLimiter::deep_stretches(const ClPathFitter& floor,
                                                                Vec2d a,
                                                                Vec2d b) const
{
    const double length = norm(b - a);
    const SampleRow row{a, b, 1 + static_cast<int>(length / spacing_)};
    const double step = length / row.count;
    std::vector<Stretch> out;
    for (const Sample& sample : deep_samples(floor, row)) {
        const int i = sample.number;
        const double low = floor.lowest_height(row.place(i));
        if (sample.level <= low) {
            continue;
        }
        const double foot_level =
            std::max(level_at_foot(floor, row.place(i), low, row.place(std::max(0, i - 1))),
                     level_at_foot(floor, row.place(i), low, row.place(i + 1)));
        const double begin = std::max(0.0, (i - 1) * step);
        if (out.empty() || out.back().end < begin - step) {
            out.push_back({begin, begin, sample.level, low});
        }
        out.back().end = std::min(length, (i + 1) * step);
        out.back().min_z = std::max({out.back().min_z, sample.level, foot_level});
        out.back().low = std::min(out.back().low, low);
    }
    return out;
}

// The height that does not cut too deep at the foot of a cliff between a low place and a higher one:
// stock beside the cliff is higher than at the samples. Lower than any other without a cliff.
double DepthLimiter::level_at_foot(const ClPathFitter& floor,
                                   Vec2d at,
                                   double low,
                                   Vec2d higher) const
{
    const double top = low + kCliff * spacing_;
    if (floor.lowest_height(higher) < top) {
        return -kUnbounded;
    }
    while (norm(higher - at) > kFootError) {
        const Vec2d middle = (at + higher) * 0.5;
        (floor.lowest_height(middle) < top ? at : higher) = middle;
    }
    return depth_.stock_top_at(at) - *depth_.max_depth();
}

void DepthLimiter::enter(const ClPathFitter& floor,
                         const std::vector<Vec2d>& corners,
                         double stock_top,
                         bool link,
                         const ToolpathWriter::HelixFloor& circle)
{
    const double radius = writer_.tool_radius();
    if (!is_limited()) {
        enter_run(writer_, run_beginning(floor, corners, radius), stock_top, link, circle);
        return;
    }
    track_moves();
    std::optional<double> level;
    double left = kEntryLength * radius;
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
    const ClPathFitter& over = level ? floor.above(*level) : floor;
    enter_run(writer_, run_beginning(over, corners, radius), stock_top, link, circle);
}

void DepthLimiter::follow(ClPathFitter& floor,
                          const std::vector<Vec2d>& corners,
                          const ToolpathWriter::HelixFloor& circle)
{
    if (!is_limited()) {
        floor.follow(writer_, corners, MoveKind::kCut);
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
    for (std::size_t i = 1; is_limited() && i < corners.size(); ++i) {
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
                                  const ToolpathWriter::HelixFloor& circle)
{
    const double length = norm(b - a);
    const auto place = [&](double s) {
        return s >= length ? b : a + (b - a) * (s / length);
    };
    track_moves();
    double done = 0;
    for (const Stretch& deep : deep_stretches(floor, a, b)) {
        if (deep.begin > done) {
            floor.follow(writer_, {place(done), place(deep.begin)}, MoveKind::kCut);
        }
        lower(floor, place(deep.begin), place(deep.end), circle);
        done = deep.end;
    }
    if (done < length) {
        floor.follow(writer_, {place(done), b}, MoveKind::kCut);
    }
}

void DepthLimiter::lower(ClPathFitter& floor,
                         Vec2d a,
                         Vec2d b,
                         const ToolpathWriter::HelixFloor& circle)
{
    const auto rise = [&](double z) {
        writer_.line(MoveKind::kLink, {a.x, a.y, std::max(z, writer_.at().z)});
    };
    const auto descend = [&](const ClPathFitter& over) {
        writer_.enter(run_beginning(over, {a, b}, writer_.tool_radius()), depth_.stock_top_at(a),
                      circle);
    };
    std::optional<double> last;
    for (int i = 0; i < kMaxLevels; ++i) {
        track_moves();
        const std::vector<Stretch> deep = deep_stretches(floor, a, b);
        if (deep.empty()) {
            break;
        }
        double highest = -kUnbounded;
        double lowest = kUnbounded;
        for (const Stretch& stretch : deep) {
            highest = std::max(highest, stretch.min_z);
            lowest = std::min(lowest, stretch.low);
        }
        // Beside a cliff, moves and hence the stock are higher than the floor.
        const double level = last ? std::min(highest, *last - *depth_.max_depth()) : highest;
        if (level <= lowest) {
            break;
        }
        last = level;
        ClPathFitter over = floor.above(level);
        rise(over.start_height(a));
        descend(over);
        over.follow(writer_, {a, b}, MoveKind::kCut);
        over.follow(writer_, {b, a}, MoveKind::kCut);
        floor.add_bound(over.gouge_bound());
        ++added_;
    }
    descend(floor);
    floor.follow(writer_, {a, b}, MoveKind::kCut);
}

}  // namespace cusp::grid_pocket
