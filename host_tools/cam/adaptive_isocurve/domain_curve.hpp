// A curve in the domain of a surface, as v over u: an isocurve, or a curve of slowly varying v.
#pragma once

#include <vector>

namespace cusp::adaptive_isocurve {

struct DomainCurve;

// A curve at some u: its v and slope.
struct CurvePlace {
    double v{};
    double slope{};                     // of v by u
    const DomainCurve* curve{nullptr};  // null: not known
};

// v at increasing u: at least two nodes, with a cubic between them. Two nodes of equal v are an
// isocurve.
struct DomainCurve {
    int surface{};
    std::vector<double> u;
    std::vector<double> v;

    double v_at(double at) const;
    // v and its slope.
    CurvePlace place_at(double at) const;
};

// The places of all curves that pass u, in order of v, with their curves.
std::vector<CurvePlace> places_at(const std::vector<DomainCurve>& curves, double u);

DomainCurve isocurve(int surface, double v, double u_begin, double u_end);

}  // namespace cusp::adaptive_isocurve
