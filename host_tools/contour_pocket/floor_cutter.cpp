// One pass after the other; a pass left out breaks the link to the next.
#include "host_tools/contour_pocket/floor_cutter.hpp"

#include <algorithm>

#include "host_tools/contour_pocket/pocket_task.hpp"

namespace cusp::host {

namespace {

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

}  // namespace

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
    // A ramp round a pass that is hardly longer than a point would be a plunge.
    const bool helix = settings.entry == EntryKind::kHelix ||
                       (settings.entry == EntryKind::kAuto && round < 6.0 * tool) ||
                       (settings.entry == EntryKind::kRamp && round < 0.5 * tool);
    const bool lines = !laying.arcs && !laying.nurbs;
    laying.arcs = laying.nurbs = false;
    const FloorPath path = lines ? cut.path : laid(pass.path, laying);
    EntryHeights heights = settings.entry_heights(path.start.z);
    const Vec2d start = pass.path.front().start;
    const bool open = distance(start, pass.path.back().end) > 1e-9;
    if (depth_ != nullptr) {
        const EntryHeights over = heights_over(depth_->highest_at(start));
        // Open passes lie in metal that closed ones have cut.
        heights.metal = open ? over.metal : heights.metal;
        heights.raise_over(over);
    }
    const double around = helix ? metal_around(start, radius) : 0.0;
    // A helix reaches farther than the pass, where metal may stand that no pass has met.
    const bool shallow = depth_ == nullptr || around - path.start.z <= depth_->most();
    if (helix && radius > 0.2 * tool && shallow) {
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

// Cuts the pass at levels over itself, as low as the metal allows, until it is not too deep.
// Returns the pass as it is to be cut then, from the same path in plan.
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
    const Laid last = lay(flat, settings, true);
    CutSettings entering = settings;
    entering.entry = way_down(settings.entry);
    for (int i = 0; i < kMostCuts; ++i) {
        depth_->feel(moves_.moves());
        const auto level = depth_->level_over(last.path, settings.depth_share);
        if (!level || (i > 0 && *level > entering.laying.level - kWrittenStep)) {
            break;
        }
        entering.laying.level = std::max(*level, settings.laying.level);
        entering.laying.nurbs = false;
        entering.entry_heights = [highest = depth_->highest(last.path)](double pass) {
            return heights_over(std::max(highest, pass));
        };
        const Laid over = lay(flat, entering, true);
        if (i == 0) {
            moves_.retract();
        }
        enter(over, entering);
        least_gap_ = std::min(least_gap_, over.path.least_gap);
        moves_.cut(over.path);
    }
    return last;
}

void FloorCutter::cut(const ClearedRegion& cleared, const CutSettings& settings)
{
    bool cut_before = false;
    Vec2d last{};
    for (std::size_t i = 0; i < cleared.passes.size(); ++i) {
        const bool repeated = i < settings.repeated.size() && settings.repeated[i];
        Laid now = lay(cleared.passes[i], settings, repeated);
        if (lowest_of(now.path) >= settings.skip_above) {
            cut_before = false;
            continue;
        }
        if (depth_ != nullptr) {
            depth_->feel(moves_.moves());
        }
        const bool layered = too_deep(now.path, settings);
        if (layered) {
            now = cut_above(now, settings, repeated);
        }
        least_gap_ = std::min(least_gap_, now.path.least_gap);
        const ClearingPass& pass = now.pass;
        const bool beside =
            distance(pass.link.empty() ? Vec2d{} : pass.link.front().start, last) < 1e-6;
        const bool may_link = !layered && pass.start == PassStart::kLink && cut_before && beside;
        if (!may_link || !link(now, settings)) {
            if (!layered) {
                moves_.retract();
            }
            CutSettings entering = settings;
            entering.entry = layered ? way_down(settings.entry) : settings.entry;
            enter(now, entering);
        }
        moves_.cut(now.path);
        cut_before = true;
        last = pass.path.back().end;
    }
    moves_.retract();
    if (depth_ != nullptr) {
        depth_->feel(moves_.moves());
    }
}

}  // namespace cusp::host
