// A curve over u in the domain of a surface: an isocurve, or one whose v varies slowly.
#pragma once

#include <vector>

namespace cusp::host {

// v over increasing u, at least two nodes; between nodes a cubic. Two nodes of equal v: an
// isocurve.
struct DomainCurve {
    int surface{};
    std::vector<double> u;
    std::vector<double> v;

    double v_at(double at) const;
};

DomainCurve isocurve(int surface, double v, double u_begin, double u_end);

}  // namespace cusp::host
