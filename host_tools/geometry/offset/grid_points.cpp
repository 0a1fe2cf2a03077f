// Vertices are found by cells somewhat wider than the distance at which points are the same.
#include "host_tools/geometry/offset/grid_points.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/offset/edge_runs.hpp"

namespace cusp::offset {

namespace {

constexpr std::uint32_t kNoVertex = UINT32_MAX;
constexpr int kCellBits = 5;  // a cell is 32 steps wide, 1.9e-6 mm

std::uint64_t key_of(std::int64_t x, std::int64_t y)
{
    return static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15U ^ static_cast<std::uint64_t>(y);
}

}  // namespace

GridPoints::GridPoints(const Box2d& box) : step_{std::ldexp(1.0, -24)}
{
    const double reach = std::max(std::max(std::abs(box.x0), std::abs(box.x1)),
                                  std::max(std::abs(box.y0), std::abs(box.y1)));
    while (reach < kUnbounded && reach > std::ldexp(step_, 38)) {
        step_ *= 2.0;
    }
}

// Different cells of one key only cost time.
template <class Visit>
void GridPoints::visit_cell(std::int64_t x, std::int64_t y, Visit visit) const
{
    const auto found = first_.find(key_of(x, y));
    for (std::uint32_t v = found == first_.end() ? kNoVertex : found->second; v != kNoVertex;
         v = next_[v]) {
        visit(v);
    }
}

std::uint32_t GridPoints::add(GridPoint point, Vec2d place)
{
    const auto vertex = static_cast<std::uint32_t>(points_.size());
    points_.push_back(point);
    places_.push_back(place);
    const auto found =
        first_.try_emplace(key_of(point.x >> kCellBits, point.y >> kCellBits), kNoVertex).first;
    next_.push_back(found->second);
    found->second = vertex;
    return vertex;
}

std::uint32_t GridPoints::near(Vec2d place)
{
    const GridPoint point{std::llround(place.x / step_), std::llround(place.y / step_)};
    std::uint32_t best = kNoVertex;
    double least = std::max(kSameVertex, step_);
    const auto reach = static_cast<std::int64_t>(least / step_) + 1;
    for (std::int64_t x = (point.x - reach) >> kCellBits; x <= (point.x + reach) >> kCellBits;
         ++x) {
        for (std::int64_t y = (point.y - reach) >> kCellBits; y <= (point.y + reach) >> kCellBits;
             ++y) {
            visit_cell(x, y, [&](std::uint32_t v) {
                const double apart = distance(places_[v], place);
                if (apart < least || (apart == least && v < best)) {
                    best = v;
                    least = apart;
                }
            });
        }
    }
    return best != kNoVertex ? best : add(point, place);
}

std::uint32_t GridPoints::at(GridPoint point)
{
    std::uint32_t found = kNoVertex;
    visit_cell(point.x >> kCellBits, point.y >> kCellBits,
               [&](std::uint32_t v) { found = points_[v] == point ? v : found; });
    return found != kNoVertex ? found
                              : add(point, {static_cast<double>(point.x) * step_,
                                            static_cast<double>(point.y) * step_});
}

}  // namespace cusp::offset
