// One line for each kind.
#include "host_tools/job/part_info/feature_lines.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/input_error/counted.hpp"

#include "fmt/format.h"

namespace cusp::part_info {

using job::PartFeatures;
using job::PartHoles;
using job::PartPocket;

namespace {

constexpr std::size_t kMostFeatures = 40;

std::string hole_words(const PartHoles& holes)
{
    std::string text =
        fmt::format("{} of {} mm, {}", holes.places.size(), number(holes.diameter, 3),
                    holes.through ? "through" : number(holes.depth, 3) + " mm deep");
    text += holes.tip > 0 && !holes.through
                ? fmt::format(" and a tip of {} mm", number(holes.tip, 3))
                : "";
    text += fmt::format(", from z {}", number(holes.top, 3));
    if (holes.mouth) {
        text += holes.mouth->angle > 0
                    ? fmt::format(", countersunk to {} mm by {} degrees",
                                  number(holes.mouth->diameter, 3), number(holes.mouth->angle, 1))
                    : fmt::format(", counterbored {} mm, {} mm deep",
                                  number(holes.mouth->diameter, 3), number(holes.mouth->depth, 3));
    }
    return text + fmt::format(", {} x {} y {} mm", holes.places.size() == 1 ? "at" : "one at",
                              number(holes.places.front().x, 3), number(holes.places.front().y, 3));
}

std::string pocket_words(const PartPocket& pocket)
{
    return fmt::format("z {}: {} x {} mm, {}, at x {} y {} mm", number(pocket.z, 3),
                       number(pocket.size.x, 3), number(pocket.size.y, 3),
                       pocket.open ? "open at a side" : "closed", number(pocket.middle.x, 3),
                       number(pocket.middle.y, 3));
}

}  // namespace

std::string number(double value, int digits)
{
    std::string text = fmt::format("{:.{}f}", value, digits);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') {
        text.pop_back();
    }
    return text == "-0" ? "0" : text;
}

std::vector<std::pair<std::string, std::string>> feature_lines(const PartFeatures& features)
{
    std::vector<std::pair<std::string, std::string>> lines;
    const auto add = [&](const char* label, const auto& all, const auto& words) {
        for (std::size_t k = 0; k < all.size() && k < kMostFeatures; ++k) {
            lines.emplace_back(k == 0 ? label : "", words(all[k]));
        }
        if (all.size() > kMostFeatures) {
            lines.emplace_back(
                "", fmt::format("... and {} more (--stats lists all)", all.size() - kMostFeatures));
        }
    };
    add("levels", features.levels, [](const job::PartLevel& level) {
        return fmt::format("z {}: {} mm2", number(level.z, 3), number(level.area, 1));
    });
    add("pockets", features.pockets, pocket_words);
    add("round holes", features.holes, hole_words);
    if (features.closed_above > 0) {
        lines.emplace_back(features.holes.empty() ? "round holes" : "",
                           fmt::format("{} closed above", features.closed_above));
    }
    add("inner corners", features.corners, [](const job::PartCorners& corners) {
        return fmt::format("{} of radius {} mm", corners.count, number(corners.radius, 3));
    });
    add("fillets", features.fillets, [](const job::PartFillets& fillets) {
        return fmt::format("{} of radius {} mm, {}, {}{} mm long", fillets.count,
                           number(fillets.radius, 3), fillets.concave ? "concave" : "convex",
                           fillets.count > 1 ? "together " : "", number(fillets.length, 1));
    });
    return lines;
}

}  // namespace cusp::part_info
