// Progress of a computation: a bar on a terminal, otherwise four plain lines.
#pragma once

#include <chrono>
#include <string>

namespace cusp::cli {

class ShareProgress {
public:
    // what     name of the computation, one word
    // quiet_s  s: shorter computations print nothing
    explicit ShareProgress(std::string what, double quiet_s = 0.0);

    void operator()(double share);  // fraction of the work that is done, 0 to 1

private:
    std::string what_;
    double quiet_s_;
    std::chrono::steady_clock::time_point begin_;
    bool is_terminal_;
    int shown_{0};
};

}  // namespace cusp::cli
