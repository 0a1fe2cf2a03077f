// A curve over u in the domain of a surface: an isocurve, or one whose v varies slowly.
#pragma once

#include <vector>

namespace cusp::adaptive_isocurve {

struct DomainCurve;

// A curve at some u: where it is and how it goes on.
struct CurvePlace {
    double v{};
    double slope{};                     // of v by u
    const DomainCurve* curve{nullptr};  // null: not known
};

// v over increasing u, at least two nodes; between nodes a cubic. Two nodes of equal v: an
// isocurve.
struct DomainCurve {
    int surface{};
    std::vector<double> u;
    std::vector<double> v;

    double v_at(double at) const;
    // v and its slope.
    CurvePlace place_at(double at) const;
};

// All curves that pass u, in order of v; the places know their curves.
std::vector<CurvePlace> places_at(const std::vector<DomainCurve>& curves, double u);

DomainCurve isocurve(int surface, double v, double u_begin, double u_end);

}  // namespace cusp::adaptive_isocurve
