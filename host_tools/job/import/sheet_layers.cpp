// Operations are those of the strategies' records that cut drawings.
#include "host_tools/job/import/sheet_layers.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/number_text/number_text.hpp"
#include "host_tools/job/job/keys.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

using job::Region;

namespace {

// Sides of a profile, as operations.
constexpr std::array<const char*, 3> kSides{"outside", "inside", "on"};
constexpr const char* kLeftOut = "none";

// Of circuit boards, whose copper is cut around.
constexpr const char* kCopper = "copper";

struct NamedUse {
    const char* word;  // in lower case, without the s of a plural
    std::optional<Region> region;
};
// Words in names of layers beside the names of strategies.
constexpr std::array<NamedUse, 19> kWords{{{"hole", Region::kHoles},
                                           {"drilling", Region::kHoles},
                                           {"engraving", Region::kGrooves},
                                           {"text", Region::kGrooves},
                                           {"name", Region::kGrooves},
                                           {"mark", Region::kGrooves},
                                           {"score", Region::kGrooves},
                                           {"scribe", Region::kGrooves},
                                           {"dim", std::nullopt},
                                           {"dimension", std::nullopt},
                                           {"defpoint", std::nullopt},
                                           {"construction", std::nullopt},
                                           {"guide", std::nullopt},
                                           {"note", std::nullopt},
                                           {"title", std::nullopt},
                                           {"mask", std::nullopt},
                                           {"paste", std::nullopt},
                                           {"legend", std::nullopt},
                                           {kCopper, Region::kOutline}}};

[[noreturn]] void refuse_layer(const std::string& text, const std::string& what)
{
    throw InputError(fmt::format("--layer {}: {}", text, what));
}

// The runs of letters, in lower case, without the s of a plural.
std::vector<std::string> words_in(const std::string& name)
{
    std::vector<std::string> words{""};
    for (const char c : name + ' ') {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalpha(byte) != 0 || byte >= 0x80) {
            words.back() += static_cast<char>(std::tolower(byte));
        } else if (!words.back().empty()) {
            if (words.back().size() > 1 && words.back().back() == 's') {
                words.back().pop_back();
            }
            words.emplace_back();
        }
    }
    words.pop_back();
    return words;
}

bool is_isolation(const LayerUse& use)
{
    const std::vector<std::string> words = words_in(use.layer);
    return use.region == Region::kOutline && (use.side.empty() || use.side == "outside") &&
           std::find(words.begin(), words.end(), kCopper) != words.end();
}

double depth_of(const std::string& text, const std::string& field)
{
    const auto found = number_text::leading_number(field);
    if (!found || found->size != field.size() ||
        !(found->value > 0 && found->value <= job::kLargest)) {
        refuse_layer(text, fmt::format("\"{}\" is no depth: a number above 0 and at most {:g}",
                                       field, job::kLargest));
    }
    return found->value;
}

bool cuts_layers(const job::Strategy& strategy, const job::Strategies& strategies)
{
    const Region region = strategy.traits.region;
    return strategy.is_prismatic() && region != Region::kTop &&
           strategy_for(region, strategies).name == strategy.name;
}

// Uses that the name of a layer may ask for: outlines are found by nesting, flanks of a vee need more than a name.
bool is_named(Region region)
{
    return region == Region::kLevelPocket || region == Region::kHoles || region == Region::kGrooves;
}

LayerUse use_of_word(const std::string& text,
                     const std::string& word,
                     const job::Strategies& strategies)
{
    LayerUse use;
    use.word = word;
    if (word == kLeftOut) {
        return use;
    }
    if (std::find(kSides.begin(), kSides.end(), word) != kSides.end()) {
        use.region = Region::kOutline;
        use.side = word;
        return use;
    }
    const job::Strategy* const strategy = find_strategy(strategies, word);
    if (strategy == nullptr || !cuts_layers(*strategy, strategies)) {
        std::string words;
        for (const job::Strategy* const each : strategies) {
            words += cuts_layers(*each, strategies) ? each->name + ", " : "";
        }
        refuse_layer(text, fmt::format("\"{}\" is no operation for a layer: {}{}, {}", word, words,
                                       fmt::join(kSides, ", "), kLeftOut));
    }
    use.region = strategy->traits.region;
    return use;
}

}  // namespace

const job::Strategy& strategy_for(Region region, const job::Strategies& strategies)
{
    const job::Strategy* found = nullptr;
    for (const job::Strategy* const strategy : strategies) {
        if (strategy->traits.region == region &&
            (found == nullptr || find_key(keys_of(*strategy), "loops") != nullptr)) {
            found = strategy;
        }
    }
    return *found;
}

LayerUse layer_use_of_text(const std::string& text, const job::Strategies& strategies)
{
    const std::size_t mark = text.rfind('=');
    if (mark == std::string::npos || mark == 0) {
        refuse_layer(text, "NAME=OPERATION is needed, such as pockets=pocket:4 or holes=drill");
    }
    const std::string asked = text.substr(mark + 1);
    const std::size_t colon = asked.find(':');
    LayerUse use = use_of_word(text, asked.substr(0, colon), strategies);
    use.layer = text.substr(0, mark);
    if (colon != std::string::npos) {
        use.depth = depth_of(text, asked.substr(colon + 1));
    }
    if (use.region == Region::kEdges && !use.depth) {
        refuse_layer(text, "a chamfer needs its width, seen from above: chamfer:0.5");
    }
    if (!use.region && use.depth) {
        refuse_layer(text, "a layer that is left out has no depth");
    }
    use.isolates = is_isolation(use);
    return use;
}

std::optional<LayerUse> layer_use_of_name(const std::string& layer,
                                          const job::Strategies& strategies)
{
    for (const std::string& word : words_in(layer)) {
        const auto known = std::find_if(kWords.begin(), kWords.end(),
                                        [&](const NamedUse& use) { return word == use.word; });
        const job::Strategy* const strategy = find_strategy(strategies, word);
        const bool is_strategy = strategy != nullptr && is_named(strategy->traits.region) &&
                                 cuts_layers(*strategy, strategies);
        if (known == kWords.end() && !is_strategy) {
            continue;
        }
        LayerUse use;
        use.layer = layer;
        use.word = word;
        use.region = is_strategy ? strategy->traits.region : known->region;
        use.only_fitting = true;
        use.by_name = true;
        use.isolates = is_isolation(use);
        return use;
    }
    return std::nullopt;
}

}  // namespace cusp::import
