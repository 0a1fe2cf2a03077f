// A program over a line that damages, loses, doubles and delays bytes in both directions: with
// checked lines every line is cut exactly once and in order, to the same steps as on a clean line.
#include <cstdint>
#include <cstdio>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"

namespace {

using cusp::ControllerBench;

std::string with_check(const std::string& text)
{
    cusp::protocol::Crc32 crc;
    for (const char c : text) {
        crc.add(static_cast<std::uint8_t>(c));
    }
    char digits[9];
    (void)std::snprintf(digits, sizeof digits, "%08X", static_cast<unsigned>(crc.value()));
    return text + "*" + digits;
}

// The order of all steps: two bits of axis and one of direction each.
class StepRecorder : public cusp::hal::FrameListener {
public:
    void frame_played(std::uint64_t /*start_tick*/, const cusp::PulseFrame& frame) override
    {
        for (const cusp::PulseEdge& edge : frame.edges) {
            levels_ = static_cast<std::uint8_t>((levels_ | edge.raise) & ~unsigned{edge.lower});
            for (unsigned axis = 0; axis < cusp::kAxisCount; ++axis) {
                if ((edge.raise & cusp::step_line(axis)) != 0) {
                    const bool plus = (levels_ & cusp::direction_line(axis)) != 0;
                    steps.push_back(static_cast<std::uint8_t>(axis * 2 + (plus ? 1 : 0)));
                }
            }
        }
    }
    std::vector<std::uint8_t> steps;

private:
    std::uint8_t levels_{0};
};

class Noise {
public:
    Noise(double rate, unsigned seed) : rate_{rate}, random_{seed} {}

    std::string spoilt(const std::string& bytes)
    {
        std::string result;
        for (const char byte : bytes) {
            if (std::uniform_real_distribution<>{}(random_) >= rate_) {
                result += byte;
                continue;
            }
            switch (random_() % 3) {
                case 0:
                    result += static_cast<char>(random_() % 256);
                    break;
                case 1:
                    break;
                default:
                    result += std::string(2, byte);
                    break;
            }
        }
        return result;
    }
    // Bytes may wait; they keep their order.
    bool delays() { return rate_ > 0 && random_() % 8 == 0; }

private:
    double rate_;
    std::mt19937 random_;
};

// Sends lines until all are acknowledged, as docs/protocol.md requires of a sender.
class CheckedSender {
public:
    CheckedSender(ControllerBench& bench, std::vector<std::string> lines, Noise noise)
        : bench_{bench}, lines_{std::move(lines)}, noise_{noise}
    {
    }

    // False where the controller is not done after so many ticks.
    bool run(unsigned most_ticks)
    {
        for (unsigned tick = 0; tick < most_ticks && acknowledged_ < lines_.size(); ++tick) {
            send();
            bench_.run(1);
            hear(noise_.spoilt(bench_.board.byte_link.take_answers()));
            ++quiet_;
            if (quiet_ > kPatience) {
                rewind();
            }
        }
        return acknowledged_ == lines_.size();
    }

private:
    static constexpr unsigned kPatience = 150;
    static constexpr std::size_t kWindow = 900;

    void send()
    {
        if (!on_) {
            if (quiet_ == 0 || quiet_ > kPatience / 2) {
                bench_.board.byte_link.send(noise_.spoilt("\n$CRC=1\n\n"));
                quiet_ = 1;
            }
            return;
        }
        while (next_ < lines_.size()) {
            const std::string text =
                with_check("N" + std::to_string(next_ + 1) + lines_[next_]) + "\n";
            if (outstanding_ + text.size() > kWindow) {
                break;
            }
            outstanding_ += text.size();
            sizes_.push_back(text.size());
            waiting_ += noise_.spoilt(text);
            ++next_;
        }
        if (!noise_.delays()) {
            bench_.board.byte_link.send(waiting_);
            waiting_.clear();
        }
    }

    void hear(const std::string& bytes)
    {
        for (const char byte : bytes) {
            if (byte != '\n' && byte != '\r') {
                heard_ += byte;
            } else {
                understand(heard_);
                heard_.clear();
            }
        }
    }

