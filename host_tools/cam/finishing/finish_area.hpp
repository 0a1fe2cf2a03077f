// The part of a model that an operation finishes: inside a loop of a drawing, outside islands, of a range
// of slopes and heights. What planes, levels and isocurves share, and the proofs of their scallops.
//
//     const FinishArea area{operation, 0.1};   // wider by 0.1 mm: passes end beyond it
//     area.holds(place, normal);               // a place of the model, its upward normal
#pragma once

#include <memory>
#include <vector>

#include "host_tools/geometry/offset/edge_tree.hpp"
#include "host_tools/job/job/finish_keys.hpp"

namespace cusp::finishing {

// Places count by where the surface is, not by where the tool's axis is: on a slope the tool goes beyond
// the boundary by up to its radius.
class FinishArea {
public:
    FinishArea() = default;  // all of the model
    // margin  mm, >= 0: by which loops and heights reach farther
    FinishArea(const job::Operation& operation, double margin);

    bool is_everything() const { return loops_.empty() && range_.is_everything(); }
    double margin() const { return margin_; }
    const job::GroundRange& range() const { return range_; }

    // normal  of the model at the place, unit, upward
    bool holds(Vec3d place, Vec3d normal) const;

    // True only if the area holds no place of a cell.
    //
    // reach  mm: of the cell around its middle
    // turn   most by which normals of the cell differ from `normal`
    bool is_beyond(Vec3d middle, double reach, Vec3d normal, double turn) const;

private:
    struct Loop {
        std::shared_ptr<const offset::EdgeTree> edges;
        bool outer;
    };

    std::vector<Loop> loops_;
    job::GroundRange range_;
    double margin_{};
};

}  // namespace cusp::finishing
