// Halves of equal size by x and y in turn, down to one place; a half with nothing left is not looked at.
#include "host_tools/geometry/toolpath/near_places.hpp"

#include <algorithm>
#include <numeric>

namespace cusp::toolpath {

namespace {

double along(Vec2d p, bool x) { return x ? p.x : p.y; }

}  // namespace

NearPlaces::NearPlaces(const std::vector<Vec2d>& places)
    : places_{places},
      order_(places.size()),
      position_(places.size()),
      left_(places.size()),
      taken_(places.size(), false)
{
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    divide({0, order_.size(), true});
    for (std::size_t k = 0; k < order_.size(); ++k) {
        position_[order_[k]] = k;
    }
}

void NearPlaces::divide(Range range)
{
    if (range.from == range.to) {
        return;
    }
    const auto at = [&](std::size_t k) {
        return order_.begin() + static_cast<std::ptrdiff_t>(k);
    };
    std::nth_element(at(range.from), at(range.middle()), at(range.to),
                     [&](std::size_t a, std::size_t b) {
                         return std::pair{along(places_[a], range.by_x), a} <
                                std::pair{along(places_[b], range.by_x), b};
                     });
    left_[range.middle()] = range.to - range.from;
    divide(range.half(true));
    divide(range.half(false));
}

void NearPlaces::take(std::size_t place)
{
    taken_[place] = true;
    const std::size_t position = position_[place];
    for (Range range{0, order_.size(), true};; range = range.half(position < range.middle())) {
        --left_[range.middle()];
        if (position == range.middle()) {
            return;
        }
    }
}

void NearPlaces::search(Range range, Vec2d p, std::size_t count, Found& found) const
{
    if (range.from == range.to || left_[range.middle()] == 0) {
        return;
    }
    const std::size_t place = order_[range.middle()];
    const double beyond = along(p, range.by_x) - along(places_[place], range.by_x);
    search(range.half(beyond <= 0), p, count, found);
    const std::pair<double, std::size_t> one{norm(places_[place] - p), place};
    if (!taken_[place] && (found.size() < count || one < found.back())) {
        if (found.size() == count) {
            found.pop_back();
        }
        found.insert(std::upper_bound(found.begin(), found.end(), one), one);
    }
    if (found.size() < count || std::fabs(beyond) <= found.back().first) {
        search(range.half(beyond > 0), p, count, found);
    }
}

std::vector<std::size_t> NearPlaces::nearest(Vec2d p, std::size_t count) const
{
    Found found;
    if (count > 0) {
        search({0, order_.size(), true}, p, count, found);
    }
    std::vector<std::size_t> out;
    for (const auto& [distance, place] : found) {
        out.push_back(place);
    }
    return out;
}

}  // namespace cusp::toolpath
