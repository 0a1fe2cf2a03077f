// The runs are in plan; all moves but entries and rapid links are at the height.
#include "host_tools/adaptive_clearing/adaptive_path_writer.hpp"

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
            enter(*run.helix, above, z);
            continue;
        }
        const Vec2d start = run.path.front().start;
        if (run.link.empty()) {
            // Lower down the tool may meet slivers, so it descends at the plunge feed.
            writer_.approach(start, std::min(above + kRapidClearance, writer_.clearance_z()));
            writer_.line(MoveKind::kPlunge, {start.x, start.y, z});
        }
        for (std::size_t i = 0; i < run.link.size(); ++i) {
            // Rapid legs run above the floor.
            const bool raised =
                run.link[i].free || (i + 1 < run.link.size() && run.link[i + 1].free);
            const Vec2d to = run.link[i].end;
            writer_.line(run.link[i].free ? MoveKind::kRapid : MoveKind::kLink,
                         {to.x, to.y, raised ? z + kRaised + settings_.scallops : z});
        }
        for (const Edge& edge : run.path) {
            cut(edge, z, std::min(run.tolerance, settings_.chord_tolerance));
        }
    }
}

void AdaptivePathWriter::enter(const EntryHelix& helix, double above, double z)
{
    const Vec2d c = helix.centre;
    const Vec2d side[2] = {{c.x + helix.radius, c.y}, {c.x - helix.radius, c.y}};
    writer_.approach(side[0], std::min(above + kRapidClearance, writer_.clearance_z()));
    ++entries_;
    if (helix.radius <= 0.0 || settings_.plunges) {
        plunges_ += above > z ? 1 : 0;
        writer_.line(MoveKind::kPlunge, {side[0].x, side[0].y, z});
    } else {
        writer_.line(MoveKind::kPlunge, {side[0].x, side[0].y, std::max(above, z)});
    }
    if (helix.radius <= 0.0) {
        return;
    }
    const double from = writer_.at().z;
    const double turn = 2 * kPi * helix.radius * kHelixSlope;
    const int halves = 2 * static_cast<int>(std::ceil((from - z) / turn));
    // A level turn clears what the last slope left.
    for (int i = 1; i <= halves + 2; ++i) {
        const Vec2d p = side[i % 2];
        const double at = i < halves ? from + (z - from) * i / halves : z;
        writer_.arc(MoveKind::kPlunge, {{p.x, p.y, at}, {c.x, c.y, at}, ArcPlane::kXY, false});
    }
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
