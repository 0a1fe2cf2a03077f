// Directions that no contact blocks are divided. If one stays open, the ball is dropped from
// there to find the contact that is missing.
#include "host_tools/cam/finishing/lower_position_proof.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/drop_cutter/approach_directions.hpp"

namespace cusp::finishing {

using drop_cutter::ApproachDirections;

namespace {

constexpr std::size_t kMostParts = 150;  // of the directions; then a search is quicker
constexpr int kMostDrops = 3;
constexpr std::size_t kMostBlocks = 100'000;  // 40 MB
constexpr double kLeastRise = 0.05;           // of a unit vector

// Eight parts, around `towards`, of the half sphere of vectors that do not point down.
std::array<ApproachDirections::Triangle, 8> fan(Vec3d towards)
{
    constexpr double kEighth = 0.70710678118654752;  // of a turn: its sine and cosine
    const double rise = std::max(towards.z, kLeastRise * norm(towards));
    const Vec3d raised{towards.x, towards.y, rise};
    std::array<ApproachDirections::Triangle, 8> out;
    Vec3d horizontal{1, 0, 0};
    for (ApproachDirections::Triangle& part : out) {
        const Vec3d next{kEighth * (horizontal.x - horizontal.y),
                         kEighth * (horizontal.x + horizontal.y), 0};
        part = {raised / norm(raised), horizontal, next};
        horizontal = next;
    }
    out.back()[2] = out.front()[1];
    return out;
}

}  // namespace

LowerPositionProof::LowerPositionProof(const GougeFreePathFitter& path_fitter, double pitch)
    : path_fitter_{path_fitter},
      pitch_{pitch},
      radius_{path_fitter.tool().radius},
      contact_radius_{path_fitter.offset_tool().radius}
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
    const auto alike = [](Vec3d a, Vec3d b) {
        return a.x == b.x && a.y == b.y && a.z == b.z;
    };
    for (std::int64_t k = 0; k < kSide * kSide; ++k) {
        const auto rest = path_fitter_.model().drop_ball(
            (static_cast<double>(i * kSide + k / kSide) + 0.5) * pitch_,
            (static_cast<double>(j * kSide + k % kSide) + 0.5) * pitch_, contact_radius_);
        if (rest && std::none_of(at->second.begin(), at->second.end(),
                                 [&](Vec3d known) { return alike(known, rest->point); })) {
            at->second.push_back(rest->point);
        }
    }
    return at->second;
}

LowerPositionProof::Verdict LowerPositionProof::verdict_over(Vec3d point, Vec3d centre)
{
    const double side = static_cast<double>(kSide) * pitch_;
    const auto i = static_cast<std::int64_t>(std::floor(point.x / side));
    const auto j = static_cast<std::int64_t>(std::floor(point.y / side));
    ApproachDirections directions{point, radius_, contact_radius_};
    for (std::int64_t k = 0; k < 9; ++k) {
        for (const Vec3d& contact : block(i + k / 3 - 1, j + k % 3 - 1)) {
            directions.add(contact);
        }
    }
    const auto whole = fan(centre - point);
    std::vector<ApproachDirections::Triangle> open{whole.begin(), whole.end()};
    int drops = 0;
    for (std::size_t parts = 0; !open.empty(); ++parts) {
        const ApproachDirections::Triangle part = open.back();
        open.pop_back();
        if (directions.blocking(part)) {
            continue;
        }
        if (parts > kMostParts) {
            return Verdict::kUnknown;
        }
        const Vec3d middle = ApproachDirections::middle(part);
        if (!directions.blocking({middle, middle, middle})) {
            const Vec3d from = directions.centre(middle);
            const auto rest = path_fitter_.model().drop_ball(from.x, from.y, contact_radius_);
            if (!rest || ++drops > kMostDrops) {
                return Verdict::kUnknown;
            }
            if (rest->centre.z <= from.z) {
                return Verdict::kOne;
            }
            directions.add(rest->point);
        }
        const auto quarters = ApproachDirections::quarters(part);
        open.insert(open.end(), quarters.begin(), quarters.end());
    }
    return Verdict::kNone;
}

}  // namespace cusp::finishing
