// Cells beside walls are found by distance. Valleys are found where the tip's slope turns up
// sharply from cell to cell, by dropping the tool on a finer grid around them.
#include "host_tools/cam/contour_pocket/uncut_regions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "host_tools/geometry/offset/offset.hpp"

namespace cusp::contour_pocket {

using drop_cutter::DropCutter;
using nurbs::Surface;
using offset::Box2d;
using offset::distance;
using offset::EdgeTree;
using offset::Region2d;
using offset::RegionOffset;
using toolpath::Tool;
using toolpath::ToolShape;

namespace {

constexpr double kMostUncutCells = 500.0;  // a side

// A needle: its CL height is the floor's height.
Tool needle() { return {1, ToolShape::kFlat, 1e-3, 0.0}; }

class UncutRegionSearch {
public:
    UncutRegionSearch(const RegionOffset& walls,
                      const Region2d& centres,
                      const std::vector<Surface>& floor,
                      const DropCutter& tips,
                      double wall_clearance)
        : walls_{walls},
          centres_{edges_of(centres)},
          tips_{tips},
          floor_{floor, needle(), 0.01 * tips.tool().radius},
          wall_clearance_{wall_clearance},
          radius_{tips.tool().radius},
          box_{box_of(walls.source())}
    {
        const double longest = std::max(box_.x1 - box_.x0, box_.y1 - box_.y0);
        cell_ = std::max(0.25 * radius_, longest / kMostUncutCells);
        columns_ = static_cast<int>((box_.x1 - box_.x0) / cell_) + 1;
        rows_ = static_cast<int>((box_.y1 - box_.y0) / cell_) + 1;
        rest_.assign(index(columns_, 0), 0.0);
        by_wall_.assign(rest_.size(), false);
        find_places();
    }

    std::vector<UncutRegion> run(const UncutSettings& settings)
    {
        find_uncut_at_walls(settings);
        if (settings.valleys) {
            find_valleys(settings.min_height);
        }
        std::vector<UncutRegion> places;
        for (int i = 0; i < columns_; ++i) {
            for (int j = 0; j < rows_; ++j) {
                if (rest_[index(i, j)] > 0.0) {
                    places.push_back(taken_place(i, j));
                }
            }
        }
        std::sort(places.begin(), places.end(),
                  [](const UncutRegion& a, const UncutRegion& b) { return a.volume > b.volume; });
        return places;
    }

private:
    std::size_t index(int i, int j) const
    {
        return static_cast<std::size_t>(i) * static_cast<std::size_t>(rows_) +
               static_cast<std::size_t>(j);
    }

    Vec2d centre(int i, int j) const
    {
        return {box_.x0 + cell_ * (i + 0.5), box_.y0 + cell_ * (j + 0.5)};
    }

    // Inside or outside changes only at a contour, and the distance from contours changes no faster
    // than the position: most cells follow from their neighbours.
    void find_places()
    {
        constexpr double kFarthest = 16.0;  // cells: limit of the search
        struct Room {
            double min_distance{0.0};
            double max_distance{kUnbounded};
        };
        const double near = 1.01 * cell_;
        places_.assign(rest_.size(), Place::kOutside);
        std::vector<Room> rooms(static_cast<std::size_t>(rows_));  // of the column before
        for (int i = 0; i < columns_; ++i) {
            bool inside = false;
            Room room;
            for (int j = 0; j < rows_; ++j) {
                Room& beside = rooms[static_cast<std::size_t>(j)];
                const Vec2d p = centre(i, j);
                room = {std::max(room.min_distance, beside.min_distance) - cell_,
                        std::min(room.max_distance, beside.max_distance) + cell_};
                if (room.min_distance < wall_clearance_ && room.max_distance >= wall_clearance_) {
                    const double farthest = wall_clearance_ + kFarthest * cell_;
                    room.min_distance = walls_.nearest(p, std::min(farthest, room.max_distance));
                    room.max_distance =
                        room.min_distance < farthest ? room.min_distance : kUnbounded;
                }
                beside = room;
                const bool at_wall = room.min_distance < wall_clearance_;
                if (j == 0 || (at_wall && room.min_distance < near) || near > wall_clearance_) {
                    inside = walls_.contains(p);
                }
                if (inside) {
                    places_[index(i, j)] = at_wall ? Place::kBeside : Place::kAllowed;
                }
            }
        }
    }

    void find_uncut_at_walls(const UncutSettings& settings)
    {
        for (int i = 0; i < columns_; ++i) {
            for (int j = 0; j < rows_; ++j) {
                const Vec2d p = centre(i, j);
                if (places_[index(i, j)] != Place::kBeside ||
                    centres_.any_nearer(p, wall_clearance_) || contains(settings.air, p)) {
                    continue;
                }
                const auto floor = floor_.drop(p);
                if (floor && settings.top - floor->z > settings.min_height) {
                    rest_[index(i, j)] = settings.top - floor->z;
                    by_wall_[index(i, j)] = true;
                }
            }
        }
    }

