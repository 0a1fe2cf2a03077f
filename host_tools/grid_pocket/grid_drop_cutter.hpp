// How low a tool may stand over the floor: a ball by exact distances, a tool with a flat end by
// bounds.
#pragma once

#include <memory>
#include <optional>

#include "host_tools/grid_pocket/flat_end_drop_cutter.hpp"
#include "host_tools/part_model/part_model.hpp"

namespace cusp::grid_pocket {

// One tool over one floor. Questions about places near the ones before are answered several times
// faster.
class GridDropCutter {
public:
    // surfaces   the floor; its trims are honoured
    // model      of the same surfaces, shared by all balls
    // accuracy   mm, > 0: how much too high a flat end's answers may be (never too low)
    GridDropCutter(const std::vector<nurbs::Surface>& surfaces,
                   std::shared_ptr<const part_model::PartModel> model,
                   const toolpath::Tool& tool,
                   double accuracy);

    const toolpath::Tool& tool() const { return tool_; }

    // Height of the tip over (x, y); none where no surface lies under the tool.
    std::optional<double> height(Vec2d at) const;

    // Lower bound of the room that a straight move keeps, cut off at `sufficient` (mm, >= 0): along
    // the normal for a ball, along the axis for a flat end, for which anything above 0 is 0.
    double move_clearance(Vec3d a, Vec3d b, double sufficient) const;

    // How much too high an answer may be.
    double accuracy() const { return flat_end_ ? accuracy_ : 0.0; }
    double lowest() const { return model_->box_low().z; }

private:
    struct Known {
        Vec2d at;
        double height;
    };
    std::shared_ptr<const part_model::PartModel> model_;
    toolpath::Tool tool_;
    double accuracy_;
    std::shared_ptr<const FlatEndDropCutter> flat_end_;  // none for a ball
    // The last two answers of a ball: the next one is mostly on a line with them.
    mutable std::optional<Known> last_;
    mutable std::optional<Known> before_;

    std::optional<double> guess(Vec2d at) const;
};

}  // namespace cusp::grid_pocket
