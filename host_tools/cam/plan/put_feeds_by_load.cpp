// Wanted feeds at positions become stretches of one feed, stretches become parts of moves.
#include <algorithm>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/plan/chip_load.hpp"
#include "host_tools/cam/plan/stages.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "host_tools/judge/verify/path_engagement.hpp"

#include "fmt/format.h"

namespace cusp::plan {

using job::ChipLoad;
using job::Job;
using job::Operation;
using toolpath::ArcPlane;
using toolpath::ArcTo;
using toolpath::end_of;
using toolpath::LineTo;
using toolpath::MachineRates;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::ToolMove;
using toolpath::Toolpath;
using toolpath::ToolShape;
using verify::path_engagement;
using verify::PathEngagement;
using verify::StepKind;

namespace {

constexpr double kMostOfFeed = 2;  // where the job has no feed_max

constexpr double kChange = 1.05;        // smaller changes of the feed are not written
constexpr double kShortStretch = 0.25;  // radii: faster ones that are shorter are not worth a word
constexpr double kSecondsPerMinute = 60.0;

// Positions [begin, end) with one feed.
struct Stretch {
    std::size_t begin;
    std::size_t end;
    double low;  // mm/min, of what its positions ask for
    double high;
    double length;  // mm
};

void join(Stretch& into, const Stretch& other)
{
    into.begin = std::min(into.begin, other.begin);
    into.end = std::max(into.end, other.end);
    into.low = std::min(into.low, other.low);
    into.high = std::max(into.high, other.high);
    into.length += other.length;
}

// Short stretches that are faster than a neighbour take its feed.
std::vector<Stretch> without_short(std::vector<Stretch> all, double least)
{
    std::vector<Stretch> out;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const bool is_short = all[k].length < least;
        if (is_short && !out.empty() && out.back().end == all[k].begin &&
            out.back().low <= all[k].low) {
            join(out.back(), all[k]);
        } else if (is_short && k + 1 < all.size() && all[k].end == all[k + 1].begin &&
                   all[k + 1].low <= all[k].low) {
            join(all[k + 1], all[k]);
        } else {
            out.push_back(all[k]);
        }
    }
    return out;
}

bool is_scaled(const ToolMove& move)
{
    return move.kind == MoveKind::kCut || move.kind == MoveKind::kLink;
}

// Stretches of a path's cuts and links.
std::vector<Stretch> stretches_of(const Toolpath& path,
                                  const PathEngagement& found,
                                  const ChipLoad& limits)
{
    std::vector<Stretch> out;
    for (std::size_t i = 1; i < found.run.kinds.size(); ++i) {
        if (!is_scaled(path.moves[found.positions.lines[i]])) {
            continue;
        }
        const bool enters = found.run.kinds[i] == StepKind::kEntry;
        const double wanted =
            enters ? path.feed
                   : feed_by_load(path.feed, static_cast<double>(found.run.angles[i]), limits);
        const Stretch next{i, i + 1, wanted, wanted,
                           norm(found.positions.tips[i] - found.positions.tips[i - 1])};
        if (!out.empty() && out.back().end == i &&
            std::max(out.back().high, wanted) <= kChange * std::min(out.back().low, wanted)) {
            join(out.back(), next);
        } else {
            out.push_back(next);
        }
    }
    return without_short(std::move(out), kShortStretch * path.tool.radius);
}

// The part of a line or a plane arc that ends there. No value: it can't be divided.
std::optional<ToolMove> part_to(const ToolMove& move, Vec3d end)
{
    if (std::holds_alternative<LineTo>(move.shape)) {
        return ToolMove{move.kind, LineTo{end}, move.feed};
    }
    const auto* arc = std::get_if<ArcTo>(&move.shape);
    if (arc != nullptr && arc->plane == ArcPlane::kXY) {
        ArcTo part = *arc;
        const Vec2d centre{arc->centre.x, arc->centre.y};
        // Positions are on chords.
        const Vec2d to = Vec2d{end.x, end.y} - centre;
        const Vec2d last = Vec2d{arc->end.x, arc->end.y} - centre;
        const double size = norm(last) / norm(to);
        part.end = {centre.x + to.x * size, centre.y + to.y * size, end.z};
        return ToolMove{move.kind, part, move.feed};
    }
    return std::nullopt;
}

// Sets the feeds, dividing moves where stretches end inside them.
FeedRange put_feeds(const PathEngagement& found, const ChipLoad& limits, Toolpath& path)
{
    const std::vector<Stretch> stretches = stretches_of(path, found, limits);
    FeedRange range;
    std::vector<ToolMove> moves;
    std::size_t s = 0;
    std::size_t position = 0;
    double last = 0;
    const auto add = [&](ToolMove move, double feed) {
        // A change that is too small to be written.
        if (last > 0 && feed <= kChange * last && last <= kChange * feed) {
            feed = last;
        }
        range.changes += last > 0 && feed != last ? 1 : 0;
        range.low = std::min(range.low, feed);
        range.high = std::max(range.high, feed);
        last = feed;
        move.feed = feed;
        moves.push_back(move);
    };
    for (std::size_t k = 0; k < path.moves.size(); ++k) {
        const ToolMove& move = path.moves[k];
        const std::size_t begin = position;
        while (position < found.positions.lines.size() && found.positions.lines[position] == k) {
            ++position;
        }
        while (s < stretches.size() && stretches[s].end <= begin) {
            ++s;
        }
        if (!is_scaled(move) || s == stretches.size() || begin == position) {
            moves.push_back(move);
            continue;
        }
        double least = stretches[s].low;
        std::size_t at = s;
        for (; at < stretches.size() && stretches[at].end < position; ++at) {
            const auto part = part_to(move, found.positions.tips[stretches[at].end - 1]);
            if (part) {
                add(*part, stretches[at].low);
                least = stretches[at + 1].low;
            } else {
                least = std::min(least, stretches[at + 1].low);
            }
        }
        add(move, least);
    }
    path.moves = std::move(moves);
    return range;
}

void add_removal(const PathEngagement& found, double seconds, toolpath::OperationStats& stats)
{
    stats.counts.emplace_back("air_mm", found.air_mm);
    stats.counts.emplace_back("removed_mm3", found.removed_mm3);
    stats.counts.emplace_back("mean_removal_mm3_per_min",
                              seconds > 0 ? found.removed_mm3 / seconds * kSecondsPerMinute : 0.0);
}

}  // namespace

