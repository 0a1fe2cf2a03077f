// A strategy is a record: its name, its keys, and how it checks and plans an operation. Records live
// beside their planners; `cam/strategies` lists them in one table, which the reader of jobs is given.
//
//     const Strategy kTrace{"trace", "the tip follows the boundary", keys_of({"floor", "boundary"}),
//                           {{"point_spacing", KeyKind::kLength, "1 mm", "of the pass", kPositive}},
//                           {}, nullptr, plan_trace};
#pragma once

#include <any>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/keys.hpp"

namespace cusp::job {

struct Job;
struct Operation;

// The shape that an operation cuts.
enum class Region : std::uint8_t {
    kSurfaces,     // down to the surfaces of the floor, inside the boundary where there is one
    kLevelPocket,  // between walls, down to a level floor
    kOutline,      // beside loops or on them, down to a level
    kHoles,        // straight down
    kTop,          // the stock's top or what loops enclose, down to a level
    kGrooves,      // the tool's profile along curves; with a floor that far below it
    kValleys,      // between loops, down from them along the flanks of a cone
    kEdges         // upper edges, along the flanks of a cone
};

// Facts that the rest of the program may ask of a strategy.
struct Traits {
    Region region{Region::kSurfaces};
    bool pocket{false};             // clears what a boundary encloses, with walls
    bool takes_mesh{false};         // plans on triangles themselves, without a height field
    bool only_finishes{false};      // has no roughing of its own
    bool bounds_engagement{false};  // max_engagement holds for all of its cuts
    bool one_line{false};           // `cusp plan` may be asked for it without a job
};

// Refuses a key of the operation for a reason; it does not return.
using Refuse = std::function<void(const char* key, const std::string& reason)>;

struct Strategy {
    std::string name;
    std::string help;       // one line: what it cuts
    std::vector<Key> keys;  // that it shares with others: keys_of()
    std::vector<Key> own;   // that it alone knows
    Traits traits{};
    // Its own parameters, of the values of its keys; null: it has none.
    std::any (*parameters)(const KeyValues&, const Operation&, const Refuse&){nullptr};
    // Refuses an operation that it can't plan, by its keys alone; null: nothing to refuse.
    void (*check)(const Operation&, const Refuse&){nullptr};
    // Errors: InputError where the operation can't be planned.
    std::vector<toolpath::PlannedOperation> (*plan)(const Job&, const Operation&){nullptr};

    // Cuts along a drawing from a level down, without surfaces.
    bool is_prismatic() const { return traits.region != Region::kSurfaces; }
};

// The strategy of an operation that has none yet; it plans nothing.
extern const Strategy kNoStrategy;

// In the order in which errors and help name them.
using Strategies = std::vector<const Strategy*>;

std::vector<std::string> names_of(const Strategies& strategies);

// The record of that name; null where there is none.
const Strategy* find_strategy(const Strategies& strategies, const std::string& name);

// All keys of the strategy: of every operation, shared with others, its own.
std::vector<Key> keys_of(const Strategy& strategy);

}  // namespace cusp::job
