// A plan as its user sees it: one line for each operation, bars, warnings.
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/cam/plan/plan.hpp"
#include "host_tools/cli/share_progress.hpp"

namespace cusp::cli {

class ConsoleWatcher : public plan::Watcher {
public:
    // said  receives a line for each operation
    explicit ConsoleWatcher(std::FILE* said) : said_{said} {}

    void operation(std::size_t place, std::size_t count, const std::string& strategy) override;
    void begin(const std::string& work) override;
    void progress(const char* work, double share) override;

private:
    std::FILE* said_;
    std::optional<ShareProgress> bar_;  // of what begin() named last
};

// On the standard error stream.
void print_warnings(const std::vector<std::string>& warnings);

}  // namespace cusp::cli
