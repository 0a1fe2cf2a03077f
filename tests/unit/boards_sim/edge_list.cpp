// Runs a program through the whole firmware and writes every edge: to compare architectures.
//
// usage: edge_list PROGRAM [SCRIPT] >EDGES
// A line is sent when the last is answered; SCRIPT has lines `tick byte`. Each edge is a line: its
// pulse tick, the lines raised and those lowered.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "boards/sim/simulated_controller.hpp"
#include "firmware/base/assert.hpp"

void cusp::fault(const char* expression, const char* file, int line) noexcept
{
    std::fprintf(stderr, "%s:%d: %s\n", file, line, expression);
    std::abort();
}

namespace {

class EdgeLines : public cusp::hal::FrameListener {
public:
    void frame_played(std::uint64_t start_tick, const cusp::PulseFrame& frame) override
    {
        for (const cusp::PulseEdge& edge : frame.edges) {
            std::printf("%llu %u %u\n", static_cast<unsigned long long>(start_tick + edge.tick),
                        unsigned{edge.raise}, unsigned{edge.lower});
        }
    }
};

// The sender, one servo tick at a time.
class Run {
public:
    Run(const char* program, const char* script) : program_{program}
    {
        if (script != nullptr) {
            script_.open(script);
            read_script();
        }
        controller_.power_on();
        controller_.board().pulse_player.add_listener(edges_);
    }

    bool good() const { return program_.is_open(); }

    void to_the_end()
    {
        constexpr std::uint64_t kMostTicks = 3'600'000;
        while (tick_ < kMostTicks && !(sent_all_ && !waiting_ && controller_.machine().idle())) {
            send();
            controller_.tick();
            ++tick_;
            const std::string said = controller_.board().byte_link.take_answers();
            waiting_ = waiting_ && said.find("ok") == std::string::npos;
            if (said.find("error:") != std::string::npos ||
                said.find("ALARM:") != std::string::npos) {
                sent_all_ = true;
                waiting_ = false;
            }
            std::fputs(said.c_str(), stderr);
        }
    }

private:
    void read_script()
    {
        script_waits_ = static_cast<bool>(script_ >> script_tick_ >> script_byte_);
    }
    void send()
    {
        auto& link = controller_.board().byte_link;
        for (; script_waits_ && script_tick_ <= tick_; read_script()) {
            const char byte = static_cast<char>(script_byte_);
            link.send({&byte, 1});
        }
        const auto& machine = controller_.machine();
        if (!script_waits_ && machine.state() == cusp::machine::State::kHold &&
            machine.motion().at_rest()) {
            link.send("~");
        }
        std::string line;
        if (!waiting_ && !sent_all_) {
            sent_all_ = !std::getline(program_, line);
            waiting_ = !sent_all_;
            if (waiting_) {
                link.send(line + "\n");
            }
        }
    }

    std::ifstream program_;
    std::ifstream script_;
    std::uint64_t script_tick_{0};
    unsigned script_byte_{0};
    bool script_waits_{false};
    cusp::board_sim::SimulatedController controller_{cusp::hal::MillGeometry{}};
    EdgeLines edges_;
    std::uint64_t tick_{0};
    bool waiting_{false};
    bool sent_all_{false};
};

}  // namespace

int main(int count, char** words)
{
    if (count < 2) {
        std::fputs("usage: edge_list PROGRAM [SCRIPT] >EDGES\n", stderr);
        return 2;
    }
    Run run{words[1], count > 2 ? words[2] : nullptr};
    if (!run.good()) {
        std::fprintf(stderr, "edge_list: %s can't be read\n", words[1]);
        return 2;
    }
    run.to_the_end();
    return 0;
}
