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

}  // namespace

FloorPath FloorCutter::laid(const std::vector<Edge>& plan, const FloorPathSettings& laying)
{
    FloorPath path = lay_on_floor(plan, floor_, laying);
    if (!path.over_floor) {
        refuse_uncovered(operation_, path.missing);
    }
    return path;
}

void FloorCutter::enter(const ClearingPass& pass,
                        const FloorPath& cut,
                        const CutSettings& settings,
                        FloorPathSettings laying)
{
    const double tool = operation_.tool.radius;
    const double radius = std::min(0.6 * tool, pass.room - settings.first - 1e-3);
    const bool short_pass = length(pass.path) < 6.0 * tool;
    const bool helix =
        settings.entry == EntryKind::kHelix || (settings.entry == EntryKind::kAuto && short_pass);
    const bool lines = !laying.arcs && !laying.nurbs;
    laying.arcs = laying.nurbs = false;
    const FloorPath path = lines ? cut : laid(pass.path, laying);
    const EntryHeights heights = settings.entry_heights(path.start.z);
    if (helix && radius > 0.2 * tool) {
        moves_.enter_by_helix(
            path.start, radius, heights,
            [&](Vec2d at) { return std::max(floor_.drop(at).height + laying.raise, laying.level); },
            [&](Vec3d a, Vec3d b) { return floor_.gap(a, b); });
        return;
    }
    // Open passes lie in metal that closed ones have cut.
    const bool open = distance(pass.path.front().start, pass.path.back().end) > 1e-9;
    moves_.enter_along(path, heights, open || settings.entry == EntryKind::kPlunge);
}

void FloorCutter::cut(const ClearedRegion& cleared, const CutSettings& settings)
{
    bool cut_before = false;
    Vec2d last{};
    for (std::size_t i = 0; i < cleared.passes.size(); ++i) {
        const ClearingPass& pass = cleared.passes[i];
        FloorPathSettings laying = settings.laying;
        if (i < settings.repeated.size() && settings.repeated[i]) {
            laying.aside = repeated_aside(laying.aside);
        }
        const FloorPath path = laid(pass.path, laying);
        if (lowest_of(path) >= settings.skip_above) {
            cut_before = false;
            continue;
        }
        least_gap_ = std::min(least_gap_, path.least_gap);
        const bool beside =
            distance(pass.link.empty() ? Vec2d{} : pass.link.front().start, last) < 1e-6;
        if (pass.start == PassStart::kLink && cut_before && beside) {
            FloorPathSettings linking = settings.laying;
            linking.nurbs = false;
            linking.even = true;
            const FloorPath link = laid(pass.link, linking);
            least_gap_ = std::min(least_gap_, link.least_gap);
            moves_.link(link);
        } else {
            moves_.retract();
            enter(pass, path, settings, laying);
        }
        moves_.cut(path);
        cut_before = true;
        last = pass.path.back().end;
    }
    moves_.retract();
}

}  // namespace cusp::host
