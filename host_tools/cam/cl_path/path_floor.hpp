// The floor under a path: the lowest heights of the tip, and the clearance of moves.
#pragma once

#include <algorithm>
#include <optional>

#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"

namespace cusp::cl_path {

// A view of a drop cutter, which must outlive it.
class PathFloor {
public:
    // The floor itself; paths have none beside it.
    PathFloor(const drop_cutter::DropCutter& cutter) : cutter_{&cutter} {}

    // A floor with an allowance along its normal. Beside it, paths go on at its lowest z.
    //
    // grown      of the tool, grown by the allowance on all sides
    // allowance  mm, >= 0
    PathFloor(const drop_cutter::DropCutter& grown, double allowance)
        : cutter_{&grown}, allowance_{allowance}, beside_{grown.lowest()}
    {
    }

    // Proves gouges up to `max_gouge` (mm) by the tool shrunk by that on all sides: the bound of a
    // deep gouge is accurate to a tenth only. If the shrunk tool is clear, the tool gouges no more.
    void set_shrunk(const drop_cutter::DropCutter& shrunk, double max_gouge)
    {
        shrunk_ = &shrunk;
        max_gouge_ = max_gouge;
    }

    // The tip's lowest position over a point; none where the floor ends and paths do.
    struct Lowest {
        double z;  // mm
        Vec2d slope;
    };
    std::optional<Lowest> drop(Vec2d at) const
    {
        if (const auto cl = cutter_->drop(at)) {
            return Lowest{cl->z + allowance_, cl->slope};
        }
        return beside_ ? std::optional{Lowest{*beside_, {}}} : std::nullopt;
    }

    // Lower bound of the clearance of a straight move; see DropCutter::move_clearance().
    double move_clearance(Vec3d a, Vec3d b, double margin = 0.0) const
    {
        const Vec3d down{0.0, 0.0, -allowance_};
        const double clear = cutter_->move_clearance(a + down, b + down, margin);
        if (shrunk_ == nullptr || clear >= -max_gouge_) {
            return clear;
        }
        const Vec3d up{0.0, 0.0, max_gouge_ - allowance_};
        return std::max(clear, shrunk_->move_clearance(a + up, b + up, margin) - max_gouge_);
    }

    const toolpath::Tool& tool() const { return cutter_->tool(); }

private:
    const drop_cutter::DropCutter* cutter_;
    const drop_cutter::DropCutter* shrunk_{};
    double allowance_{0.0};
    double max_gouge_{0.0};
    std::optional<double> beside_;
};

}  // namespace cusp::cl_path
