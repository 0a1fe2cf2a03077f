// Chooses the tool of a one-line call that cuts each thing in a drawing.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/job/import/one_line_choice.hpp"
#include "host_tools/job/import/sheet_layers.hpp"

namespace cusp::import {

// Flat, bull-nose and ball ends are mills: the first cuts outlines, the last holes, pockets and, without a vee,
// lines; all others rough pockets. Places count the tools of the call from 0. Lengths in its unit.
class SheetTools {
public:
    SheetTools(const OneLineRequest& request, const OneLineChoice& choice)
        : request_{request}, tools_{choice.tools}
    {
    }

    // Errors: InputError where there is none.
    std::size_t first_mill_place() const;
    std::size_t last_mill_place() const;
    const NamedTool& last_mill() const { return tools_[last_mill_place()]; }
    // Numbers of the mills before the last, from 1.
    std::vector<std::size_t> roughing_mills() const;
    std::size_t engraver_place() const;
    // The mill or vee whose cut is narrowest at the depth cuts around copper; a mill nothing else if there is another.
    std::size_t isolating_place(double depth) const;
    bool is_vee(std::size_t place) const;
    void keep_for_copper(std::size_t place) { isolating_ = place; }
    std::size_t vee_place(const LayerUse& use) const;

    bool has_one_drill() const { return places_of(toolpath::ToolShape::kDrill).size() == 1; }
    std::size_t only_drill_place() const { return places_of(toolpath::ToolShape::kDrill).front(); }
    // A drill of the diameter, else a mill of it; with `every` else the largest drill, or mill, that is no wider.
    std::optional<std::size_t> drill_for(double diameter, double same, bool every) const;
    // Height of a drill's tip; of a mill 0.
    double tip_of(std::size_t place) const;
    // The deepest cut at once.
    double step_of(std::size_t place) const;

private:
    std::vector<std::size_t> places_of(toolpath::ToolShape shape) const;
    std::vector<std::size_t> mills() const;

    const OneLineRequest& request_;
    const std::vector<NamedTool>& tools_;
    std::optional<std::size_t> isolating_;
};

struct SheetTabs {
    std::size_t count;
    double width;
    double height;
};

// text      COUNT or COUNT:WIDTH:HEIGHT; by default as wide as the tool and a quarter of the depth high
// diameter  of the tool
//
// Errors: InputError with the text.
SheetTabs tabs_of_text(const std::string& text, double depth, double diameter);

}  // namespace cusp::import
