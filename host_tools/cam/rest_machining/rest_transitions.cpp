// A rapid goes down only where a tool a little larger is proven clear of the stock.
#include "host_tools/cam/rest_machining/rest_transitions.hpp"

#include <algorithm>
#include <array>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "host_tools/job/job/fixture_clearance.hpp"

namespace cusp::rest_machining {

using job::fixture_hit;
using job::Job;
using toolpath::end_of;
using toolpath::kRapidClearance;
using toolpath::LineTo;
using toolpath::MoveKind;
using toolpath::points_of;
using toolpath::Tool;
using toolpath::ToolMove;
using toolpath::Toolpath;

namespace {

constexpr double kFreeBeside = 0.1;   // mm: free beside a tool that descends by a rapid
constexpr double kTouch = 1e-3;       // mm: that a link may touch
constexpr double kOverGround = 0.02;  // mm
constexpr double kSecondsPerMinute = 60;
// Speeds of the controller's default machine, as in toolpath_measure.hpp.
constexpr double kRapidInPlan = 100;  // mm/s
constexpr double kRapidAxial = 50;
constexpr double kStop = 0.1;  // s

// The tool with room beside it.
ToolSweep descending(const Tool& tool, Vec3d tip)
{
    EndProfile end{tool};
    end.radius += kFreeBeside;
    end.flat += kFreeBeside;
    return {end, tip, tip};
}

}  // namespace

RestTransitions::RestTransitions(const SweptStock& stock,
                                 const Job& job,
                                 const Toolpath& path,
                                 const EndProfile& inner,
                                 std::vector<ToolMove>& moves)
    : stock_{stock},
      job_{job},
      path_{path},
      inner_{inner},
      writer_{moves, {job.stock_top + job.clearance, {}, path.tool.radius}},
      cut_{stock.top()}
{
}

double RestTransitions::seconds_over(Vec3d from, Vec3d to) const
{
    constexpr double kStops = 4;
    const double top = writer_.clearance_z();
    return (2 * top - from.z - to.z) / kRapidAxial +
           norm(in_plan(to) - in_plan(from)) / kRapidInPlan +
           kSecondsPerMinute * kRapidClearance / path_.plunge_feed + kStops * kStop;
}

bool RestTransitions::is_open_at_first(Vec2d place, double z) const
{
    return stock_.is_clear(descending(path_.tool, {place.x, place.y, z}));
}

bool RestTransitions::is_open(Vec2d place, double z) const
{
    if (is_open_at_first(place, z)) {
        return true;
    }
    if (cut_.sweeps() == 0) {
        return false;
    }
    const ToolSweep tool = descending(path_.tool, {place.x, place.y, z});
    SweptStock near{stock_.top()};
    near.add_near(cut_, tool.low(), tool.high());
    if (near.sweeps() == 0) {
        return false;
    }
    near.add_near(stock_, tool.low(), tool.high());
    return near.is_clear(tool);
}

bool RestTransitions::is_link_clear(Vec3d from, Vec3d to) const
{
    return stock_.is_clear({EndProfile{path_.tool, kTouch}, from, to});
}

// Only at its end the tool may touch stock by the tolerance, as it does at the place.
bool RestTransitions::is_way_in_clear(Vec3d beside, Vec3d place) const
{
    const double length = norm(place - beside);
    const double share = std::max(0.0, 1 - kFreeBeside / length);
    return stock_.is_clear({inner_, beside, place}) &&
           is_link_clear(beside, beside + share * (place - beside));
}

bool RestTransitions::keeps_off_fixtures(Vec2d place, double z) const
{
    const Vec3d from{place.x, place.y, writer_.clearance_z()};
    const ToolMove down{MoveKind::kRapid, LineTo{{place.x, place.y, z}}};
    return !fixture_hit(job_, path_.tool.radius, from, down);
}

// Beside the place, where the tool comes down in the open and goes to it through air.
std::optional<RestTransitions::Entry> RestTransitions::entry_beside(Vec3d place) const
{
    constexpr int kDirections = 16;
    for (const double share : {0.25, 0.6, 1.0}) {
        for (int i = 0; i < kDirections; ++i) {
            const double angle = 2 * kPi * i / kDirections;
            const Vec2d beside =
                in_plan(place) +
                Vec2d{elementary::cos(angle), elementary::sin(angle)} * (share * path_.tool.radius);
            if (is_open_at_first(beside, place.z + kOverGround) &&
                is_way_in_clear({beside.x, beside.y, place.z}, place) &&
                keeps_off_fixtures(beside, place.z)) {
                return Entry{beside, place.z + kRapidClearance};
            }
        }
    }
    return std::nullopt;
}

RestTransitions::Entry RestTransitions::entry_to(Vec3d place, bool at_rest_height) const
{
    const Vec2d here = in_plan(place);
    if (at_rest_height && is_open(here, place.z)) {
        return {here, place.z};
    }
    if (is_open(here, place.z + kOverGround)) {
        return {here, place.z + kRapidClearance};
    }
    if (!at_rest_height) {
        if (const auto beside = entry_beside(place)) {
            return *beside;
        }
    }
    for (double up = 0.5; place.z + up < stock_.top(); up *= 2) {
        if (is_open(here, place.z + up)) {
            return {here, place.z + up + kRapidClearance};
        }
    }
    return {here, stock_.top() + kRapidClearance};
}

void RestTransitions::go_to(Vec3d place, bool at_rest_height)
{
    if (writer_.started() && !writer_.is_retracted()) {
        const Vec3d at = writer_.at();
        const double link_s = kSecondsPerMinute * norm(place - at) / path_.feed + kStop;
        if (link_s < seconds_over(at, place) && is_link_clear(at, place)) {
            writer_.line(MoveKind::kLink, place);
            return;
        }
    }
    const Entry entry = entry_to(place, at_rest_height);
    writer_.approach(entry.place, std::min(entry.rapid_z, writer_.clearance_z()));
    writer_.line(MoveKind::kPlunge, {entry.place.x, entry.place.y, place.z});
    writer_.line(MoveKind::kLink, place);
}

void RestTransitions::cut(const std::vector<ToolMove>& moves)
{
    const EndProfile end{path_.tool, kTouch};
    for (const ToolMove& move : moves) {
        Vec3d at = writer_.at();
        writer_.add(move);
        for (const Vec3d p : points_of(move, at, kTouch)) {
            cut_.add(end, at, p);
            at = p;
        }
    }
}

}  // namespace cusp::rest_machining
