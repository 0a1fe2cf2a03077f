// A ball's next height is first looked for on the line through the last two.
#include "host_tools/grid_pocket/grid_drop_cutter.hpp"

#include <utility>

#include "host_tools/offset/contour.hpp"

namespace cusp::grid_pocket {

using nurbs::Surface;
using offset::distance;
using part_model::PartModel;
using toolpath::Tool;

GridDropCutter::GridDropCutter(const std::vector<Surface>& surfaces,
                               std::shared_ptr<const PartModel> model,
                               const Tool& tool,
                               double accuracy)
    : model_{std::move(model)}, tool_{tool}, accuracy_{accuracy}
{
    // Distances tell nothing of how deep a flat end cuts, and its disc makes them slow to find.
    if (tool.corner_radius < tool.radius) {
        flat_end_ = std::make_shared<const FlatEndDropCutter>(surfaces, tool, accuracy);
    }
}

std::optional<double> GridDropCutter::height(Vec2d at) const
{
    if (flat_end_) {
        return flat_end_->height(at);
    }
    const std::optional<double> z = model_->drop_height(tool_, at.x, at.y, guess(at));
    if (!z) {
        last_.reset();
    }
    before_ = last_;
    if (z) {
        last_ = Known{at, *z};
    }
    return z;
}

std::optional<double> GridDropCutter::guess(Vec2d at) const
{
    if (!last_ || distance(at, last_->at) > tool_.radius) {
        return std::nullopt;
    }
    double z = last_->height;
    if (before_) {
        const Vec2d way = last_->at - before_->at;
        const double square = dot(way, way);
        if (square > 1e-18 && square < tool_.radius * tool_.radius) {
            z += (last_->height - before_->height) * dot(at - last_->at, way) / square;
        }
    }
    return z;
}

double GridDropCutter::move_clearance(Vec3d a, Vec3d b, double sufficient) const
{
    return flat_end_ ? flat_end_->move_clearance(a, b)
                     : model_->move_clearance(tool_, a, b, sufficient, 1e-6);
}

}  // namespace cusp::grid_pocket
