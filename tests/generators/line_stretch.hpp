// Stretches of stations from stop to stop: a line along X.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "firmware/base/machine_limits.hpp"
#include "firmware/planner/station.hpp"

namespace cusp::test {

using planner::LaneDerivatives;
using planner::Station;
using planner::StopElement;

// Half the slope of v^2 that the element starts with, times its length: 2/3 x.
inline StopElement element_for(const Station& station, float cap)
{
    return {station.length / 0.55F, cap};
}

// A stretch of random stations with an element at either end.
struct Stretch {
    std::vector<Station> stations;
    StopElement start;
    StopElement stop;
};

// A line along X, stations of `dt` at the feed and closer near the ends.
inline Stretch line(const MachineLimits& limits, float length, float feed, float dt)
{
    const float time = 0.8F * limits.acceleration.x / limits.jerk.x;
    const float element = std::min(limits.jerk.x * time * time * time / 6.0F, length / 12.0F);
    const float cap = std::pow(4.5F * limits.jerk.x * element * element, 2.0F / 3.0F);
    Stretch made{{}, {element, cap}, {element, cap}};
    std::vector<float> rising;
    float at = element;
    for (;;) {
        const float h = std::min(0.55F * element + 0.2F * (at - element), dt * feed);
        if (at + h > 0.5F * length) {
            break;
        }
        rising.push_back(h);
        at += h;
    }
    std::vector<float> cells = rising;
    const float left = length - 2.0F * at;
    cells.push_back(0.5F * left);
    cells.push_back(0.5F * left);
    cells.insert(cells.end(), rising.rbegin(), rising.rend());
    for (const float h : cells) {
        Station station{};
        for (LaneDerivatives& place : station.places) {
            place.first = to_lanes(AxisVecf{1.0F / limits.jerk.x, 0.0F, 0.0F});
        }
        station.moving = to_lanes(AxisVecf{1.0F, 0.0F, 0.0F});
        station.length = h;
        station.cap = feed * feed;
        made.stations.push_back(station);
    }
    made.stations.back().acceleration_at_end = true;
    return made;
}

}  // namespace cusp::test
