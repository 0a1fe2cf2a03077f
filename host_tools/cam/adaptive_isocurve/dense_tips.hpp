// Dense tips along a curve, interpolated between few exact ones.
#pragma once

#include <functional>
#include <vector>

#include "host_tools/cam/adaptive_isocurve/domain_curve.hpp"
#include "host_tools/cam/finishing/gouge_free_path.hpp"

namespace cusp::adaptive_isocurve {

struct DenseTips {
    finishing::Points points;
    std::vector<double> u;
};

// Tips along a function of u as by `GougeFreePathFitter::sample`, most of them by quintic
// interpolation, accurate to a fiftieth of the band. The interpolation is checked at the middle
// between every two breaks; where it is not accurate, tips are exact.
//
// breaks  equally spaced
DenseTips dense_tips(const finishing::GougeFreePathFitter& path_fitter,
                     const std::function<Vec3d(double)>& at,
                     const std::vector<double>& breaks);

}  // namespace cusp::adaptive_isocurve