    // If contacts of neighbouring cells are twice as far apart as the cells, the tool does not
    // reach between them.
    void find_valleys(double min_height)
    {
        slopes_.assign(rest_.size(), std::nullopt);
        for (int i = 0; i + 2 < columns_; i += 2) {
            for (int j = 0; j + 2 < rows_; j += 2) {
                if (turns_up(i, j, i + 2, j) || turns_up(i, j, i, j + 2)) {
                    search_around(i, j, min_height);
                }
            }
        }
    }

    bool turns_up(int i, int j, int k, int l)
    {
        if (places_[index(i, j)] != Place::kAllowed || places_[index(k, l)] != Place::kAllowed) {
            return false;
        }
        const Vec2d way = centre(k, l) - centre(i, j);
        const Vec2d turn = slope_at(k, l) - slope_at(i, j);
        return dot(turn, way) > 0.3 * dot(way, way) / radius_;
    }

    Vec2d slope_at(int i, int j)
    {
        auto& slope = slopes_[index(i, j)];
        if (!slope) {
            const auto cl = tips_.drop(centre(i, j), 0.01 * radius_);
            slope = cl ? cl->slope : Vec2d{};
        }
        return *slope;
    }

    void search_around(int i, int j, double min_height)
    {
        for (int k = std::max(0, i - 1); k <= std::min(columns_ - 1, i + 3); ++k) {
            for (int l = std::max(0, j - 1); l <= std::min(rows_ - 1, j + 3); ++l) {
                double& rest = rest_[index(k, l)];
                if (rest == 0.0 && places_[index(k, l)] != Place::kOutside) {
                    const double left = uncut_height(centre(k, l));
                    rest = left > min_height ? left : 0.0;
                }
            }
        }
    }

    // Height above the floor at p that remains below the tool at the best position on a grid of
    // half the cells.
    double uncut_height(Vec2d p)
    {
        const auto floor = floor_.drop(p);
        if (!floor) {
            return 0.0;
        }
        const double fine = 0.5 * cell_;
        const int reach = static_cast<int>(radius_ / fine);
        const int i = static_cast<int>((p.x - box_.x0) / fine);
        const int j = static_cast<int>((p.y - box_.y0) / fine);
        double best = kUnbounded;
        for (int k = std::max(0, i - reach); k <= std::min(2 * columns_ - 1, i + reach); ++k) {
            for (int l = std::max(0, j - reach); l <= std::min(2 * rows_ - 1, j + reach); ++l) {
                const Vec2d at{box_.x0 + fine * k, box_.y0 + fine * l};
                const double apart = distance(at, p);
                if (apart <= radius_) {
                    best = std::min(best, tip_at(k, l, at) + profile_height(tips_.tool(), apart));
                }
            }
        }
        return best < kUnbounded ? best - floor->z - 0.02 * radius_ : 0.0;
    }

    double tip_at(int k, int l, Vec2d at)
    {
        if (heights_.empty()) {
            heights_.resize(4 * rest_.size());
        }
        auto& height = heights_[static_cast<std::size_t>(k) * 2 * static_cast<std::size_t>(rows_) +
                                static_cast<std::size_t>(l)];
        if (!height) {
            height = walls_.clearance(at) < wall_clearance_ ? kUnbounded
                                                            : tips_.tip_height(at, 0.005 * radius_);
        }
        return *height;
    }

    // The connected cells around this one, removed from the grid.
    UncutRegion taken_place(int i, int j)
    {
        UncutRegion place;
        place.at_walls = by_wall_[index(i, j)];
        std::vector<std::array<int, 2>> stack{{i, j}};
        while (!stack.empty()) {
            const auto [k, l] = stack.back();
            stack.pop_back();
            if (k < 0 || l < 0 || k >= columns_ || l >= rows_) {
                continue;
            }
            const std::size_t here = index(k, l);
            if (rest_[here] <= 0.0 || by_wall_[here] != place.at_walls) {
                continue;
            }
            place.area += cell_ * cell_;
            place.volume += cell_ * cell_ * rest_[here];
            if (rest_[here] > place.height) {
                place.height = rest_[here];
                place.at = centre(k, l);
            }
            rest_[here] = 0.0;
            stack.insert(stack.end(), {{k + 1, l}, {k - 1, l}, {k, l + 1}, {k, l - 1}});
        }
        return place;
    }

    enum class Place : std::uint8_t { kOutside, kBeside, kAllowed };

    const RegionOffset& walls_;
    EdgeTree centres_;
    const DropCutter& tips_;
    DropCutter floor_;
    double wall_clearance_;
    double radius_;
    Box2d box_;
    double cell_{};
    int columns_{};
    int rows_{};
    std::vector<double> rest_;  // mm above the floor
    std::vector<bool> by_wall_;
    std::vector<Place> places_;
    std::vector<std::optional<Vec2d>> slopes_;
    std::vector<std::optional<double>> heights_;  // of the tip; kUnbounded if walls are too near
};

}  // namespace

std::vector<UncutRegion> uncut_regions(const RegionOffset& walls,
                                       const Region2d& centres,
                                       const std::vector<Surface>& floor,
                                       const DropCutter& tips,
                                       const UncutSettings& settings)
{
    return UncutRegionSearch{walls, centres, floor, tips, settings.wall_clearance}.run(settings);
}

}  // namespace cusp::contour_pocket
