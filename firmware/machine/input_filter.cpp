// One counter an input.
#include "firmware/machine/input_filter.hpp"

namespace cusp::machine {

void InputFilter::sample(std::uint16_t inputs) noexcept
{
    raw_ = inputs;
    if (((unsigned{inputs} ^ steady_) | counted_) == 0) {
        return;  // so in most ticks
    }
    counted_ = 0;
    for (unsigned i = 0; i < kInputCount; ++i) {
        const bool differs = ((unsigned{inputs} ^ steady_) >> i & 1U) != 0;
        if (!differs) {
            if (differing_[i] > 0) {
                ++glitches_;
            }
            differing_[i] = 0;
        } else if (differing_[i] < ticks_) {
            ++differing_[i];
            counted_ = static_cast<std::uint16_t>(counted_ | (1U << i));
        } else {
            differing_[i] = 0;
            steady_ = static_cast<std::uint16_t>(steady_ ^ (1U << i));
        }
    }
}

}  // namespace cusp::machine
