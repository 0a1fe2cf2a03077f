// Sentences on what of a drawing is not taken as drawn.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host_tools/job/import/drawn_shapes.hpp"

namespace cusp::import {

// Texts beside curves, which somebody may expect to be cut.
//
// first  mm: place of the first one
void note_texts(const std::string& name,
                std::size_t texts,
                Vec2d first,
                std::vector<std::string>& notes);

// kinds  of objects that draw no curve, with their numbers
void note_left_out(const std::string& name,
                   const std::map<std::string, std::size_t>& kinds,
                   std::vector<std::string>& notes);

// Notes drawings that lie far from the origin of the machine: 100 m.
void note_far(const std::string& file,
              const std::vector<DrawingPath>& paths,
              std::vector<std::string>& notes);

// The layers of a drawing that are named nearly like one that is not there.
std::string nearest_layers(const std::string& layer, const std::set<std::string>& layers);

}  // namespace cusp::import
