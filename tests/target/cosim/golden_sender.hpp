// GoldenSender: sends a program and a script of realtime bytes tick by tick, as the simulator does.
//
// The core and the line take no time while it runs, so that bytes and servo ticks come in the
// simulator's order; the pulse stream keeps its microseconds, and those are compared.
#pragma once

#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "tests/target/cosim/chip_under_test.hpp"

namespace cusp::cosim {

// A pin by its name on the schematic: "PC6"; "GP6" is one of port P.
struct PinName {
    char port;
    unsigned number;
};
PinName pin_name(const std::string& text);  // throws std::runtime_error

struct GoldenJob {
    std::vector<std::string> lines;
    std::deque<std::pair<std::uint64_t, char>> script;  // tick, byte
    std::vector<PinName> pins;                          // steps X Y Z, directions X Y Z
    unsigned inverted{0};                               // of the six
    std::uint64_t most_ticks{3600000};                  // a program that lasts longer has no end
};

class GoldenSender {
public:
    GoldenSender(ChipUnderTest& chip, GoldenJob job);

    // Returns 0, or 1 where the controller refused something. Throws std::runtime_error where the
    // program does not come to its end.
    int run();
    // tick << 8 | levels, of each change of the six lines.
    const std::vector<std::uint64_t>& edges() const { return edges_; }

private:
    void on_tick();
    void hear(char byte);
    void take(const std::string& answer);
    void begin_line();
    bool lines_changed();
    bool on_settled();
    bool finished() const { return (ended_ || next_line_ >= job_.lines.size()) && !waiting_; }
    void collect();

    ChipUnderTest& chip_;
    GoldenJob job_;
    std::vector<std::uint64_t> edges_;
    std::string heard_;
    std::size_t next_line_{0};
    std::uint64_t tick_{0};
    Picoseconds start_{0};
    Picoseconds first_boundary_{-1};
    bool may_begin_line_{true};
    bool waiting_{false};
    bool refused_{false};
    bool ended_{false};
    bool may_hold_{false};
    bool asked_{false};    // in this tick
    bool resumed_{false};  // in this tick
    bool done_{false};
    std::uint64_t silent_since_{0};
    struct Seen {
        std::size_t count{0};  // of the port's changes
        unsigned high{0};
    };
    std::map<char, Seen> seen_;
};

}  // namespace cusp::cosim
