// Positions of tabs along a path, and the heights of the tip that leave them.
#pragma once

#include <vector>

#include "host_tools/job/job/prismatic_keys.hpp"

namespace cusp::prismatic {

// A tab by lengths along the path of the tool's centre, mm.
struct TabStretch {
    double rise_begin;  // here the tip is at the bottom
    double full_begin;  // from here to full_end it is at the tab's height
    double full_end;
    double rise_end;
};

// A stretch of a pass; the height changes evenly along it.
struct HeightStretch {
    double from, to;  // mm along the path
    double z0, z1;
};

// mm along the path that a tab takes from its middle to either side: half of its width, the tool's
// radius, so that what is left is `width` wide, and its slope.
double half_of_tab(const job::Tabs& tabs, double tool_radius);

// Tabs with their middles at `middles`, ascending.
std::vector<TabStretch> tab_stretches(const job::Tabs& tabs,
                                      const std::vector<double>& middles,
                                      double tool_radius);

// The pass at z over a path of `length`: raised to `full` where tabs are higher than z.
std::vector<HeightStretch> heights_over_tabs(
    const std::vector<TabStretch>& tabs, double length, double z, double bottom, double full);

}  // namespace cusp::prismatic
