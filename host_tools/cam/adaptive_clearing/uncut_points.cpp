// Stock that stays between passes: a raster finds what is wide, the corners of discs what is thin.
#include <algorithm>
#include <cmath>
#include <vector>

#include "host_tools/cam/adaptive_clearing/swept_area.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::adaptive_clearing {

using offset::edges_of;
using offset::EdgeTree;
using offset::left_normal;
using offset::Region2d;

// Calls visit(place) for places in the cell where two discs meet, larger by `more` (mm), that no
// other such disc covers. Stock that stays between discs has a corner in one cell at least.
template <typename Visit>
void SweptArea::visit_corners(std::size_t cell, double more, Visit visit) const
{
    const Discs& discs = cells_[cell];
    const auto is_open = [&](Vec2d p, std::uint32_t a, std::uint32_t b) {
        return cell_at(p) == cell && std::none_of(discs.begin(), discs.end(), [&](std::uint32_t k) {
                   return k != a && k != b && norm(p - discs_[k].centre) <= discs_[k].radius + more;
               });
    };
    for (std::size_t i = 0; i < discs.size(); ++i) {
        for (std::size_t k = i + 1; k < discs.size(); ++k) {
            const Disc& a = discs_[discs[i]];
            const Disc& b = discs_[discs[k]];
            const Vec2d to = b.centre - a.centre;
            const double square = dot(to, to);
            const double from_a = (a.radius + more) * (a.radius + more);
            const double from_b = (b.radius + more) * (b.radius + more);
            const double along = 0.5 * (1.0 + (from_a - from_b) / square);
            const double aside = from_a / square - along * along;
            if (!(square > 0.0 && aside >= 0.0)) {
                continue;
            }
            for (const double side : {std::sqrt(aside), -std::sqrt(aside)}) {
                const Vec2d p = a.centre + to * along + left_normal(to) * side;
                if (is_open(p, discs[i], discs[k])) {
                    visit(p);
                }
            }
        }
    }
}

std::vector<Vec2d> SweptArea::uncut_points(const Region2d& region, double sliver) const
{
    constexpr int kFiner = 6;
    const EdgeTree tree{edges_of(region)};
    std::vector<Vec2d> result;
    for (int j = 0; j < rows_; ++j) {
        for (int i = 0; i < columns_; ++i) {
            const Vec2d first = corner_ + Vec2d{i + 0.0, j + 0.0} * pitch_;
            const Vec2d middle = first + Vec2d{0.5, 0.5} * pitch_;
            // A cell that no edge meets lies on one side.
            if (is_swept_[cell_at(middle)] != 0 ||
                (!tree.any_nearer(middle, pitch_) && !tree.surrounds(middle))) {
                continue;
            }
            visit_corners(cell_at(middle), sliver, [&](Vec2d p) {
                if (tree.surrounds(p)) {
                    result.push_back(p);
                }
            });
            for (int k = 0; k < kFiner * kFiner; ++k) {
                const Vec2d p =
                    first + Vec2d{k % kFiner + 0.5, k / kFiner + 0.5} * (pitch_ / kFiner);
                if (!contains(p) && tree.surrounds(p)) {
                    result.push_back(p);
                }
            }
        }
    }
    return result;
}

}  // namespace cusp::adaptive_clearing
