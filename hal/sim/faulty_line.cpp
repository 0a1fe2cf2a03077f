// Random faults of a line.
#include "hal/sim/faulty_line.hpp"

#include <algorithm>

namespace cusp::hal {

void FaultyLine::put(std::string_view bytes)
{
    for (const char sent : bytes) {
        if (happens(faults_.loss)) {
            continue;
        }
        char byte = sent;
        if (happens(faults_.noise)) {
            byte = static_cast<char>(static_cast<unsigned char>(byte) ^ (1U << (random_() % 8U)));
        }
        std::uint64_t due = now_;
        if (happens(faults_.delay)) {
            due += 1 + random_() % std::max(1U, faults_.delay_ticks);
        }
        last_due_ = std::max(last_due_, due);
        bytes_.push_back({byte, last_due_});
        if (happens(faults_.doubling)) {
            bytes_.push_back({byte, last_due_});
        }
    }
}

std::string FaultyLine::take()
{
    std::string arrived;
    while (!bytes_.empty() && bytes_.front().due <= now_) {
        arrived.push_back(bytes_.front().value);
        bytes_.pop_front();
    }
    return arrived;
}

void FaultyLine::advance() { ++now_; }

// Draws a random number only where the fault can happen, so that adding one kind of fault does not
// move the others.
bool FaultyLine::happens(double probability)
{
    if (probability <= 0.0) {
        return false;
    }
    const bool yes = std::uniform_real_distribution<double>{0.0, 1.0}(random_) < probability;
    faults_done_ += yes ? 1 : 0;
    return yes;
}

}  // namespace cusp::hal
