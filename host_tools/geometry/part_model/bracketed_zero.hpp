// The zero of a falling function between two places.
//
//     const Bracket zero = bracketed_zero({0, 1}, 1e-13, 80, [&](double share) { return slope(share); });
#pragma once

namespace cusp::part_model {

struct Bracket {
    double low;
    double high;
};

// A bracket at most `near` wide, or what `rounds` steps have left of it; both ends are one place where the
// function is zero there, or where it has one sign from end to end. False position, with the weight of an
// end that stays halved (Illinois algorithm); every fourth step bisects.
template <class Falling>
Bracket bracketed_zero(Bracket within, double near, int rounds, const Falling& at)
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
    for (int k = 0; k < rounds && high - low > near; ++k) {
        const double share = k % 4 == 3 ? 0.5 : at_low / (at_low - at_high);
        const double place = low + share * (high - low);
        const double here = at(place);
        if (here == 0) {
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
