// Parts of all directions that no contact bars are quartered; where one stays open the ball is let
// down from there, for the contact that is missing.
#include "host_tools/surface_passes/lower_ball.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/clearing/ball_directions.hpp"

namespace cusp::host {
namespace {

constexpr std::size_t kMostParts = 150;  // of the directions: the search that follows knows more
constexpr int kMostDrops = 3;
constexpr std::size_t kMostBlocks = 100'000;  // 40 MB
constexpr double kLeastRise = 0.05;           // of a unit vector

// Of the half sphere of vectors that do not point down.
std::array<BallDirections::Triangle, 8> fan(Vec3d towards)
{
    constexpr double kEighth = 0.70710678118654752;  // of a turn: its sine and cosine
    const double rise = std::max(towards.z, kLeastRise * norm(towards));
    const Vec3d raised{towards.x, towards.y, rise};
    std::array<BallDirections::Triangle, 8> out;
    Vec3d level{1, 0, 0};
    for (BallDirections::Triangle& part : out) {
        const Vec3d next{kEighth * (level.x - level.y), kEighth * (level.x + level.y), 0};
        part = {raised / norm(raised), level, next};
        level = next;
    }
    out.back()[2] = out.front()[1];
    return out;
}

}  // namespace

LowerBall::LowerBall(const CertifiedPasses& certified, double pitch)
    : certified_{certified},
      pitch_{pitch},
      radius_{certified.tool().radius},
      contact_radius_{certified.lifted_tool().radius}
{
}

const LowerBall::Block& LowerBall::block(std::int64_t i, std::int64_t j)
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
        const auto rest = certified_.model().rest_on_mesh(
            (static_cast<double>(i * kSide + k / kSide) + 0.5) * pitch_,
            (static_cast<double>(j * kSide + k % kSide) + 0.5) * pitch_, contact_radius_);
        if (rest && std::none_of(at->second.begin(), at->second.end(),
                                 [&](Vec3d known) { return alike(known, rest->point); })) {
            at->second.push_back(rest->point);
        }
    }
    return at->second;
}

LowerBall::Answer LowerBall::over(Vec3d point, Vec3d centre)
{
    const double side = static_cast<double>(kSide) * pitch_;
    const auto i = static_cast<std::int64_t>(std::floor(point.x / side));
    const auto j = static_cast<std::int64_t>(std::floor(point.y / side));
    BallDirections directions{point, radius_, contact_radius_};
    for (std::int64_t k = 0; k < 9; ++k) {
        for (const Vec3d& contact : block(i + k / 3 - 1, j + k % 3 - 1)) {
            directions.add(contact);
        }
    }
    const auto whole = fan(centre - point);
    std::vector<BallDirections::Triangle> open{whole.begin(), whole.end()};
    int drops = 0;
    for (std::size_t parts = 0; !open.empty(); ++parts) {
        const BallDirections::Triangle part = open.back();
        open.pop_back();
        if (directions.barring(part)) {
            continue;
        }
        if (parts > kMostParts) {
            return Answer::kUnknown;
        }
        const Vec3d middle = BallDirections::middle(part);
        if (!directions.barring({middle, middle, middle})) {
            const Vec3d from = directions.centre(middle);
            const auto rest = certified_.model().rest_on_mesh(from.x, from.y, contact_radius_);
            if (!rest || ++drops > kMostDrops) {
                return Answer::kUnknown;
            }
            if (rest->centre.z <= from.z) {
                return Answer::kOne;
            }
            directions.add(rest->point);
        }
        const auto quarters = BallDirections::quarters(part);
        open.insert(open.end(), quarters.begin(), quarters.end());
    }
    return Answer::kNone;
}

}  // namespace cusp::host