double feed_by_load(double feed, double degrees, const ChipLoad& limits)
{
    constexpr double kSlot = 0.5;  // of the feed
    const double low = limits.feed_min.value_or(feed);
    const double high = std::max(low, limits.feed_max.value_or(kMostOfFeed * feed));
    const double share = degrees <= 90.0
                             ? 1.0 / std::max(1e-6, elementary::sin(degrees / 180.0 * kPi))
                             : 1.0 - (1.0 - kSlot) * (degrees - 90.0) / 90.0;
    return std::clamp(feed * share, low, high);
}

void find_engagement(Planning& planning)
{
    const Job& job = planning.job;
    const bool counts = planning.options.measures_engagement;
    if (std::none_of(job.operations.begin(), job.operations.end(), [counts](const Operation& o) {
            return (counts && o.passes.max_engagement.has_value()) ||
                   o.passes.chip_load.has_value();
        })) {
        return;
    }
    // A plan with a bound for some operations and none for others can't know what is over in all.
    for (const PlannedOperation& planned : planning.program.operations) {
        const Operation& operation = operation_of(job, planned);
        planning.limits.push_back(operation.strategy->traits.bounds_engagement
                                      ? operation.passes.max_engagement
                                      : std::nullopt);
    }
    planning.begin("looking for the engagement");
    planning.engagement = path_engagement(job, paths_of(planning.program), planning.limits,
                                          planning.reports("engagement"));
}

void put_feeds_by_load(Planning& planning)
{
    const Job& job = planning.job;
    PlannedProgram& program = planning.program;
    if (planning.engagement.empty()) {
        return;
    }
    planning.feeds.resize(program.operations.size());
    for (std::size_t k = 0; k < program.operations.size(); ++k) {
        PlannedOperation& planned = program.operations[k];
        auto chip_load = operation_of(job, planned).passes.chip_load;
        if (chip_load && planned.path.tool.shape == ToolShape::kFlat && !planned.path.cycle) {
            if (const auto most = job.machine.most_feed()) {
                chip_load->feed_max = std::min(
                    most->value, chip_load->feed_max.value_or(kMostOfFeed * planned.path.feed));
            }
            planning.feeds[k] = put_feeds(planning.engagement[k], *chip_load, planned.path);
            planning.is_written = false;
        }
        planning.feeds[k].before_s = program.measures[k].estimated_s;
    }
    if (!planning.is_written) {
        measure_paths(planning);
    }
}

void count_engagement(Planning& planning)
{
    PlannedProgram& program = planning.program;
    for (std::size_t k = 0; k < planning.engagement.size(); ++k) {
        toolpath::OperationStats& stats = program.operations[k].stats;
        const double seconds = program.measures[k].estimated_s;
        if (operation_of(planning.job, program.operations[k]).passes.max_engagement) {
            add_removal(planning.engagement[k], seconds, stats);
            if (planning.limits[k]) {
                stats.counts.emplace_back("found_over_engagement_mm",
                                          planning.engagement[k].over_mm);
            }
        }
        if (planning.feeds[k].high > 0) {
            stats.counts.emplace_back("chip_load_before_s", planning.feeds[k].before_s);
            stats.counts.emplace_back("chip_load_after_s", seconds);
            stats.counts.emplace_back("chip_load_feed_least", planning.feeds[k].low);
            stats.counts.emplace_back("chip_load_feed_most", planning.feeds[k].high);
            stats.counts.emplace_back("chip_load_feed_changes", planning.feeds[k].changes);
        }
    }
}

}  // namespace cusp::plan
