// The zero of a falling function between two places.
//
//     const Bracket zero = bracketed_zero({0, 1}, {1e-13, 80}, [&](double share) { return slope(share); });
#pragma once

#include <cmath>

namespace cusp::part_model {

struct Bracket {
    double low;
    double high;
};

struct ZeroSearch {
    double near;          // width of a bracket that is narrow enough
    int rounds;           // at most
    int bisect_every{4};  // so many steps: converges for every function
    double zero{0};       // a value as small as that is none
};

// The narrowed bracket. Both ends are one place where the function is zero there, or where it has one sign
// from end to end. False position, with the weight of an end that stays halved (Illinois algorithm).
template <class Falling>
Bracket bracketed_zero(Bracket within, const ZeroSearch& search, const Falling& at)
{
    auto [low, high] = within;
    double at_low = at(low);
    double at_high = at(high);
    if (at_low <= 0) {
        return {low, low};
    }
    if (at_high >= 0) {
        return {high, high};
    }
    int stayed = 0;
    for (int k = 0; k < search.rounds && high - low > search.near; ++k) {
        const bool bisects = (k + 1) % search.bisect_every == 0;
        const double share = bisects ? 0.5 : at_low / (at_low - at_high);
        const double place = low + share * (high - low);
        const double here = at(place);
        if (std::abs(here) <= search.zero) {
            return {place, place};
        }
        if (here > 0) {
            low = place;
            at_low = here;
            at_high *= stayed > 0 ? 0.5 : 1;
            stayed = 1;
        } else {
            high = place;
            at_high = here;
            at_low *= stayed < 0 ? 0.5 : 1;
            stayed = -1;
        }
    }
    return {low, high};
}

}  // namespace cusp::part_model
