// The size of a picture that is a relief.
#pragma once

namespace cusp::import {

struct ReliefSize {
    double width{};  // mm, > 0: from the leftmost column of pixels to the last
    double black{};  // z, mm
    double white{};  // z, mm
};

}  // namespace cusp::import
