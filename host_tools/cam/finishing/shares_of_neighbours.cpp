// A tree of medians, as that of the drop cutter's patches.
#include "host_tools/cam/finishing/shares_of_neighbours.hpp"

#include <algorithm>
#include <numeric>

namespace cusp::finishing {

namespace {

using Numbers = std::vector<std::size_t>;

void divide(const std::vector<Vec2d>& places,
            Numbers::iterator begin,
            Numbers::iterator end,
            std::size_t most,
            std::vector<Numbers>& out)
{
    if (most <= 1 || end - begin <= 1) {
        if (begin != end) {
            std::sort(begin, end);
            out.emplace_back(begin, end);
        }
        return;
    }
    const auto [left, right] = std::minmax_element(
        begin, end, [&](std::size_t a, std::size_t b) { return places[a].x < places[b].x; });
    const auto [front, back] = std::minmax_element(
        begin, end, [&](std::size_t a, std::size_t b) { return places[a].y < places[b].y; });
    const bool by_x = places[*right].x - places[*left].x > places[*back].y - places[*front].y;
    const auto at = [&](std::size_t k) {
        return by_x ? places[k].x : places[k].y;
    };
    const auto middle = begin + (end - begin) / 2;
    // Equal places by number: the shares do not depend on how the library orders them.
    std::nth_element(begin, middle, end, [&](std::size_t a, std::size_t b) {
        return at(a) < at(b) || (at(a) == at(b) && a < b);
    });
    divide(places, begin, middle, most / 2, out);
    divide(places, middle, end, most / 2, out);
}

}  // namespace

std::vector<std::vector<std::size_t>> shares_of_neighbours(const std::vector<Vec2d>& places,
                                                           std::size_t most)
{
    Numbers numbers(places.size());
    std::iota(numbers.begin(), numbers.end(), std::size_t{0});
    std::vector<Numbers> out;
    divide(places, numbers.begin(), numbers.end(), most, out);
    return out;
}

}  // namespace cusp::finishing
