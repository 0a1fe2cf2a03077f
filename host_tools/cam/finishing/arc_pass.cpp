// Arcs from the firmware's segmenter, each proved free of gouges like any other move.
#include <algorithm>
#include <vector>

#include "firmware/segmenter/arc_fitter.hpp"
#include "host_tools/cam/finishing/gouge_free_path.hpp"
#include "host_tools/geometry/toolpath/arc_geometry.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

namespace cusp::finishing {

using toolpath::ArcPlane;
using toolpath::ArcTo;
using toolpath::LineTo;
using toolpath::MoveKind;
using toolpath::ToolMove;

namespace {

constexpr double kFitShare = 0.8;         // of the band: the fitter adds a tenth between points
constexpr double kChordShare = 0.05;      // of the band: between an arc and the chords proved
constexpr std::size_t kMostLines = 1000;  // replaced by one move

ArcPlane plane_of(path::Plane plane)
{
    switch (plane) {
        case path::Plane::kXY:
            return ArcPlane::kXY;
        case path::Plane::kZX:
            return ArcPlane::kZX;
        case path::Plane::kYZ:
            break;
    }
    return ArcPlane::kYZ;
}

ToolMove arc_move(Vec3d start, const segmenter::FittedMove& fitted)
{
    const ArcPlane plane = plane_of(fitted.plane);
    const auto axes = axes_of(plane);
    Vec3d centre = start;
    centre[axes[0]] += fitted.first_offset;
    centre[axes[1]] += fitted.second_offset;
    return {MoveKind::kCut, ArcTo{fitted.end, centre, plane, fitted.clockwise}};
}

}  // namespace

bool GougeFreePathFitter::is_arc_clear(Vec3d start, const ToolMove& arc)
{
    const double off = kChordShare * band_.half_width;
    double least = least_clearance_;
    for (const Vec3d& next : points_of(arc, start, off)) {
        const double sufficient = off - band_.max_gouge;
        const double bound = model_.move_clearance(tool_, start, next, sufficient,
                                                   std::max(1e-6, 0.02 * band_.half_width));
        if (bound < sufficient - 1e-9) {
            return false;
        }
        least = std::min(least, bound - off);
        start = next;
    }
    least_clearance_ = least;
    return true;
}

std::vector<ToolMove> GougeFreePathFitter::fit_arcs(const Points& dense)
{
    segmenter::FitSettings settings;
    settings.left = settings.right = kFitShare * band_.half_width;
    std::vector<Vec3d> room(std::min(kMostLines, dense.size()) + 4);
    segmenter::ArcFitter fitter{settings, {room.data(), room.size()}};
    std::vector<ToolMove> out;
    Vec3d at = dense.front();
    std::size_t done = 0;
    const auto take = [&](const segmenter::FittedMove& fitted) {
        const std::size_t first = done;
        done += fitted.lines;
        const ToolMove arc = arc_move(at, fitted);
        if (fitted.is_arc && norm(at - dense[first]) == 0 && is_arc_clear(at, arc)) {
            out.push_back(arc);
            at = fitted.end;
            return;
        }
        Points section{at};
        section.insert(section.end(), dense.begin() + static_cast<std::ptrdiff_t>(first) + 1,
                       dense.begin() + static_cast<std::ptrdiff_t>(done) + 1);
        const Points lines = fit_lines(section);
        for (std::size_t k = norm(lines.front() - at) > 0 ? 0 : 1; k < lines.size(); ++k) {
            out.push_back({MoveKind::kCut, LineTo{lines[k]}});
        }
        at = lines.back();
    };
    segmenter::FittedMove fitted{};
    fitter.start(dense.front());
    for (std::size_t k = 1; k < dense.size(); ++k) {
        while (!fitter.has_room() && fitter.next(fitted)) {
            take(fitted);
        }
        fitter.push(dense[k]);
    }
    fitter.finish();
    while (fitter.next(fitted)) {
        take(fitted);
    }
    return out;
}

}  // namespace cusp::finishing
