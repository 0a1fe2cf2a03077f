// A lower bound of the clearance between a ball and a model while the ball's centre moves straight
// between two contacts on one smooth piece of surface.
//
// Proof, with centres c = x + d n over contacts x, n their normals, and y any point of the model:
// - Near points (y in the surroundings of x). (y - c)^2 = d^2 + (y - x)^2 - 2 d n . (y - x) is at
//   least d^2 + q(w). Here w is the difference of y and x in the domain, and q a quadratic form
//   from the bounds in `Surroundings`. One q serves both ends, and it must be nowhere negative. At
//   parameter t of the move from c to c', the squared distance is the mean of those at both ends,
//   less t (1 - t) (c' - c)^2. The mean of q(w) and q(w') is at least t (1 - t) q(w' - w), for any
//   y. So the distance of near points is at least the root of d^2 - ((c' - c)^2 - q(w' - w)) / 4.
// - The shank. For y higher than c this is the distance from the centre, not from the shank above.
//   The square of the latter is less by (y - c).z^2, and changes no faster along the move. The
//   means of both ends leave q(v), v the difference of y and the mean of x and x' in the domain. It
//   suffices that q(v) is at least the square of the height of y above the lower centre. For such
//   y, v is long, since (y - x).z is at most `climb` times the length of w.
// - Far points are excluded by boxes. The mean is least at the middle. So points far from both ends
//   have to be farther than d by (c' - c)^2 / (8 d). If the ends have different surroundings,
//   points near one end are at least d from it, and have to be farther from the other end by
//   (c' - c)^2 / (2 d).
// If this proves too little, the move is halved at the contact under its middle. Far points stay
// far from the whole move; they are checked again only if the middle has other surroundings.
#pragma once

#include <optional>

#include "host_tools/geometry/part_model/nearest_search.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"

namespace cusp::part_model {

class MoveClearanceBound {
public:
    MoveClearanceBound(const PartModel& model, const PartModel::State& state, double radius)
        : model_{model}, state_{state}, radius_{radius}
    {
    }

    std::optional<double> move_clearance(const CcPoint& a,
                                         const CcPoint& b,
                                         double sufficient) const;

private:
    using KnownContact = PartModel::State::KnownContact;
    // The pieces of surface that the two ends of a move lie in.
    struct Cells {
        const BezierCell& of_a;
        const BezierCell& of_b;
    };
    struct MiddleContact {
        KnownContact contact;
        double from_middle;  // mm, of its centre from the middle
    };

    std::optional<double> between(KnownContact& a,
                                  KnownContact& b,
                                  double sufficient,
                                  int depth) const;
    std::optional<double> near_between(
        KnownContact& a, KnownContact& b, const Cells& cells, double sufficient, int depth) const;
    std::optional<double> parts_between(KnownContact& a,
                                        MiddleContact& middle,
                                        KnownContact& b,
                                        const Cells* cells,
                                        double sufficient,
                                        int depth) const;
    std::optional<QuadraticForm> near_rise(const CcPoint& a,
                                           const BezierCell& cell_a,
                                           const CcPoint& b,
                                           const BezierCell& cell_b) const;
    std::optional<MiddleContact> contact_of_middle(const CcPoint& a, const CcPoint& b) const;
    // The largest cell at a contact whose bounds prove enough, with its surroundings known.
    const BezierCell& cell_of(KnownContact& contact) const;
    bool others_are_far(KnownContact& from, const BezierCell& cell, double margin) const;
    const BezierCell::NearPatches& find_patches(const CcPoint& from,
                                                const BezierCell& cell,
                                                double limit) const;
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
