// Objects of one polarity in a row are laid together at once.
#include "host_tools/job/import/gerber_plotter.hpp"

#include <utility>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/geometry/offset/region_overlay.hpp"

#include "fmt/format.h"

namespace cusp::import {

using offset::Contour;
using offset::Region2d;

namespace {

constexpr std::size_t kMostObjects = 1000000;
constexpr std::size_t kMostWays = 1000000;  // edges of one region
constexpr std::size_t kDeepestBlock = 16;

}  // namespace

void GerberPlotter::refuse(const std::string& what) const
{
    throw InputError(place_ + ": " + what);
}

void GerberPlotter::add(GerberObject object)
{
    if (objects_.size() >= kMostObjects) {
        refuse(fmt::format("more than {} objects", kMostObjects));
    }
    if (!object.region.contours.empty()) {
        objects_.push_back(std::move(object));
    }
}

void GerberPlotter::define(int code, Aperture aperture)
{
    apertures_[code] = {
        {{std::move(aperture.shape), true}}, aperture.diameter, std::move(aperture.corners)};
}

void GerberPlotter::select(int code)
{
    const auto found = apertures_.find(code);
    if (found == apertures_.end()) {
        refuse(fmt::format("aperture D{} is not defined", code));
    }
    aperture_ = &found->second;
}

PlaneMap GerberPlotter::stamp_map(Vec2d at) const
{
    const double c = elementary::cos(state_.turn) * state_.scale;
    const double s = elementary::sin(state_.turn) * state_.scale;
    return moved_by(at) * PlaneMap{{c, s}, {-s, c}, {}} *
           stretched_by(state_.mirror_x ? -1 : 1, state_.mirror_y ? -1 : 1);
}

// Clear flashes of a block swap what is dark and clear in it.
void GerberPlotter::flash(Vec2d at)
{
    if (aperture_ == nullptr) {
        refuse("a flash without an aperture");
    }
    const PlaneMap map = stamp_map(at);
    for (const GerberObject& object : aperture_->objects) {
        add({mapped(map, object.region), object.dark == state_.dark});
    }
}

void GerberPlotter::draw_line(Vec2d from, Vec2d to, const std::optional<CircularWay>& way)
{
    if (!way && norm(to - from) < offset::kSamePoint) {
        return;
    }
    const std::size_t first = repeat_ ? repeat_->first_line : 0;
    if (lines_.size() <= first ||
        norm(in_plan(lines_.back().curves.back().points.back()) - from) >= offset::kSamePoint) {
        lines_.emplace_back();
    }
    lines_.back().curves.push_back(way ? arc_curve(way->centre, way->radius, way->start, way->sweep)
                                       : line_curve(from, to));
}

void GerberPlotter::stroke(Vec2d from, Vec2d to, const std::optional<CircularWay>& way)
{
    if (aperture_ == nullptr) {
        refuse("a stroke without an aperture");
    }
    draw_line(from, to, way);
    const double radius = aperture_->diameter / 2 * state_.scale;
    if (radius > 0) {
        add({way ? thick_arc(*way, radius) : Region2d{{capsule_contour(from, to, radius)}},
             state_.dark});
    } else if (!aperture_->corners.empty() && !way) {
        std::vector<Vec2d> corners;
        const PlaneMap map = stamp_map({});
        for (const Vec2d corner : aperture_->corners) {
            corners.push_back(map.of(corner));
        }
        const Contour swept = swept_contour(corners, from, to);
        add({swept.empty() ? Region2d{} : Region2d{{swept}}, state_.dark});
    } else if (!aperture_->objects.empty() && !aperture_->objects.front().region.contours.empty()) {
        refuse("strokes are drawn by solid circles, straight ones by solid rectangles too");
    }
}

void GerberPlotter::add_edge(Vec2d from, Vec2d to, const std::optional<CircularWay>& way)
{
    if (contour_.size() >= kMostWays) {
        refuse(fmt::format("more than {} edges in a region", kMostWays));
    }
    if (way) {
        for (const offset::Edge& edge : arc_edges(*way)) {
            contour_.push_back(edge);
        }
        contour_.back().end = to;
    } else if (norm(to - from) > 0) {
        contour_.push_back(offset::line_edge(from, to));
    }
}

void GerberPlotter::end_contour()
{
    if (contour_.empty()) {
        return;
    }
    if (norm(contour_.back().end - contour_.front().start) > 0) {
        contour_.push_back(offset::line_edge(contour_.back().end, contour_.front().start));
    }
    add({{{offset::area(contour_) < 0 ? offset::reversed(contour_) : contour_}}, state_.dark});
    contour_.clear();
}

void GerberPlotter::end_region()
{
    end_contour();
    in_region_ = false;
}

void GerberPlotter::begin_block(int code)
{
    if (blocks_.size() >= kDeepestBlock) {
        refuse(fmt::format("blocks are nested more than {} deep", kDeepestBlock));
    }
    blocks_.push_back({code, 1, 1, {}, objects_.size(), lines_.size()});
}

void GerberPlotter::end_block()
{
    if (blocks_.empty()) {
        refuse("%AB*% ends a block aperture, but none has begun");
    }
    const Group block = blocks_.back();
    blocks_.pop_back();
    const auto first = objects_.begin() + static_cast<std::ptrdiff_t>(block.first);
    apertures_[block.code] = {{first, objects_.end()}, 0, {}};
    objects_.erase(first, objects_.end());
    lines_.resize(block.first_line);
}

void GerberPlotter::begin_repeat(int across, int up, Vec2d step)
{
    end_repeat();
    repeat_ = {0, across, up, step, objects_.size(), lines_.size()};
}

void GerberPlotter::end_repeat()
{
    if (!repeat_) {
        return;
    }
    const Group repeat = *repeat_;
    repeat_.reset();
    const std::size_t end = objects_.size();
    const std::size_t end_of_lines = lines_.size();
    for (int k = 1; k < repeat.across * repeat.up; ++k) {
        const PlaneMap map =
            moved_by({repeat.step.x * (k % repeat.across), repeat.step.y * (k / repeat.across)});
        for (std::size_t i = repeat.first; i < end; ++i) {
            add({mapped(map, objects_[i].region), objects_[i].dark});
        }
        for (std::size_t i = repeat.first_line; i < end_of_lines; ++i) {
            DrawingPath path = lines_[i];
            for (nurbs::Curve& curve : path.curves) {
                curve = map.of(std::move(curve));
            }
            lines_.push_back(std::move(path));
        }
    }
}

void GerberPlotter::end_file()
{
    if (!blocks_.empty()) {
        refuse("the block aperture does not end: %AB*% is missing");
    }
    end_repeat();
}

Region2d dark_region(const std::vector<GerberObject>& objects)
{
    Region2d dark;
    for (std::size_t k = 0; k < objects.size();) {
        Region2d group;
        const bool is_dark = objects[k].dark;
        for (; k < objects.size() && objects[k].dark == is_dark; ++k) {
            const auto& contours = objects[k].region.contours;
            group.contours.insert(group.contours.end(), contours.begin(), contours.end());
        }
        dark = is_dark ? offset::united(dark, group) : offset::without(dark, group);
    }
    return dark;
}

}  // namespace cusp::import
