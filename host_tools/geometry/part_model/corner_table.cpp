// Open addressing in a table of a power of two.
#include "host_tools/geometry/part_model/corner_table.hpp"

#include <cstring>

namespace cusp::part_model {
namespace {

constexpr std::uint32_t kNone = 0xffffffffU;

std::size_t hash(Vec3d p)
{
    std::uint64_t sum = 0;
    for (const double value : {p.x, p.y, p.z}) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        sum = (sum ^ bits) * 0x9E3779B97F4A7C15U;
        sum ^= sum >> 29U;
    }
    return static_cast<std::size_t>(sum);
}

}  // namespace

CornerTable::CornerTable(std::size_t max_corners, std::vector<Vec3d>& corners) : corners_{corners}
{
    std::size_t size = 16;
    while (size < max_corners + max_corners / 3) {
        size *= 2;
    }
    table_.assign(size, kNone);
}

std::uint32_t CornerTable::number_of(Vec3d p)
{
    p = {p.x + 0.0, p.y + 0.0, p.z + 0.0};
    for (std::size_t at = hash(p);; ++at) {
        std::uint32_t& place = table_[at & (table_.size() - 1)];
        if (place == kNone) {
            place = static_cast<std::uint32_t>(corners_.size());
            corners_.push_back(p);
            return place;
        }
        const Vec3d& q = corners_[place];
        if (q.x == p.x && q.y == p.y && q.z == p.z) {
            return place;
        }
    }
}

}  // namespace cusp::part_model
