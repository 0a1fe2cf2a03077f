// The tour is open: it does not return to its start.
#include "host_tools/prismatic/drill_tour.hpp"

#include <algorithm>

namespace cusp::prismatic {

namespace {

std::vector<std::size_t> nearest_next(const std::vector<Vec2d>& places, Vec2d at)
{
    std::vector<std::size_t> order;
    std::vector<bool> used(places.size(), false);
    for (std::size_t n = 0; n < places.size(); ++n) {
        std::size_t best = places.size();
        double least = kUnbounded;
        for (std::size_t k = 0; k < places.size(); ++k) {
            const double d = norm(places[k] - at);
            if (!used[k] && d < least) {
                least = d;
                best = k;
            }
        }
        used[best] = true;
        order.push_back(best);
        at = places[best];
    }
    return order;
}

}  // namespace

std::vector<std::size_t> short_tour(const std::vector<Vec2d>& places, Vec2d start)
{
    constexpr std::size_t kMost = 2000;
    constexpr double kGain = 1e-9;  // mm
    constexpr int kMostRounds = 50;
    std::vector<std::size_t> order = nearest_next(places, start);
    if (places.size() > kMost) {
        return order;
    }
    const auto place = [&](std::size_t n) {
        return places[order[n]];
    };
    bool shorter = true;
    for (int round = 0; shorter && round < kMostRounds; ++round) {
        shorter = false;
        for (std::size_t i = 0; i + 1 < order.size(); ++i) {
            const Vec2d before = i == 0 ? start : place(i - 1);
            for (std::size_t j = i + 1; j < order.size(); ++j) {
                const bool last = j + 1 == order.size();
                const double now =
                    norm(place(i) - before) + (last ? 0 : norm(place(j + 1) - place(j)));
                const double then =
                    norm(place(j) - before) + (last ? 0 : norm(place(j + 1) - place(i)));
                if (then < now - kGain) {
                    std::reverse(order.begin() + static_cast<std::ptrdiff_t>(i),
                                 order.begin() + static_cast<std::ptrdiff_t>(j) + 1);
                    shorter = true;
                }
            }
        }
    }
    return order;
}

}  // namespace cusp::prismatic
