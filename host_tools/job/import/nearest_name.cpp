// Orders names by their distance.
#include "host_tools/job/import/nearest_name.hpp"

#include <algorithm>

namespace cusp::import {
namespace {

// Letters to insert, remove or replace to make one word of the other.
std::size_t letters_apart(const std::string& a, const std::string& b)
{
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) {
        row[j] = j;
    }
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
        }
    }
    return row[b.size()];
}

}  // namespace

std::vector<std::string> nearest_names(const std::string& name,
                                       std::vector<std::string> known,
                                       std::size_t count)
{
    std::stable_sort(known.begin(), known.end(), [&](const std::string& a, const std::string& b) {
        return letters_apart(a, name) < letters_apart(b, name);
    });
    known.resize(std::min(known.size(), count));
    return known;
}

}  // namespace cusp::import
