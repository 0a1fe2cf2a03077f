// A ball that rolls over one smooth piece of a model: how far it keeps from all of the model while
// its centre moves straight between two contacts.
//
// Proof, with centres c = x + d n over contacts x, n their normals, and y any place of the model:
// - Near (y in the surroundings of x): (y - c)^2 = d^2 + (y - x)^2 - 2 d n . (y - x), which is at
//   least d^2 + (1 - d k) (y - x)^2, for k = `Surroundings::bend`. On the way from c to c', at the
//   share t, the square of the distance is the mean of both ends' less t (1 - t) (c' - c)^2; and
//   the mean of (y - x)^2 and (y - x')^2 is at least t (1 - t) (x' - x)^2, wherever y is. So no
//   near place comes nearer than the root of d^2 - ((c' - c)^2 - (1 - d k) (x' - x)^2) / 4.
// - All else is looked at in boxes: from both ends it is farther than d by (c' - c)^2 / (2 d),
//   which is more than enough for what lies between.
// Where this proves too little the way is halved at the contact under its middle.
#pragma once

#include <optional>

#include "host_tools/surface_offset/nearest_search.hpp"
#include "host_tools/surface_offset/surface_model.hpp"

namespace cusp::host {

class RollingBall {
public:
    RollingBall(const SurfaceModel& model, const SurfaceModel::State& state, double radius)
        : model_{model}, state_{state}, radius_{radius}
    {
    }

    std::optional<double> clearance(const Contact& a, const Contact& b, double enough) const
    {
        return between(a, b, enough, 0);
    }

private:
    std::optional<double> between(const Contact& a,
                                  const Contact& b,
                                  double enough,
                                  int depth) const;
    std::optional<double> halved(const Contact& a,
                                 const Contact& b,
                                 double enough,
                                 int depth) const;
    const BezierCell::Surroundings& surroundings(const Contact& at) const;
    bool rest_is_far(const Contact& from,
                     const BezierCell::Surroundings& near,
                     double margin) const;
    bool cell_is_far(const BezierCell& cell,
                     const ToolCore& ball,
                     const Contact& from,
                     const BezierCell::Surroundings& near,
                     double limit) const;

    const SurfaceModel& model_;
    const SurfaceModel::State& state_;
    double radius_;
};

}  // namespace cusp::host
