// Triangles are halved across their longest side until one move covers each half, or none can.
#include "host_tools/cam/finishing/end_scallop_check.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/finishing/finish_area.hpp"
#include "host_tools/cam/finishing/scallop_at_point.hpp"
#include "host_tools/cam/finishing/walls_over_nothing.hpp"
#include "host_tools/geometry/part_model/facet_distance.hpp"

namespace cusp::finishing {

using part_model::Facet;
using part_model::PartModel;

namespace {

// Sizes of cells, in widths of what one move leaves low enough.
constexpr double kLargestTriangle = 3;
constexpr double kHiddenCell = 1;
constexpr double kTouchCell = 1;            // whether the tool may touch is asked from here on
constexpr double kUntouchedCell = 1.0 / 3;  // of ground that is kept as one that it can't touch
constexpr double kSmallestTriangle = 1.0 / 64;
constexpr int kTriangleHalvings = 60;
constexpr std::size_t kMostOpen = 300000;
constexpr std::size_t kFacetsAtOnce = 64;
constexpr std::size_t kMeasuredAtOnce = 512;
constexpr double kSharedTriangle = 64;  // larger facets are divided before they are shared
constexpr double kUprightFacet = 1e-9;

}  // namespace

// The cells of one side of a facet.
class EndScallopCheck::CellSearch {
public:
    CellSearch(const MeshGround& ground, Findings& found) : ground_{ground}, found_{found} {}

    void look_at(const Cell& cell)
    {
        side_ = ground_.side(cell.normal);
        last_ = 0;
        look_at(cell.corners, kTriangleHalvings);
    }

private:
    void look_at(const Corners& corners, int depth)
    {
        if (found_.open.size() >= kMostOpen) {
            found_.overflowed = true;
            return;
        }
        const LongSide longest = longest_side(corners);
        const double size = longest.length / side_.fine;
        const Cell cell{corners, side_.normal};
        if (ground_.path_fitter().area().is_beyond(cell.middle(), longest.length, side_.normal,
                                                   0) ||
            (size <= kLargestTriangle && ground_.is_covered(side_, corners, last_)) ||
            (size <= kHiddenCell && is_hidden(cell))) {
            return;
        }
        if (size > kTouchCell || (depth > 0 && !settles(cell, size))) {
            for (const Corners& half : halves_of(corners, longest.side)) {
                look_at(half, depth - 1);
            }
        }
    }

    // True if the cell needs no halves: it is kept, or its middle is covered.
    bool settles(const Cell& cell, double size)
    {
        const bool smallest = size <= kSmallestTriangle;
        switch (ground_.blocked(side_, cell.corners)) {
            case PartModel::Blocked::kFree:
                if (!ground_.is_covered(side_, cell.middle(), kPlaceShare)) {
                    keep_open(cell);
                    return true;
                }
                return smallest;
            case PartModel::Blocked::kByOneFacet:
                if (smallest || size <= kUntouchedCell) {
                    found_.blocked.push_back(cell);
                    return true;
                }
                return false;
            case PartModel::Blocked::kHere:
                if (smallest && !ground_.is_covered(side_, cell.middle(), kPlaceShare)) {
                    found_.blocked.push_back(cell);
                }
                return smallest;
        }
        return true;
    }

    void keep_open(const Cell& cell)
    {
        if (side_.upright) {
            const std::optional<Vec3d> tip = ground_.touching_tip(side_, cell.middle());
            if (!tip || !ground_.rests(*tip)) {
                return;
            }
        }
        found_.open.push_back(cell);
    }

    bool is_hidden(const Cell& cell) const
    {
        return ground_.is_hidden(place_of(cell)) &&
               std::all_of(cell.corners.begin(), cell.corners.end(), [&](Vec3d corner) {
                   return ground_.is_hidden({corner, cell.normal});
               });
    }

