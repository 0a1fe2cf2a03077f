// One pass after the other, the next from where the last one ends wherever there is a way.
#include "host_tools/contour_pocket/floor_cutter.hpp"

#include <algorithm>

#include "firmware/base/math.hpp"
#include "host_tools/clearing/free_way.hpp"
#include "host_tools/clearing/way_within.hpp"
#include "host_tools/contour_pocket/pocket_task.hpp"

namespace cusp::host {

namespace {

constexpr double kSamePlace = kWrittenStep;  // paths are rounded to it
constexpr double kBarelyOver = 0.03;         // mm over a pass: no slope is needed

double lowest_of(const FloorPath& path)
{
    double lowest = path.start.z;
    for (const FloorMove& move : path.moves) {
        lowest = std::min(lowest, move.end.z);
        for (const Vec3d p : move.curve.points) {
            lowest = std::min(lowest, p.z);
        }
    }
    return lowest;
}

// From level to level of one pass: along it.
EntryKind way_down(EntryKind entry)
{
    return entry == EntryKind::kPlunge ? entry : EntryKind::kRamp;
}

bool is_open(const ClearingPass& pass)
{
    return distance(pass.path.front().start, pass.path.back().end) > 1e-9;
}

bool is_set(const std::vector<bool>& flags, std::size_t i) { return i < flags.size() && flags[i]; }

}  // namespace

Region2d reach_of(const RegionOffset& walls, double first)
{
    return walls.at(first - kWrittenStep);
}

FloorPath FloorCutter::laid(const std::vector<Edge>& plan, const FloorPathSettings& laying)
{
    FloorPath path = lay_on_floor(plan, floor_, laying);
    if (!path.over_floor) {
        refuse_uncovered(operation_, path.missing);
    }
    return path;
}

void FloorCutter::enter(const Laid& cut, const CutSettings& settings)
{
    const ClearingPass& pass = cut.pass;
    FloorPathSettings laying = cut.laying;
    const double tool = operation_.tool.radius;
    const double radius = std::min(0.6 * tool, pass.room - settings.first - 1e-3);
    const double round = length(pass.path);
    const Vec2d start = pass.path.front().start;
    const bool stands = moves_.stands_over(cut.path.start);
    // A ramp round a pass that is hardly longer than a point would be a plunge: a small helix is
    // better, though it leaves more to the middle of the tool.
    const bool helix = (settings.entry == EntryKind::kHelix && !stands) ||
                       (settings.entry == EntryKind::kAuto && round < 6.0 * tool && !stands) ||
                       (settings.entry != EntryKind::kPlunge && round < 0.5 * tool);
    const bool lines = !laying.arcs && !laying.nurbs;
    laying.arcs = laying.nurbs = false;
    const FloorPath path = lines ? cut.path : laid(pass.path, laying);
    EntryHeights heights = settings.entry_heights(path.start.z);
    const bool open = is_open(pass);
    if (depth_ != nullptr) {
        const EntryHeights over = heights_over(depth_->highest_at(start));
        // Open passes lie in metal that closed ones have cut.
        heights.metal = open ? over.metal : heights.metal;
        heights.raise_over(over);
    }
    const double around = helix ? metal_around(start, radius) : 0.0;
    // A helix reaches farther than the pass, where metal may stand that no pass has met.
    const bool shallow = depth_ == nullptr || around - path.start.z <= depth_->most();
    const bool wide = radius > 0.2 * tool || (radius > 0.02 * tool && 2 * kPi * radius > round);
    if (helix && wide && shallow) {
        heights.raise_over(heights_over(around));
        heights.metal = moves_.enter_by_helix(
            path.start, radius, round < radius, heights,
            [&](Vec2d at) { return std::max(floor_.drop(at).height + laying.raise, laying.level); },
            [&](Vec3d a, Vec3d b) { return floor_.gap(a, b); });
    }
    moves_.enter_along(path, heights, settings.entry == EntryKind::kPlunge);
}

double FloorCutter::metal_around(Vec2d start, double radius) const
{
    return depth_ == nullptr ? -1e300 : depth_->highest_around(start, radius);
}

bool FloorCutter::too_deep(const FloorPath& path, const CutSettings& settings) const
{
    return depth_ != nullptr && depth_->level_over(path, settings.depth_share).has_value();
}

FloorCutter::Laid FloorCutter::lay(const ClearingPass& pass,
                                   const CutSettings& settings,
                                   bool repeated)
{
    Laid result{pass, settings.laying, {}};
    if (repeated) {
        result.laying.aside = repeated_aside(settings.laying.aside);
    }
    result.path = laid(pass.path, result.laying);
    return result;
}

// False where the way over would cut too deep.
bool FloorCutter::link(const Laid& laid_pass, const CutSettings& settings)
{
    FloorPathSettings linking = settings.laying;
    linking.nurbs = false;
    linking.even = true;
    const FloorPath link = laid(laid_pass.pass.link, linking);
    if (too_deep(link, settings)) {
        return false;
    }
    least_gap_ = std::min(least_gap_, link.least_gap);
    moves_.link(link);
    return true;
}

// Whether the way over the metal is no longer than up and down again.
bool FloorCutter::is_worth_it(const std::vector<Edge>& way) const
{
    constexpr double kLongest = 8.0;  // radii
    return depth_ != nullptr && !way.empty() &&
           length(way) <= 2.0 * moves_.below_clearance() + kLongest * operation_.tool.radius;
}

// Above the metal that stands along the way, and above `above`.
void FloorCutter::follow_over(const std::vector<Edge>& way,
                              double above,
                              const CutSettings& settings)
{
    FloorPathSettings laying = settings.laying;
    laying.nurbs = false;
    laying.even = true;
    const double metal = depth_ != nullptr ? depth_->highest(laid(way, laying))
                                           : settings.entry_heights(above).metal;
    laying.level = heights_over(std::max({metal, above, moves_.place().z})).metal;
    const FloorPath path = laid(way, laying);
    least_gap_ = std::min(least_gap_, path.least_gap);
    moves_.link(path);
}

// Straight to the start of the pass; false where a wall is in the way, or it is far.
bool FloorCutter::step_over(const Laid& laid_pass, const CutSettings& settings)
{
    const Vec2d from = in_plan(moves_.place());
    const Edge way = line_edge(from, laid_pass.pass.path.front().start);
    const bool entered = way_down(settings.entry) == settings.entry;
    if ((laid_pass.pass.start == PassStart::kEntry && !entered) || !is_worth_it({way}) ||
        !is_free(walls_, way, settings.first - settings.laying.aside)) {
        return false;
    }
    follow_over({way}, laid_pass.path.start.z, settings);
    return true;
}

// As far as it is; false where there is no way.
bool FloorCutter::go_round(const Laid& laid_pass, const CutSettings& settings)
{
    if (!reach_) {
        reach_ = reach_of(walls_, settings.first);
    }
    const std::vector<Edge> way =
        way_within(*reach_, in_plan(moves_.place()), laid_pass.pass.path.front().start);
    if (way.empty()) {
        return false;
    }
    CutSettings nearer = settings;
    nearer.laying.aside = std::max(settings.laying.aside - kWrittenStep, kWrittenStep);
    follow_over(way, laid_pass.path.start.z, nearer);
    return true;
}

// From the end of one pass to the start of one before it: straight, or back along the links
// between.
void FloorCutter::go_back(const std::vector<ClearingPass>& passes,
                          std::size_t from,
                          std::size_t to,
                          const CutSettings& settings)
{
    const Edge straight = line_edge(passes[from].path.back().end, passes[to].path.front().start);
    std::vector<Edge> way;
    if (is_free(walls_, straight, settings.first - settings.laying.aside)) {
        way.push_back(straight);
    } else {
        for (std::size_t i = from; i > to; --i) {
            const std::vector<Edge> back = reversed(passes[i].link);
            way.insert(way.end(), back.begin(), back.end());
        }
    }
    if (is_worth_it(way)) {
        follow_over(way, -1e300, settings);
    }
}

// By its link, where the tool stands before that and it does not cut too deep, else by an entry.
void FloorCutter::begin(const Laid& laid_pass, const CutSettings& settings)
{
    const ClearingPass& pass = laid_pass.pass;
    const bool at_link = pass.start == PassStart::kLink && moves_.is_down() &&
                         distance(pass.link.front().start, in_plan(moves_.place())) < kSamePlace;
    const bool here =
        moves_.is_down() &&
        distance(in_plan(laid_pass.path.start), in_plan(moves_.place())) < kSamePlace &&
        moves_.place().z < laid_pass.path.start.z + kBarelyOver;
    if (!here && (!at_link || !link(laid_pass, settings))) {
        if (moves_.is_down() && !moves_.stands_over(laid_pass.path.start) &&
            !step_over(laid_pass, settings) && moves_.retracts() >= may_retract_) {
            go_round(laid_pass, settings);
        }
        enter(laid_pass, settings);
    }
    least_gap_ = std::min(least_gap_, laid_pass.path.least_gap);
    moves_.cut(laid_pass.path);
    feel();
}

void FloorCutter::feel()
{
    if (depth_ != nullptr) {
        depth_->feel(moves_.moves());
    }
}

// Cuts the pass at levels over itself, as low as the metal allows, until it is not too deep; open
// ones to and fro. Returns the pass as it is to be cut then, from the same path in plan.
FloorCutter::Laid FloorCutter::cut_above(const Laid& deep,
                                         const CutSettings& settings,
                                         bool repeated)
{
    constexpr int kMostCuts = 1000;
    ClearingPass flat = deep.pass;
    if (!repeated) {
        flat.path = flattened(flat.path, settings.laying.aside, settings.laying.spacing,
                              settings.laying.arcs);
    }
    Laid last = lay(flat, settings, true);
    CutSettings entering = settings;
    entering.laying.nurbs = false;
    double before = 1e300;
    for (int i = 0; i < kMostCuts; ++i) {
        const auto level = depth_->level_over(last.path, settings.depth_share);
        if (!level || *level > before - kWrittenStep) {
            break;
        }
        before = std::max(*level, settings.laying.level);
        entering.laying.level = before;
        entering.entry_heights = [highest = depth_->highest(last.path)](double pass) {
            return heights_over(std::max(highest, pass));
        };
        begin(lay(flat, entering, true), entering);
        entering.entry = way_down(settings.entry);
        if (is_open(flat)) {
            flat.path = reversed(flat.path);
            last = lay(flat, settings, true);
        }
    }
    return last;
}

void FloorCutter::cut_pass(ClearingPass& pass, const CutSettings& settings, bool repeated)
{
    Laid now = lay(pass, settings, repeated);
    if (lowest_of(now.path) >= settings.skip_above) {
        return;
    }
    feel();
    CutSettings entering = settings;
    if (too_deep(now.path, settings)) {
        now = cut_above(now, settings, repeated);
        entering.entry = way_down(settings.entry);
    }
    begin(now, entering);
    if (is_open(now.pass)) {
        pass.path = reversed(now.pass.path);
    }
}

// Its path as often as it is too deep, what comes last once.
void FloorCutter::cut_last(ClearingPass& pass, const CutSettings& settings, bool repeated)
{
    if (!pass.last.empty()) {
        feel();
        const Laid deep = lay(pass, settings, repeated);
        if (too_deep(deep.path, settings)) {
            cut_above(deep, settings, repeated);
        }
        pass.path = pass.last;
    }
    cut_pass(pass, settings, repeated);
}

// What roughing left beside these is cut level by level.
void FloorCutter::cut_standing(std::vector<ClearingPass>& passes, const CutSettings& settings)
{
    CutSettings over = settings;
    over.laying.nurbs = false;
    over.depth_share = 1.0;
    std::vector<double> lowest;
    for (const ClearingPass& pass : passes) {
        lowest.push_back(lowest_of(lay(pass, settings, true).path));
    }
    double above = settings.standing.top;
    std::size_t last = 0;
    for (const double level : settings.standing.heights) {
        over.laying.level = level;
        over.entry_heights = [above](double pass) {
            return heights_over(std::max(above, pass));
        };
        for (std::size_t i = 0; i < passes.size(); ++i) {
            if (lowest[i] < level - kWrittenStep) {
                if (last > i) {
                    go_back(passes, last, i, over);
                }
                cut_pass(passes[i], over, true);
                over.entry = way_down(settings.entry);
                last = i;
            }
        }
        above = level;
    }
    if (last > 0) {
        go_back(passes, last, 0, over);
    }
}

void FloorCutter::cut(const ClearedRegion& cleared, const CutSettings& settings)
{
    const std::size_t n = cleared.passes.size();
    const auto is_entry = [](const ClearingPass& pass) {
        return pass.start == PassStart::kEntry;
    };
    may_retract_ =
        settings.retracts - 1 -
        static_cast<int>(std::count_if(cleared.passes.begin(), cleared.passes.end(), is_entry));
    for (std::size_t first = 0, end = 0; first < n; first = end) {
        end = first + 1;
        may_retract_ += is_entry(cleared.passes[first]) ? 1 : 0;
        const bool standing = is_set(settings.standing.passes, first);
        while (standing && end < n && is_set(settings.standing.passes, end) &&
               cleared.passes[end].start == PassStart::kLink) {
            ++end;
        }
        const auto at = [&](std::size_t i) {
            return cleared.passes.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::vector<ClearingPass> passes{at(first), at(end)};
        if (standing) {
            cut_standing(passes, settings);
        }
        for (std::size_t i = first; i < end; ++i) {
            cut_last(passes[i - first], settings, is_set(settings.repeated, i));
        }
        if (settings.progress) {
            settings.progress(static_cast<double>(end) / static_cast<double>(n));
        }
    }
}

void FloorCutter::end()
{
    moves_.retract();
    feel();
}

}  // namespace cusp::host
