// Even stations along each edge, halved where the slope changes.
#include "host_tools/contour_pocket/station_row.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::host {

namespace {

constexpr double kClosest = 2e-3;  // mm between stations: they are not halved further
constexpr double kSmooth = 0.999;  // cosine of 2.6 degrees

// Both visits are to meet at one point: a corner micrometres beside the path's other visit would be
// no place that anyone could tell from it.
bool is_spur(const std::vector<Edge>& plan, std::size_t e)
{
    return e + 1 < plan.size() && plan[e].turn == 0 && plan[e + 1].turn == 0 &&
           distance(plan[e].start, plan[e + 1].end) < 1e-9;
}

class RowBuilder {
public:
    RowBuilder(const TipFloor* floor, const StationSpacing& spacing)
        : floor_{floor}, spacing_{spacing}
    {
    }

    StationRow run(const std::vector<Edge>& plan)
    {
        add(plan.front().start, 0.0);
        row_.corners.push_back(0);
        for (std::size_t e = 0; e < plan.size() && !row_.missing; ++e) {
            if (is_spur(plan, e) || (e > 1 && is_spur(plan, e - 2))) {
                row_.stations.back().exact = true;
            }
            along(plan[e]);
            const bool last = e + 1 == plan.size();
            if (last || dot(tangent_at_end(plan[e]), tangent_at_start(plan[e + 1])) < kSmooth) {
                row_.corners.push_back(row_.stations.size() - 1);
            }
        }
        return std::move(row_);
    }

private:
    Station look(Vec2d at, double bend)
    {
        if (floor_ == nullptr) {
            return {at, 0.0, {}, bend};
        }
        const TipFloor::Rest rest = floor_->drop(at);
        if (rest.height == TipFloor::kNothing) {
            row_.missing = at;
        }
        return {at, rest.height, rest.gradient, bend};
    }

    void add(Vec2d at, double bend) { row_.stations.push_back(look(at, bend)); }

    void along(const Edge& edge)
    {
        const double bend = edge.turn == 0 ? 0.0 : edge.turn / edge.radius;
        const double step = edge.turn == 0
                                ? spacing_.along
                                : std::min(spacing_.along, std::sqrt(edge.radius * spacing_.aside));
        const double whole = length(edge);
        const int n = std::max(1, static_cast<int>(std::ceil(whole / step)));
        for (int i = 1; i <= n && !row_.missing; ++i) {
            const double from = static_cast<double>(i - 1) / n;
            const double to = static_cast<double>(i) / n;
            Station next = look(i == n ? edge.end : point_on(edge, to), bend);
            halve(edge, whole, from, to, next);
            row_.stations.push_back(next);
        }
    }

    // Stations between the last one and `next`, shares `from` and `to` of the edge.
    void halve(const Edge& edge, double whole, double from, double to, Station& next)
    {
        const Station& last = row_.stations.back();
        const Vec2d step = next.at - last.at;
        const double hidden = 0.125 * std::abs(dot(next.gradient - last.gradient, step));
        const double by_slopes = 0.5 * dot(next.gradient + last.gradient, step);
        const double jump = std::abs(next.height - last.height - by_slopes);
        const bool even = hidden < 0.05 * spacing_.height && jump < 0.5 * spacing_.height;
        if (row_.missing || even) {
            return;
        }
        if ((to - from) * whole < kClosest) {
            // A cliff: no move may start to climb before it.
            const bool cliff = jump >= 0.5 * spacing_.height;
            row_.stations.back().exact = row_.stations.back().exact || cliff;
            next.exact = next.exact || cliff;
            return;
        }
        const double middle = 0.5 * (from + to);
        Station between = look(point_on(edge, middle), next.bend);
        halve(edge, whole, from, middle, between);
        row_.stations.push_back(between);
        halve(edge, whole, middle, to, next);
    }

    const TipFloor* floor_;
    const StationSpacing& spacing_;
    StationRow row_;
};

}  // namespace

StationRow stations_along(const std::vector<Edge>& plan,
                          const TipFloor* floor,
                          const StationSpacing& spacing)
{
    return RowBuilder{floor, spacing}.run(plan);
}

}  // namespace cusp::host