    const MeshGround& ground_;
    Findings& found_;
    MeshGround::Side side_{};
    std::uint32_t last_{};
};

EndScallopCheck::EndScallopCheck(const std::vector<Corners>& triangles,
                                 const GougeFreePathFitter& path_fitter,
                                 double scallop,
                                 double path_off)
    : triangles_{triangles}, ground_{path_fitter, scallop, path_off}
{
}

// The sides of facets that a tool may touch from above, in parts that several threads may share.
std::vector<FacetCell> EndScallopCheck::sides() const
{
    std::vector<Cell> out;
    for (const Corners& corners : triangles_) {
        const Vec3d normal = Facet{corners}.normal;
        for (const Corners& part : parts_of(corners, kSharedTriangle * step())) {
            out.push_back({part, normal});
            if (normal.z < kUprightFacet) {
                out.push_back({part, -normal});
            }
        }
    }
    return out;
}

EndScallopCheck::Findings EndScallopCheck::look_at(const std::vector<Cell>& cells) const
{
    const std::size_t shares = (cells.size() + kFacetsAtOnce - 1) / kFacetsAtOnce;
    std::vector<Findings> found(shares);
    const PartModel& model = ground_.path_fitter().model();
    parallel::for_each(shares, [&](std::size_t share) {
        model.forget_queries();
        CellSearch search{ground_, found[share]};
        const std::size_t end = std::min(cells.size(), (share + 1) * kFacetsAtOnce);
        for (std::size_t k = share * kFacetsAtOnce; k < end; ++k) {
            search.look_at(cells[k]);
        }
    });
    model.forget_queries();
    Findings out;
    for (Findings& some : found) {
        out.overflowed =
            out.overflowed || some.overflowed || out.open.size() + some.open.size() > kMostOpen;
        if (!out.overflowed) {
            out.open.insert(out.open.end(), some.open.begin(), some.open.end());
        }
        out.blocked.insert(out.blocked.end(), some.blocked.begin(), some.blocked.end());
        some = {};
    }
    return out;
}

void EndScallopCheck::check()
{
    Findings found = look_at(sides());
    open_ = std::move(found.open);
    blocked_ = std::move(found.blocked);
    overflowed_ = found.overflowed;
    std::vector<WallFacet> walls;
    for (const Corners& corners : triangles_) {
        const Facet facet{corners};
        if (ground_.side(facet.normal).upright) {
            walls.push_back({{corners.begin(), corners.end()}, facet.normal});
        }
    }
    over_nothing_ = walls_over_nothing(walls, ground_.path_fitter());
}

MeshLeft EndScallopCheck::left() const
{
    double area = 0;
    for (const Cell& cell : blocked_) {
        area += area_of(cell.corners);
    }
    const auto measured = blocked_.empty() ? std::nullopt : std::optional{measured_};
    return {area, measured, open_.size(), overflowed_, most_left_, over_nothing_};
}

void EndScallopCheck::share_out(std::size_t count,
                                const std::function<void(const MeshCheck&, std::size_t)>& work)
{
    const PartModel& model = ground_.path_fitter().model();
    parallel::for_each(count, [&](std::size_t k) {
        model.forget_queries();
        work(*this, k);
    });
    model.forget_queries();
}

void EndScallopCheck::measure_left()
{
    std::vector<double> left(open_.size());
    parallel::for_each(open_.size(), [&](std::size_t k) {
        left[k] = ground_.missing_tip(place_of(open_[k])) ? ground_.left(open_[k].middle()) : -1;
    });
    std::vector<Cell> kept;
    for (std::size_t k = 0; k < left.size(); ++k) {
        if (left[k] >= 0) {
            kept.push_back(open_[k]);
            most_left_ = std::max(most_left_, left[k]);
        }
    }
    open_ = std::move(kept);
    std::vector<double> stays((blocked_.size() + kMeasuredAtOnce - 1) / kMeasuredAtOnce);
    parallel::for_each(stays.size(), [&](std::size_t share) {
        const std::size_t end = std::min(blocked_.size(), (share + 1) * kMeasuredAtOnce);
        for (std::size_t k = share * kMeasuredAtOnce; k < end; ++k) {
            stays[share] = std::max(stays[share], ground_.left(blocked_[k].middle(), stays[share]));
        }
    });
    for (const double some : stays) {
        measured_ = std::max(measured_, some);
    }
}

}  // namespace cusp::finishing
