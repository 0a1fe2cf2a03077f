// Barrier: Newton's steps for the fastest law within a window of stations.
//
// The travel time plus mu times the sum of -log of all rows' slacks is made small over the
// coefficients of x = v^2. Each step keeps a part of every slack, so the law holds its limits after
// any number of them.
// Source: docs/numerics.md, "The time law". Held by tests/unit/planner/barrier_test.cpp.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/planner/station.hpp"

namespace cusp::planner {

inline constexpr std::uint32_t kStations = 64;    // that a law keeps at once
inline constexpr std::uint32_t kMostWindow = 56;  // coefficients that one step changes
inline constexpr std::uint32_t kLawAdvance = 16;  // that a window makes final

// A quadratic spline over stations. Cell k lies between the knots k and k + 1; the coefficients
// k, k + 1 and k + 2 act on it. Counters run freely: places are modulo kStations.
struct LawSpline {
    Station& station(std::uint32_t k) noexcept { return stations[k % kStations]; }
    const Station& station(std::uint32_t k) const noexcept { return stations[k % kStations]; }
    float& coefficient(std::uint32_t j) noexcept { return coefficients[j % kStations]; }
    float coefficient(std::uint32_t j) const noexcept { return coefficients[j % kStations]; }
    float& cap(std::uint32_t j) noexcept { return caps[j % kStations]; }
    float cap(std::uint32_t j) const noexcept { return caps[j % kStations]; }

    // Length of the cell on a side of knot k; the first and the last are mirrored.
    float length_before(std::uint32_t k) const noexcept
    {
        return k == 0 ? station(0).length : station(k - 1).length;
    }

    // At the start of cell k. At the end of the last cell stands a station with its length alone.
    SquaredSpeed at_start(std::uint32_t k) const noexcept;

    std::array<Station, kStations> stations;
    std::array<float, kStations> coefficients;  // mm^2/s^2
    std::array<float, kStations> caps;          // of the coefficients
    LaneVec ratio;                              // jerk over acceleration of each axis, 1/s
};

// The coefficients [begin, end) that a step changes. Where the stretch starts or ends, the
// coefficient beyond follows its neighbour by a factor: 0 where it does not.
struct LawWindow {
    std::uint32_t begin;
    std::uint32_t end;
    float start_factor;
    float end_factor;
    std::uint32_t first_cell() const noexcept { return begin < 2 ? 0 : begin - 2; }
    std::uint32_t end_cell() const noexcept { return end_factor > 0 ? end - 1 : end; }
};

// Sets the coefficients beyond the ends of the stretch after their neighbours.
void tie_ends(LawSpline& spline, const LawWindow& window) noexcept;

struct BarrierWeight {
    float rows;          // of the rows of acceleration and jerk
    float speed;         // of those of speed
    float time_hessian;  // part of the second derivative of the time that counts, in (0, 1]
    float time;          // of a second, 1/s
};

// One step. Precondition: every row holds, window.end - window.begin <= kMostWindow.
// Returns the greatest change of a coefficient that the window makes final, as a part of it.
// Context: main loop.
float newton_step(LawSpline& spline, const LawWindow& window, const BarrierWeight& weight) noexcept;

// Greatest share of a limit that a row of the window's cells uses: below 1 where all hold. 2 or more
// where a coefficient is above its cap.
float greatest_use(const LawSpline& spline, const LawWindow& window) noexcept;

}  // namespace cusp::planner
