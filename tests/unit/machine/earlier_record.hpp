// A record of settings as the firmware of layout 4 wrote it into its store, trailer and all, after
//
//   $110=5000 $793=2 $811=2 $832=0.1 $790=7 $14=5 $N1=G20 $I=OLD MILL G10L2P2X7 G10L1P3Z-4.5
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace cusp {

// Words, each with how often it comes.
inline constexpr std::array<std::pair<unsigned, std::uint32_t>, 61> kRecordOfLayout4{{
    {1, 0x40000000}, {1, 0x41C80000},  {5, 0x00000000},  {1, 0x40400000},  {1, 0x3C23D70A},
    {1, 0x3B03126F}, {5, 0x00000000},  {1, 0x41C80000},  {1, 0x43FA0000},  {1, 0x437A0000},
    {1, 0x3F800000}, {1, 0x46BB8000},  {2, 0x00000000},  {3, 0x44480000},  {1, 0x459C4000},
    {1, 0x45BB8000}, {1, 0x453B8000},  {2, 0x447A0000},  {1, 0x43FA0000},  {1, 0x43960000},
    {1, 0x43480000}, {1, 0x42A00000},  {1, 0x00000000},  {1, 0x40A00000},  {2, 0x00000000},
    {1, 0x40A00000}, {4, 0x00000000},  {1, 0x41F00000},  {1, 0x41C80000},  {1, 0x43480000},
    {1, 0x40A00000}, {1, 0x40200000},  {1, 0x41C80000},  {1, 0x40E00000},  {2, 0x00000000},
    {1, 0x40000000}, {1, 0x00000000},  {2, 0x47435000},  {1, 0x46C35000},  {1, 0x00000000},
    {1, 0x40000000}, {1, 0x00000000},  {3, 0x42200000},  {2, 0x3D4CCCCD},  {1, 0x3DCCCCCD},
    {6, 0x00000000}, {1, 0x0A990340},  {69, 0x00000000}, {1, 0xF92FEBA0},  {13, 0x00000000},
    {1, 0x00000004}, {21, 0x00000000}, {1, 0x00303247},  {19, 0x00000000}, {1, 0x4D444C4F},
    {1, 0x004C4C49}, {18, 0x00000000}, {1, 0x0000000A},  {1, 0x00000368},  {1, 0x534A2D09},
    {1, 0x43555304},
}};

inline std::vector<std::uint8_t> record_of_layout_4()
{
    std::vector<std::uint8_t> bytes;
    for (const auto& [count, word] : kRecordOfLayout4) {
        for (unsigned i = 0; i < 4 * count; ++i) {
            bytes.push_back(static_cast<std::uint8_t>(word >> i % 4 * 8));
        }
    }
    return bytes;
}

}  // namespace cusp
