// A ball that rolls over one smooth piece of a model: how far it keeps from all of the model while
// its centre moves straight between two contacts.
//
// Proof, with centres c = x + d n over contacts x, n their normals, and y any place of the model:
// - Near (y in the surroundings of x): (y - c)^2 = d^2 + (y - x)^2 - 2 d n . (y - x), which is at
//   least d^2 + q(w), w what lies between x and y in the domain, q a quadratic form from the bounds
//   in `Surroundings`; q is made one for both ends, and must be nowhere negative. On the way from c
//   to c', at the share t, the square of the distance is the mean of both ends' less
//   t (1 - t) (c' - c)^2; and the mean of q(w) and q(w') is at least t (1 - t) q(w' - w), wherever
//   y is. So no near place comes nearer than the root of d^2 - ((c' - c)^2 - q(w' - w)) / 4.
//   For y higher than c that is the distance to the centre, not to the shank over it: the square
//   of that is less by (y - c).z^2, and a way changes it no faster than the other. The means of
//   both ends leave q(v), v what lies between y and the mean of x and x' in the domain: it is
//   enough if that is at least the square of what y is above the lower centre. So far above it v
//   is long, for (y - x).z is at most `climb` times the length of w.
// - All else is looked at in boxes. What is far from both ends has to be farther than d by
//   (c' - c)^2 / (8 d), for the least of the mean is at the middle. Where the ends have different
//   surroundings, what is near one of them is at least d from that and has to be farther from the
//   other by (c' - c)^2 / (2 d).
// Where this proves too little the way is halved at the contact under its middle; all else stays
// far from the whole way, and is looked at again only where the middle is in other surroundings.
#pragma once

#include <optional>

#include "host_tools/part_model/nearest_search.hpp"
#include "host_tools/part_model/part_model.hpp"

namespace cusp::part_model {

class MoveClearanceBound {
public:
    MoveClearanceBound(const PartModel& model, const PartModel::State& state, double radius)
        : model_{model}, state_{state}, radius_{radius}
    {
    }

    std::optional<double> move_clearance(const CcPoint& a,
                                         const CcPoint& b,
                                         double sufficient) const
    {
        return between(a, b, sufficient, 0);
    }

private:
    // The pieces of surface that the two ends of a way lie in.
    struct Cells {
        const BezierCell& of_a;
        const BezierCell& of_b;
    };
    struct MiddleContact {
        CcPoint contact;
        double off;  // mm, of its centre from the middle
    };

    std::optional<double> between(const CcPoint& a,
                                  const CcPoint& b,
                                  double sufficient,
                                  int depth) const;
    std::optional<double> near_between(
        const CcPoint& a, const CcPoint& b, const Cells& cells, double sufficient, int depth) const;
    std::optional<double> parts_between(const CcPoint& a,
                                        const MiddleContact& foot,
                                        const CcPoint& b,
                                        const Cells* cells,
                                        double sufficient,
                                        int depth) const;
    std::optional<QuadraticForm> near_rise(const CcPoint& a,
                                           const BezierCell& cell_a,
                                           const CcPoint& b,
                                           const BezierCell& cell_b) const;
    std::optional<MiddleContact> contact_of_middle(const CcPoint& a, const CcPoint& b) const;
    // The largest piece that the bounds are good for, with its surroundings known.
    const BezierCell& cell_of(const CcPoint& at) const;
    bool others_are_far(const CcPoint& from, const BezierCell& cell, double margin) const;
    void find_patches(const CcPoint& from, const BezierCell& cell, double limit) const;
    bool cell_is_far(const BezierCell& cell,
                     const ToolCore& ball,
                     const CcPoint& from,
                     const BezierCell::Surroundings& near,
                     double limit) const;

    const PartModel& model_;
    const PartModel::State& state_;
    double radius_;
};

}  // namespace cusp::part_model
