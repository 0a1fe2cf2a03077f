// A level above the bottom meets a slope where the slope has reached that level.
#include "host_tools/cam/prismatic/tab_places.hpp"

namespace cusp::prismatic {

using job::Tabs;

namespace {

constexpr double kRun = 2.0;  // of a ramped tab's slope, over its height

}  // namespace

double half_of_tab(const Tabs& tabs, double tool_radius)
{
    return tabs.width / 2 + tool_radius + (tabs.ramped ? kRun * tabs.height : 0.0);
}

std::vector<TabStretch> tab_stretches(const Tabs& tabs,
                                      const std::vector<double>& middles,
                                      double tool_radius)
{
    std::vector<TabStretch> out;
    const double full = tabs.width / 2 + tool_radius;
    const double half = half_of_tab(tabs, tool_radius);
    for (const double middle : middles) {
        out.push_back({middle - half, middle - full, middle + full, middle + half});
    }
    return out;
}

std::vector<HeightStretch> heights_over_tabs(
    const std::vector<TabStretch>& tabs, double length, double z, double bottom, double full)
{
    std::vector<HeightStretch> out;
    double at = 0;
    for (const TabStretch& tab : tabs) {
        if (z >= full) {
            break;
        }
        const double share = (z - bottom) / (full - bottom);
        const double begin = tab.rise_begin + share * (tab.full_begin - tab.rise_begin);
        const double end = tab.rise_end - share * (tab.rise_end - tab.full_end);
        out.push_back({at, begin, z, z});
        out.push_back({begin, tab.full_begin, z, full});
        out.push_back({tab.full_begin, tab.full_end, full, full});
        out.push_back({tab.full_end, end, full, z});
        at = end;
    }
    out.push_back({at, length, z, z});
    return out;
}

}  // namespace cusp::prismatic