    void understand(const std::string& line)
    {
        const std::size_t star = line.find('*');
        if (star == std::string::npos || with_check(line.substr(0, star)) != line) {
            return;
        }
        if (line.front() == '<') {
            return;  // a status report, which noise asked for
        }
        // The answer to the empty line behind `$CRC=1`.
        on_ = on_ || line.compare(0, 9, "resend N1") == 0;
        if (line.compare(0, 4, "ok N") == 0) {
            acknowledge(std::stoul(line.substr(4)));
        } else if (line.compare(0, 8, "resend N") == 0) {
            const std::size_t expected = std::stoul(line.substr(8));
            acknowledge(expected - 1);
            if (quiet_ > 20) {
                rewind();
            }
        } else {
            FAIL(line.c_str());
        }
    }

    void acknowledge(std::size_t number)
    {
        if (number <= acknowledged_) {
            return;
        }
        for (; acknowledged_ < number && !sizes_.empty(); ++acknowledged_) {
            outstanding_ -= sizes_.front();
            sizes_.erase(sizes_.begin());
        }
        acknowledged_ = number;
        next_ = std::max(next_, number);
        quiet_ = 0;
    }

    void rewind()
    {
        next_ = acknowledged_;
        outstanding_ = 0;
        sizes_.clear();
        quiet_ = 0;
        // Ends the remainder of a line whose end was lost.
        waiting_ += "\n";
    }

    ControllerBench& bench_;
    std::vector<std::string> lines_;
    Noise noise_;
    std::string waiting_;
    std::string heard_;
    std::vector<std::size_t> sizes_;
    std::size_t outstanding_{0};
    std::size_t next_{0};
    std::size_t acknowledged_{0};
    unsigned quiet_{0};
    bool on_{false};
};

// One axis a line and an exact stop at each corner: the order of the steps is the order of the
// lines.
std::vector<std::string> program(unsigned count)
{
    std::vector<std::string> lines{"G61", "G91", "G1F6000"};
    for (unsigned i = 0; i < count; ++i) {
        const char axis = "XYZ"[i % 3];
        const unsigned hundredths = i * 7 % 5 + 1;
        const bool minus = (i / 3) % 2 == 1;
        lines.push_back(std::string{axis} + (minus ? "-" : "") + "0.0" +
                        std::to_string(hundredths));
    }
    return lines;
}

cusp::machine::Settings quick_settings()
{
    cusp::machine::Settings settings;
    for (const unsigned axis : {0U, 1U, 2U}) {
        CHECK(!settings.put(120 + axis, 5000));
        CHECK(!settings.put(800 + axis, 1e6F));
    }
    return settings;
}

std::optional<std::vector<std::uint8_t>> steps_cut(double rate, unsigned seed, unsigned lines)
{
    const cusp::machine::Settings settings = quick_settings();
    ControllerBench bench{{}, settings};
    StepRecorder recorder;
    bench.board.pulse_player.add_listener(recorder);
    CheckedSender sender{bench, program(lines), Noise{rate, seed}};
    if (!sender.run(lines * 200 + 20000)) {
        return std::nullopt;
    }
    (void)bench.finish();
    return recorder.steps;
}

}  // namespace

TEST_GROUP(BadLine){};

TEST(BadLine, CutsTenThousandLinesOnceAndInOrder)
{
    constexpr unsigned kSeed = 20240417;
    constexpr unsigned kLines = 10000;
    const auto clean = steps_cut(0, kSeed, kLines);
    CHECK(clean.has_value());
    const auto noisy = steps_cut(1.0 / 200, kSeed, kLines);
    CHECK(noisy.has_value());
    CHECK_EQUAL(clean->size(), noisy->size());
    CHECK(*clean == *noisy);
}

TEST(BadLine, CutsTheSameStepsAtEveryRateAndSeed)
{
    constexpr unsigned kLines = 300;
    const auto clean = steps_cut(0, 1, kLines);
    CHECK(clean.has_value());
    for (const double rate : {1.0 / 5000, 1.0 / 1000, 1.0 / 200}) {
        for (unsigned seed = 1; seed <= 5; ++seed) {
            const auto noisy = steps_cut(rate, seed, kLines);
            CHECK_TEXT(noisy.has_value(), ("not done with seed " + std::to_string(seed)).c_str());
            CHECK_TEXT(*clean == *noisy, ("other steps with seed " + std::to_string(seed)).c_str());
        }
    }
}
