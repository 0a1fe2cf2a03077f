// The runs are in plan; all moves but entries and rapid links are at the height.
#include "host_tools/cam/adaptive_clearing/adaptive_path_writer.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"

namespace cusp::adaptive_clearing {

using offset::Edge;
using offset::point_on;
using toolpath::ArcPlane;
using toolpath::kRapidClearance;
using toolpath::MoveKind;

namespace {

constexpr double kHelixSlope = 0.0524;  // 3 degrees
constexpr double kRaised = 0.2;         // mm: of rapid moves in swept ground

}  // namespace

void AdaptivePathWriter::write(const AdaptivePath& path, double above, double z)
{
    for (const AdaptiveRun& run : path.runs) {
        if (run.helix) {
            enter(*run.helix, top_at(run.helix->centre, above), z);
        } else if (run.link.empty()) {
            const Vec2d start = run.path.front().start;
            // Lower down the tool may meet slivers, so it descends at the plunge feed.
            writer_.approach(
                start, std::min(top_at(start, above) + kRapidClearance, writer_.clearance_z()));
            writer_.line(MoveKind::kPlunge, {start.x, start.y, z});
        }
        link(run.link, z);
        for (const Edge& edge : run.path) {
            cut(edge, z, std::min(run.tolerance, settings_.chord_tolerance));
        }
    }
    slivers_.add(path, writer_.tool_radius(), above);
}

double AdaptivePathWriter::top_at(Vec2d place, double above) const
{
    return slivers_.top_at(place, writer_.tool_radius(), above);
}

// Rapid legs run above the floor: beside them is nothing, and below only what a round end left.
void AdaptivePathWriter::link(const std::vector<LinkLeg>& legs, double z)
{
    const double raised = z + kRaised + settings_.scallops;
    const bool round = settings_.scallops > 0.0;
    for (std::size_t i = 0; i < legs.size(); ++i) {
        const bool goes_on = i + 1 < legs.size() && legs[i + 1].free;
        const Vec2d to = legs[i].end;
        if (!legs[i].free) {
            writer_.line(MoveKind::kLink, {to.x, to.y, goes_on && legs[i].may_rise ? raised : z});
            continue;
        }
        const Vec3d from = writer_.at();
        if (from.z < raised && round) {
            writer_.line(MoveKind::kRapid, {from.x, from.y, raised});
        } else if (from.z < raised && !goes_on) {
            writer_.line(MoveKind::kRapid, {0.5 * (from.x + to.x), 0.5 * (from.y + to.y), raised});
        }
        // The last of them comes down on its way.
        writer_.line(MoveKind::kRapid, {to.x, to.y, goes_on || round ? raised : z});
    }
}

void AdaptivePathWriter::enter(const EntryHelix& helix, double above, double z)
{
    const Vec2d c = helix.centre;
    const double r = helix.radius;
    const bool straight = r <= 0.0 || settings_.plunges;
    const Vec2d side[2] = {straight ? c : Vec2d{c.x + r, c.y}, {c.x - r, c.y}};
    writer_.approach(side[0], std::min(above + kRapidClearance, writer_.clearance_z()));
    ++entries_;
    writer_.line(MoveKind::kPlunge, {side[0].x, side[0].y, straight ? z : std::max(above, z)});
    if (straight) {
        plunges_ += above > z ? 1 : 0;
        return;
    }
    const double from = writer_.at().z;
    const double turns = (from - z) / (2 * kPi * r * kHelixSlope);
    // The half turn into the centre is half as long as one about it.
    const int halves = 2 * std::max(0, static_cast<int>(std::ceil(turns - 0.25)));
    const double drop = (from - z) / (halves + 0.5);
    for (int i = 1; i <= halves; ++i) {
        const Vec2d p = side[i % 2];
        const double at = from - drop * i;
        writer_.arc(MoveKind::kPlunge, {{p.x, p.y, at}, {c.x, c.y, at}, ArcPlane::kXY, false});
    }
    writer_.arc(MoveKind::kPlunge, {{c.x, c.y, z}, {c.x + 0.5 * r, c.y, z}, ArcPlane::kXY, false});
}

void AdaptivePathWriter::cut(const Edge& edge, double z, double tolerance)
{
    // Rounded to G-code's digits a short arc could close to a full circle.
    constexpr double kShortArc = 0.02;
    ++points_;
    if (edge.turn != 0 && settings_.arcs && norm(edge.end - edge.start) >= kShortArc) {
        writer_.arc(MoveKind::kCut, {{edge.end.x, edge.end.y, z},
                                     {edge.centre.x, edge.centre.y, z},
                                     ArcPlane::kXY,
                                     edge.turn < 0});
        return;
    }
    int n = 1;
    if (edge.turn != 0) {
        const double step = 2 * std::sqrt(2 * std::min(tolerance / edge.radius, 0.5));
        n = static_cast<int>(std::ceil(sweep(edge) / step));
    }
    for (int i = 1; i < n; ++i) {
        const Vec2d p = point_on(edge, static_cast<double>(i) / n);
        writer_.line(MoveKind::kCut, {p.x, p.y, z});
    }
    writer_.line(MoveKind::kCut, {edge.end.x, edge.end.y, z});
}

}  // namespace cusp::adaptive_clearing
