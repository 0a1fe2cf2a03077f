// Certificate that no lower position of a ball exists over a point of a mesh. If the ball cannot
// touch the point there is usually none, and the certificate replaces the search for the lowest.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "host_tools/cam/finishing/gouge_free_path.hpp"
#include "host_tools/geometry/drop_cutter/approach_block.hpp"
#include "host_tools/geometry/part_model/facet_drop.hpp"

namespace cusp::finishing {

// A ball that cuts down to exactly a point has its centre on a half sphere around that point. A point of
// the mesh blocks a cap of directions: from these the ball, or its shank, would cut into it. Points of
// facets that a ball rests on when dropped on a grid, found when first needed, are taken until their
// caps cover the half sphere. From a direction that none of them blocks the ball is dropped.
//
// Not for use by two threads at once.
class LowerPositionProof {
public:
    // path_fitter  of passes over a mesh; must outlive this
    // pitch        mm, of the grid
    LowerPositionProof(const GougeFreePathFitter& path_fitter, double pitch);

    enum class Verdict : std::uint8_t { kNone, kOne, kUnknown };
    // True if a ball clear of the mesh passes through the point or straight below it. kNone is proved;
    // kOne too, of a ball within half a micrometre.
    //
    // centre  of a ball that passes a little above the point
    Verdict verdict_over(Vec3d point, Vec3d centre);

private:
    static constexpr std::int64_t kSide = 4;  // grid points in x and in y
    static constexpr std::size_t kRecent = 24;
    using Block = std::vector<const part_model::Facet*>;  // that the ball rests on there

    // A facet, and a ball round it.
    struct Near {
        const part_model::Facet* facet;
        Vec3d middle;
        double reach;  // mm: from the middle to the farthest corner
        double top;    // mm: the highest corner
        Vec3d foot{};  // nearest to the point of a proof
        std::uint64_t foot_of{0};
    };
    using Contact = drop_cutter::ApproachBlock;

    // kNone where it has a contact.
    struct Drop {
        Verdict verdict{Verdict::kNone};
        Contact contact{};
    };

    const Block& block(std::int64_t i, std::int64_t j);
    void find_near(Vec3d point);
    void add_near(const part_model::Facet& facet);
    Contact contact_at(Vec3d point, Vec3d at, Vec3d centre) const;
    Drop dropped(Vec3d point, Vec3d centre);
    void try_facet(Near& near, Vec3d point, Vec3d centre, Contact& best) const;
    Contact near_contact(Vec3d point, Vec3d centre);
    Contact recent_contact(Vec3d point, Vec3d centre) const;
    void keep(Vec3d at);

    const GougeFreePathFitter& path_fitter_;
    double pitch_;
    double radius_;
    double contact_radius_;  // mm: of the ball grown by the band's offset, which touches the model
    part_model::ToolProfile profile_;  // of that ball
    std::unordered_map<std::uint64_t, Block> blocks_;
    std::optional<std::uint64_t> near_block_;  // that the facets are near
    std::vector<Near> near_;
    std::uint64_t proof_{0};
    // Contacts of the last proofs, which usually block once more.
    std::array<Vec3d, kRecent> recent_;
    std::size_t recent_count_{0};
    std::size_t recent_next_{0};
};

}  // namespace cusp::finishing
