// The public face of the drop cutter: each query is one of its state.
#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"

#include "host_tools/geometry/drop_cutter/drop_cutter_state.hpp"

namespace cusp::drop_cutter {

using nurbs::Surface;
using toolpath::Tool;

DropCutter::DropCutter(const std::vector<Surface>& surfaces, const Tool& tool, double accuracy)
    : tool_{tool}, state_{std::make_unique<State>(surfaces, tool, accuracy)}
{
}

DropCutter::DropCutter(const Tool& tool, std::unique_ptr<State> state)
    : tool_{tool}, state_{std::move(state)}
{
}

DropCutter DropCutter::for_thread() const
{
    return {tool_, std::make_unique<State>(*state_, State::ForThread{})};
}

DropCutter::~DropCutter() = default;
DropCutter::DropCutter(DropCutter&&) noexcept = default;
DropCutter& DropCutter::operator=(DropCutter&&) noexcept = default;

std::optional<DropCutter::ClPoint> DropCutter::drop(Vec2d at, double max_error) const
{
    return state_->drop(at, max_error);
}

double DropCutter::tip_height(Vec2d at, double max_error) const
{
    const std::optional<ClPoint> cl = state_->drop(at, max_error);
    return cl ? cl->z : -kUnbounded;
}

Vec2d DropCutter::cc_place(Vec2d at, const ClPoint& cl) const { return state_->cc_place(at, cl); }

void DropCutter::check_edge_gouges(double allowed) { state_->check_edge_gouges(allowed); }

double DropCutter::move_clearance(Vec3d a, Vec3d b, double margin) const
{
    return state_->move_clearance(a, b, margin);
}

bool DropCutter::covers(Vec2d at) const { return state_->covers(at); }

std::optional<DropCutter::CcPoint> DropCutter::cc_point(Vec2d at, double max_error) const
{
    return state_->cc_point(at, max_error);
}

std::optional<DropCutter::CcPoint> DropCutter::exact_cc_point(Vec2d at, double max_error) const
{
    return state_->exact_cc_point(at, max_error);
}

std::size_t DropCutter::halvings() const { return state_->halvings_; }
std::size_t DropCutter::kept_bytes() const { return state_->bytes_of_halves(); }
double DropCutter::lowest() const { return state_->floor_->lowest; }
double DropCutter::highest() const { return state_->floor_->highest; }

}  // namespace cusp::drop_cutter
