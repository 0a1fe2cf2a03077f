// The keys that several strategies share; a strategy's record names those that it takes.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/job/strategy.hpp"

namespace cusp::job {

// A key with choices; without it the first of them, or `otherwise`.
Key choice(const std::string& name,
           const std::vector<std::string>& choices,
           const std::string& help,
           const std::string& otherwise = {});
// A key that is a table, or may be several.
Key table(const std::string& name,
          const KeyTable& (*members)(),
          const std::string& otherwise,
          const std::string& help);
Key tables(const std::string& name,
           const KeyTable& (*members)(),
           const std::string& otherwise,
           const std::string& help);

// Keys that every operation has.
const std::vector<Key>& common_keys();
// The shared keys of these names. Throws std::logic_error where there is none of a name.
std::vector<Key> shared_keys(const std::vector<std::string>& names);

// The names, and those of the keys that spell a text in place of a drawing.
std::vector<std::string> with_text(std::vector<std::string> names);
// Keys that strategies on surfaces take, but for those of `left_out`; then the keys of these names.
std::vector<Key> surface_keys(const std::vector<std::string>& names = {},
                              const std::vector<std::string>& left_out = {});
// Keys of strategies that finish surfaces and rough none.
std::vector<Key> finishing_keys();
// `tabs` of a profile.
const KeyTable& tabs_table();

// Every key that some strategy takes, once each.
std::vector<Key> all_keys(const Strategies& strategies);
// The strategies that take the key, in their order.
Strategies strategies_with(const Strategies& strategies, const std::string& key);

}  // namespace cusp::job
