// Plan boxes swept by each operation; operations with disjoint boxes may change places.
#include "host_tools/geometry/toolpath/tool_order.hpp"

#include <algorithm>

#include "firmware/base/math.hpp"
#include "host_tools/geometry/toolpath/arc_geometry.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

namespace cusp::toolpath {
namespace {

// mm: beside each other, with room for the rounding of the program
constexpr double kApart = 0.01;

struct SweptBox {
    Vec2d low{kUnbounded, kUnbounded};
    Vec2d high{-kUnbounded, -kUnbounded};

    void add(Vec3d p, double reach)
    {
        low = {std::min(low.x, p.x - reach), std::min(low.y, p.y - reach)};
        high = {std::max(high.x, p.x + reach), std::max(high.y, p.y + reach)};
    }
    bool beside(const SweptBox& other) const
    {
        return low.x > other.high.x + kApart || other.low.x > high.x + kApart ||
               low.y > other.high.y + kApart || other.low.y > high.y + kApart;
    }
};

void add_move(SweptBox& box, Vec3d from, const ToolMove& move, double radius)
{
    box.add(from, radius);
    box.add(end_of(move), radius);
    if (const auto* arc = std::get_if<ArcTo>(&move.shape)) {
        const ArcShape shape = arc_shape(from, *arc);
        Vec3d centre = from;
        centre[shape.axes[0]] = shape.centre_first;
        centre[shape.axes[1]] = shape.centre_second;
        box.add(centre, radius + std::max(shape.start_radius, shape.end_radius));
    } else if (const auto* nurbs = std::get_if<NurbsTo>(&move.shape)) {
        for (const Vec3d& p : nurbs->curve.points) {
            box.add(p, radius);
        }
    }
}

SweptBox swept_box(const Toolpath& path, double clearance_z)
{
    SweptBox box;
    Vec3d at{0, 0, clearance_z};
    for (const ToolMove& move : path.moves) {
        const Vec3d end = end_of(move);
        if (move.kind != MoveKind::kRapid || end.z < clearance_z || at.z < clearance_z) {
            add_move(box, at, move, path.tool.radius);
        }
        at = end;
    }
    return box;
}

}  // namespace

std::vector<std::size_t> tool_order(const std::vector<PlannedOperation>& operations,
                                    double clearance_z)
{
    std::vector<SweptBox> boxes;
    std::vector<std::size_t> left;
    for (const PlannedOperation& operation : operations) {
        left.push_back(left.size());
        boxes.push_back(swept_box(operation.path, clearance_z));
    }
    std::vector<std::size_t> order;
    int tool = 0;
    while (!left.empty()) {
        const auto may_be_next = [&](std::size_t place) {
            return operations[left[place]].path.tool.number == tool &&
                   std::all_of(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(place),
                               [&](std::size_t before) {
                                   return boxes[before].beside(boxes[left[place]]);
                               });
        };
        std::size_t next = 0;
        for (std::size_t place = 0; place < left.size() && tool != 0; ++place) {
            if (may_be_next(place)) {
                next = place;
                break;
            }
        }
        order.push_back(left[next]);
        tool = operations[left[next]].path.tool.number;
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(next));
    }
    return order;
}

}  // namespace cusp::toolpath
