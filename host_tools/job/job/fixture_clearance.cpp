// Steps along moves by the free distance to the fixtures (sphere tracing).
#include "host_tools/job/job/fixture_clearance.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

#include "fmt/format.h"

namespace cusp::job {

using toolpath::end_of;
using toolpath::LineTo;
using toolpath::MoveKind;
using toolpath::points_of;
using toolpath::ToolMove;
using toolpath::Toolpath;

namespace {

constexpr double kTouch = 1e-3;  // mm: also the chords of curves and the least step

const char* name_of_move(MoveKind kind)
{
    switch (kind) {
        case MoveKind::kRapid:
            return "a rapid move";
        case MoveKind::kPlunge:
            return "a plunge";
        case MoveKind::kLink:
            return "a link";
        case MoveKind::kCut:
        case MoveKind::kPlungingCut:
            break;
    }
    return "a cut";
}

std::optional<Vec3d> hit_on_line(const Fixture& fixture, double radius, Vec3d from, Vec3d to)
{
    const double length = norm(to - from);
    for (double way = 0;;) {
        const Vec3d tip = way < length ? from + (way / length) * (to - from) : to;
        const double free = distance_to(fixture, radius, tip);
        if (free < -kTouch) {
            return tip;
        }
        if (way >= length) {
            return std::nullopt;
        }
        way = std::min(length, way + std::max(free, kTouch));
    }
}

[[noreturn]] void refuse_hit(const Job& job,
                             const std::string& operation,
                             double radius,
                             const ToolMove& move,
                             const FixtureHit& hit)
{
    const Fixture& fixture = job.fixtures[hit.fixture];
    throw InputError(fmt::format(
        "{}: {}: {} at x {:.3f} y {:.3f} z {:.3f} mm would touch {}: the tool, {:g} mm wide, keeps "
        "{:g} mm off it",
        job.file, operation, name_of_move(move.kind), hit.tip.x, hit.tip.y, hit.tip.z, fixture.name,
        2 * radius, fixture.margin));
}

// Replaces links by moves over the fixtures.
void lead_over(const Job& job, Vec3d from, Vec3d to, std::vector<ToolMove>& moves)
{
    const double z = job.stock_top + job.clearance;
    moves.push_back({MoveKind::kRapid, LineTo{{from.x, from.y, z}}});
    moves.push_back({MoveKind::kRapid, LineTo{{to.x, to.y, z}}});
    moves.push_back({MoveKind::kPlunge, LineTo{to}});
}

}  // namespace

double distance_to(const Fixture& fixture, double tool_radius, Vec3d tip)
{
    const double grown = fixture.radius + fixture.margin + tool_radius;
    const double x = std::max(fixture.low.x - tip.x, tip.x - fixture.high.x);
    const double y = std::max(fixture.low.y - tip.y, tip.y - fixture.high.y);
    const bool beside = x > 0 || y > 0;
    const double body =
        beside ? elementary::hypot(std::max(x, 0.0), std::max(y, 0.0)) : std::max(x, y);
    return std::max(body - grown, tip.z - (fixture.top + fixture.margin));
}

std::optional<FixtureHit> fixture_hit(const Job& job,
                                      double tool_radius,
                                      Vec3d from,
                                      const ToolMove& move)
{
    for (std::size_t i = 0; i < job.fixtures.size(); ++i) {
        Vec3d at = from;
        for (const Vec3d p : points_of(move, from, kTouch)) {
            if (const auto tip = hit_on_line(job.fixtures[i], tool_radius, at, p)) {
                return FixtureHit{i, *tip};
            }
            at = p;
        }
    }
    return std::nullopt;
}

int keep_off_fixtures(const Job& job, const std::string& operation, Toolpath& path)
{
    if (job.fixtures.empty()) {
        return 0;
    }
    const double radius = path.tool.radius;
    std::vector<ToolMove> moves;
    int led_over = 0;
    // the first move is a rapid whose start is not known: over everything
    Vec3d at{0, 0, job.stock_top + job.clearance};
    if (!path.moves.empty()) {
        const Vec3d first = end_of(path.moves.front());
        at = {first.x, first.y, at.z};
    }
    for (std::size_t i = 0; i < path.moves.size();) {
        std::size_t end = i;
        std::optional<FixtureHit> hit;
        Vec3d to = at;
        do {
            const ToolMove& move = path.moves[end];
            hit = hit ? hit : fixture_hit(job, radius, to, move);
            if (hit && move.kind != MoveKind::kLink) {
                refuse_hit(job, operation, radius, move, *hit);
            }
            to = end_of(move);
            ++end;
        } while (end < path.moves.size() && path.moves[i].kind == MoveKind::kLink &&
                 path.moves[end].kind == MoveKind::kLink);
        if (hit) {
            lead_over(job, at, to, moves);
            ++led_over;
        } else {
            std::move(path.moves.begin() + static_cast<std::ptrdiff_t>(i),
                      path.moves.begin() + static_cast<std::ptrdiff_t>(end),
                      std::back_inserter(moves));
        }
        at = to;
        i = end;
    }
    path.moves = std::move(moves);
    return led_over;
}

}  // namespace cusp::job
