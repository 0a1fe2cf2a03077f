// Contacts of the last proofs first, then those of near facets, then drops.
#include "host_tools/cam/finishing/lower_position_proof.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "host_tools/geometry/part_model/grid_square.hpp"

namespace cusp::finishing {

using drop_cutter::HalfSphereCover;
using part_model::Facet;
using part_model::facet_distance;
using part_model::square_key;

namespace {

constexpr int kMostCaps = 48;  // then a search is quicker
constexpr int kMostDrops = 20;
constexpr std::size_t kMostBlocks = 100'000;  // 40 MB
constexpr double kLeastRise = 0.05;           // of a unit vector
constexpr double kLeastMargin = 1e-8;         // of a cap beyond the direction that it is to block
constexpr double kEnoughMargin = 0.1;         // the same: more is not looked for
constexpr double kRecentMargin = 0.03;        // the same, of the points of the last proofs
constexpr double kAside = 1e-4;               // mm
constexpr int kMostAside = 3;
// Shares of the way from the facet's point nearest to the point to that nearest to the ball.
constexpr double kSharesOfWay[] = {1, 0.5, 0.2, 0.06};

Vec3d unit(Vec3d a) { return a / norm(a); }

double square(double a) { return a * a; }

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
    const auto [at, is_new] = blocks_.try_emplace(square_key(i, j));
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

void LowerPositionProof::find_near(Vec3d point)
{
    const double side = static_cast<double>(kSide) * pitch_;
    const auto i = static_cast<std::int64_t>(std::floor(point.x / side));
    const auto j = static_cast<std::int64_t>(std::floor(point.y / side));
    if (near_block_ == square_key(i, j)) {
        return;
    }
    Block all;
    for (std::int64_t k = 0; k < 9; ++k) {
        const Block& some = block(i + k / 3 - 1, j + k % 3 - 1);
        all.insert(all.end(), some.begin(), some.end());
    }
    keep_distinct(all);
    near_.clear();
    for (const Facet* facet : all) {
        add_near(*facet);
    }
    near_block_ = square_key(i, j);
}

void LowerPositionProof::add_near(const Facet& facet)
{
    const std::array<Vec3d, 3>& at = facet.corners;
    const Vec3d middle = (at[0] + at[1] + at[2]) / 3.0;
    near_.push_back({&facet, middle,
                     std::max({norm(at[0] - middle), norm(at[1] - middle), norm(at[2] - middle)}),
                     std::max({at[0].z, at[1].z, at[2].z})});
}

LowerPositionProof::Contact LowerPositionProof::contact_at(Vec3d point,
                                                           Vec3d at,
                                                           Vec3d centre) const
{
    return drop_cutter::approach_block(at, point, centre, radius_, contact_radius_);
}

// The contact of a facet that reaches farthest beyond the direction of the ball.
void LowerPositionProof::try_facet(Near& near, Vec3d point, Vec3d centre, Contact& best) const
{
    const Vec3d off = centre - near.middle;
    const double reach = square(contact_radius_ + near.reach);
    if (square(off.x) + square(off.y) >= reach ||
        (dot(off, off) >= reach && near.top <= centre.z)) {
        return;
    }
    Vec3d at;
    const Facet& facet = *near.facet;
    if (facet_distance(profile_.core_at(centre.x, centre.y, centre.z), facet, at,
                       contact_radius_) >= contact_radius_) {
        if (near.top <= centre.z) {
            return;
        }
        const auto rest = part_model::drop_on_facet(facet, profile_, centre.x, centre.y, centre.z);
        if (!rest || rest->centre <= centre.z) {
            return;
        }
        at = rest->point;
    }
    if (near.foot_of != proof_) {
        near.foot_of = proof_;
        facet_distance(profile_.core_at(point.x, point.y, point.z), facet, near.foot);
    }
    for (const double share : kSharesOfWay) {
        const Contact contact = contact_at(point, near.foot + (at - near.foot) * share, centre);
        best = contact.margin > best.margin ? contact : best;
    }
}

// The contact that reaches farthest, of the points that blocked a ball in the last proofs.
LowerPositionProof::Contact LowerPositionProof::recent_contact(Vec3d point, Vec3d centre) const
{
    Contact best;
    for (std::size_t k = 0; k < recent_count_; ++k) {
        const Contact contact = contact_at(point, recent_[k], centre);
        best = contact.margin > best.margin ? contact : best;
    }
    return best;
}

void LowerPositionProof::keep(Vec3d at)
{
    if (std::find(recent_.begin(), recent_.begin() + recent_count_, at) ==
        recent_.begin() + recent_count_) {
        recent_[recent_next_] = at;
        recent_next_ = (recent_next_ + 1) % kRecent;
        recent_count_ = std::min(recent_count_ + 1, kRecent);
    }
}

// A contact of near facets that reaches far beyond the direction of the ball. What blocks one direction
// often blocks the next: it is tried first.
LowerPositionProof::Contact LowerPositionProof::near_contact(Vec3d point, Vec3d centre)
{
    Contact best = recent_contact(point, centre);
    if (best.margin >= kRecentMargin) {
        return best;
    }
    std::size_t of = 0;
    for (std::size_t k = 0; k < near_.size() && best.margin < kEnoughMargin; ++k) {
        const double before = best.margin;
        try_facet(near_[k], point, centre, best);
        of = best.margin > before ? k : of;
    }
    if (of > 0) {
        std::swap(near_[of], near_[of / 2]);
    }
    return best;
}

// The contact of a ball dropped at the direction's place, or beside it where that one hardly blocks: a
// ball against walls may rest on their tops as well as on the floor. kOne where none blocks the direction.
LowerPositionProof::Drop LowerPositionProof::dropped(Vec3d point, Vec3d centre)
{
    Vec3d at = centre;
    for (int k = 0; k < kMostAside; ++k) {
        const auto rest = path_fitter_.model().drop_ball(at.x, at.y, contact_radius_);
        if (!rest) {
            return {Verdict::kUnknown, {}};
        }
        if (rest->centre.z <= centre.z) {
            return {Verdict::kOne, {}};
        }
        if (std::none_of(near_.begin(), near_.end(),
                         [&](const Near& near) { return near.facet == rest->facet; })) {
            add_near(*rest->facet);
        }
        const Contact contact = contact_at(point, rest->point, centre);
        if (contact.margin > kLeastMargin) {
            return {Verdict::kNone, contact};
        }
        const Vec3d off{at.x - rest->point.x, at.y - rest->point.y, 0};
        at = at + off * (kAside / std::max(norm(off), kAside));
    }
    return {Verdict::kOne, {}};
}

LowerPositionProof::Verdict LowerPositionProof::verdict_over(Vec3d point, Vec3d centre)
{
    find_near(point);
    ++proof_;
    HalfSphereCover cover;
    const Vec3d towards = centre - point;
    std::optional<Vec3d> open =
        unit({towards.x, towards.y, std::max(towards.z, kLeastRise * norm(towards))});
    int drops = 0;
    for (int caps = 0; open && caps < kMostCaps; ++caps) {
        const Vec3d from = point + *open * radius_;
        Contact best = near_contact(point, from);
        if (best.margin <= kLeastMargin) {
            const Drop drop = dropped(point, from);
            if (drop.verdict != Verdict::kNone) {
                return drop.verdict;
            }
            best = drop.contact;
            ++drops;
        }
        if (drops > kMostDrops || !cover.add(best.cap)) {
            return Verdict::kUnknown;
        }
        keep(best.contact);
        open = cover.open();
    }
    return open ? Verdict::kUnknown : Verdict::kNone;
}

}  // namespace cusp::finishing
