// Directions that no facet blocks are divided. From one that stays open the ball is dropped, to find the
// facet that is missing.
#include "host_tools/cam/finishing/lower_position_proof.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace cusp::finishing {

using part_model::Facet;

namespace {

constexpr std::size_t kMostParts = 600;  // of the directions; then a search is quicker
constexpr int kMostDrops = 20;
constexpr std::size_t kMostBlocks = 100'000;  // 40 MB
constexpr double kLeastRise = 0.05;           // of a unit vector
constexpr double kLeastSide = 1e-5;           // rad, of a part

using Triangle = BlockingFacets::Triangle;
using Direction = BlockingFacets::Direction;

Vec3d unit(Vec3d a) { return a / norm(a); }

// Eight parts, around `towards`, of the half sphere of vectors that do not point down.
std::vector<Triangle> fan(Vec3d towards)
{
    constexpr double kEighth = 0.70710678118654752;  // of a turn: its sine and cosine
    const double rise = std::max(towards.z, kLeastRise * norm(towards));
    const Vec3d raised = unit({towards.x, towards.y, rise});
    std::vector<Triangle> out;
    Vec3d horizontal{1, 0, 0};
    for (int k = 0; k < 8; ++k) {
        const Vec3d next{kEighth * (horizontal.x - horizontal.y),
                         kEighth * (horizontal.x + horizontal.y), 0};
        out.push_back({Direction{raised}, Direction{horizontal}, Direction{next}});
        horizontal = next;
    }
    out.back()[2] = out.front()[1];
    return out;
}

double square(Vec3d a) { return dot(a, a); }

// The longest side, by the corner opposite to it, of those whose ends no facet blocks both; of all if one
// blocks the ends of each.
std::size_t side_to_divide(const Triangle& part)
{
    std::size_t best = 0;
    double longest = -1;
    bool apart = false;
    for (std::size_t k = 0; k < 3; ++k) {
        const Direction& a = part[(k + 1) % 3];
        const Direction& b = part[(k + 2) % 3];
        const bool is_apart = (a.by & b.by).none();
        const double length = square(a.along - b.along);
        if ((is_apart && !apart) || (is_apart == apart && length > longest)) {
            best = k;
            longest = length;
            apart = is_apart;
        }
    }
    return best;
}

// The order is that of the model's facets.
void keep_distinct(std::vector<const Facet*>& facets)
{
    std::sort(facets.begin(), facets.end(), std::less<>{});
    facets.erase(std::unique(facets.begin(), facets.end()), facets.end());
}

}  // namespace

LowerPositionProof::LowerPositionProof(const GougeFreePathFitter& path_fitter, double pitch)
    : path_fitter_{path_fitter},
      pitch_{pitch},
      radius_{path_fitter.tool().radius},
      contact_radius_{path_fitter.offset_tool().radius},
      profile_{path_fitter.offset_tool()}
{
}

const LowerPositionProof::Block& LowerPositionProof::block(std::int64_t i, std::int64_t j)
{
    if (blocks_.size() > kMostBlocks) {
        blocks_.clear();
    }
    const auto [at, is_new] = blocks_.try_emplace((static_cast<std::uint64_t>(i) << 32U) ^
                                                  (static_cast<std::uint64_t>(j) & 0xffffffffU));
    if (!is_new) {
        return at->second;
    }
    for (std::int64_t k = 0; k < kSide * kSide; ++k) {
        const auto rest = path_fitter_.model().drop_ball(
            (static_cast<double>(i * kSide + k / kSide) + 0.5) * pitch_,
            (static_cast<double>(j * kSide + k % kSide) + 0.5) * pitch_, contact_radius_);
        if (rest) {
            at->second.push_back(rest->facet);
        }
    }
    keep_distinct(at->second);
    return at->second;
}

LowerPositionProof::Block LowerPositionProof::facets_near(Vec3d point)
{
    const double side = static_cast<double>(kSide) * pitch_;
    const auto i = static_cast<std::int64_t>(std::floor(point.x / side));
    const auto j = static_cast<std::int64_t>(std::floor(point.y / side));
    Block out;
    for (std::int64_t k = 0; k < 9; ++k) {
        const Block& some = block(i + k / 3 - 1, j + k % 3 - 1);
        out.insert(out.end(), some.begin(), some.end());
    }
    keep_distinct(out);
    return out;
}

LowerPositionProof::Verdict LowerPositionProof::verdict_over(Vec3d point, Vec3d centre)
{
    BlockingFacets facets{point, radius_, profile_};
    for (const Facet* facet : facets_near(point)) {
        facets.add(*facet);
    }
    std::vector<Triangle> open = fan(centre - point);
    int drops = 0;
    for (std::size_t parts = 0; !open.empty(); ++parts) {
        Triangle part = open.back();
        open.pop_back();
        for (Direction& corner : part) {
            facets.ask(corner);
            if (corner.by.any()) {
                continue;
            }
            const Vec3d from = facets.centre(corner.along);
            const auto rest = path_fitter_.model().drop_ball(from.x, from.y, contact_radius_);
            if (!rest || ++drops > kMostDrops) {
                return Verdict::kUnknown;
            }
            if (rest->centre.z <= from.z) {
                return Verdict::kOne;
            }
            facets.add(*rest->facet);
            facets.ask(corner);
        }
        if (facets.block(part)) {
            continue;
        }
        const std::size_t apex = side_to_divide(part);
        const Direction& a = part[(apex + 1) % 3];
        const Direction& b = part[(apex + 2) % 3];
        if (parts > kMostParts || norm(a.along - b.along) < kLeastSide) {
            return Verdict::kUnknown;
        }
        Direction middle{unit(a.along + b.along)};
        facets.ask(middle);
        open.push_back({part[apex], a, middle});
        open.push_back({part[apex], middle, b});
    }
    return Verdict::kNone;
}

}  // namespace cusp::finishing
