// Move by move; in a lifted hole the height of the cycle's rapids is that above the stock.
#include "host_tools/cam/plan/lifted_path.hpp"

#include <algorithm>
#include <optional>

#include "host_tools/geometry/toolpath/peck_moves.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "host_tools/geometry/toolpath/toolpath_writer.hpp"

namespace cusp::plan {

using toolpath::end_of;
using toolpath::kRapidClearance;
using toolpath::MoveKind;
using toolpath::ToolMove;
using toolpath::Toolpath;
using toolpath::ToolpathWriter;
using verify::RapidInStock;

namespace {

bool is_over(Vec3d a, Vec3d b) { return a.x == b.x && a.y == b.y; }

class Lift {
public:
    Lift(const Toolpath& path, double clearance_z, std::vector<ToolMove>& moves)
        : path_{path}, clearance_z_{clearance_z}, writer_{moves, {clearance_z}}
    {
    }

    void keep(const ToolMove& move)
    {
        const Vec3d end = end_of(move);
        if (!is_over(end, writer_.at())) {
            above_.reset();
        }
        const bool is_cycles =
            above_ && move.kind == MoveKind::kRapid && path_.cycle && end.z == path_.cycle->above;
        if (is_cycles) {
            writer_.line(MoveKind::kRapid, {end.x, end.y, *above_});
        } else {
            writer_.add(move);
        }
    }

    void replace(Vec3d end, double end_depth)
    {
        if (!is_over(end, writer_.at())) {
            writer_.approach(in_plan(end), clearance_z_);
        }
        const double stock = end.z + end_depth;
        const double above = std::min(stock + kRapidClearance, clearance_z_);
        if (above < writer_.at().z) {
            writer_.line(MoveKind::kRapid, {end.x, end.y, end_depth > 0 ? above : end.z});
        }
        if (end_depth > 0 && path_.cycle) {
            above_ = above;
            const double peck = path_.cycle->peck > 0 ? path_.cycle->peck : kUnbounded;
            write_pecks({above, stock, end.z}, peck, writer_);
        } else if (end_depth > 0) {
            writer_.line(MoveKind::kPlunge, end);
        }
    }

private:
    const Toolpath& path_;
    double clearance_z_;
    ToolpathWriter writer_;
    std::optional<double> above_;  // z of the rapids of a lifted hole
};

}  // namespace

Toolpath lifted(const Toolpath& path, const std::vector<RapidInStock>& rapids, double clearance_z)
{
    Toolpath out = path;
    out.moves.clear();
    Lift lift{path, clearance_z, out.moves};
    auto next = rapids.begin();
    for (std::size_t k = 0; k < path.moves.size(); ++k) {
        if (next != rapids.end() && next->move == k) {
            lift.replace(end_of(path.moves[k]), next->end_depth);
            ++next;
        } else {
            lift.keep(path.moves[k]);
        }
    }
    return out;
}

}  // namespace cusp::plan
