// SpindleSlave: a spindle's drive as the other end of a Modbus line, by the manuals of three kinds of them. It
// knows nothing of the firmware. Its motor takes its time, and the line may lose, delay and damage bytes.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "firmware/vfd/vfd_protocol.hpp"

namespace cusp::test {

class SpindleSlave {
public:
    using Bytes = std::vector<std::uint8_t>;

    explicit SpindleSlave(vfd::Protocol protocol) : protocol_{protocol} {}

    static constexpr double kAcceleration = 15000;  // rpm a second
    static constexpr unsigned kMost = 24000;        // rpm, of a P2A
    static constexpr unsigned kAt50Hz = 3000;       // rpm, of a Huanyang

    // Faults: of so many answers to come, or of this part of all messages and answers. delay: ms.
    unsigned lose{0};
    unsigned garble{0};
    unsigned refuse{0};
    unsigned delay{10};
    double trouble{0};
    void seed(unsigned number) { random_.seed(number); }

    // The master's bytes; what it had heard is forgotten.
    void send(Bytes bytes)
    {
        heard_.clear();
        strike(bytes);
        const Bytes answer = answer_to(bytes);
        if (answer.empty()) {
            return;
        }
        answer_ = answer;
        if (lose > 0) {
            --lose;
            answer_.clear();
        } else if (garble > 0) {
            --garble;
            answer_[answer_.size() / 2] ^= 4U;
        }
        strike(answer_);
        left_ = delay +
                (trouble > 0 && random_() % 20 == 0 ? static_cast<unsigned>(random_() % 100) : 0U);
    }
    void pass(unsigned milliseconds)
    {
        const double target = direction_ * hertz_to_rpm();
        const double most = kAcceleration * milliseconds / 1000;
        const double away = target - turning_;
        turning_ += std::fabs(away) < most ? away : std::copysign(most, away);
        if (!answer_.empty() && left_ > milliseconds) {
            left_ -= milliseconds;
        } else if (!answer_.empty()) {
            heard_.insert(heard_.end(), answer_.begin(), answer_.end());
            answer_.clear();
        }
    }
    const Bytes& heard() const { return heard_; }

    int direction() const { return direction_; }
    double rpm() const { return std::fabs(turning_); }
    // Messages that it has not understood.
    unsigned refused() const { return refused_; }
    void turn_at(double rpm, int direction)
    {
        direction_ = direction;
        turning_ = rpm * direction;
        word_ = protocol_ == vfd::Protocol::kHuanyang      ? rpm / kAt50Hz * 5000
                : protocol_ == vfd::Protocol::kHuanyangP2A ? rpm / kMost * 10000
                                                           : rpm / 60 * 50;
    }

private:
    static void close(Bytes& bytes)
    {
        unsigned crc = 0xFFFF;
        for (const std::uint8_t byte : bytes) {
            for (unsigned bit = 0; bit < 8; ++bit) {
                const bool feedback = ((crc ^ static_cast<unsigned>(byte) >> bit) & 1U) != 0;
                crc = crc >> 1U ^ (feedback ? 0xA001U : 0U);
            }
        }
        bytes.push_back(static_cast<std::uint8_t>(crc & 255U));
        bytes.push_back(static_cast<std::uint8_t>(crc >> 8U));
    }
    static bool is_closed(const Bytes& bytes)
    {
        if (bytes.size() < 4) {
            return false;
        }
        Bytes before(bytes.begin(), bytes.end() - 2);
        close(before);
        return before == bytes;
    }
    void strike(Bytes& bytes)
    {
        if (bytes.empty() || trouble <= 0 ||
            std::uniform_real_distribution<double>{0, 1}(random_) > trouble) {
            return;
        }
        switch (random_() % 3) {
            case 0:
                bytes.clear();
                return;
            case 1:
                bytes.pop_back();
                return;
            default:
                bytes[random_() % bytes.size()] ^= static_cast<std::uint8_t>(1U << random_() % 8);
        }
    }
    double hertz_to_rpm() const
    {
        return protocol_ == vfd::Protocol::kHuanyang      ? word_ / 5000 * kAt50Hz
               : protocol_ == vfd::Protocol::kHuanyangP2A ? word_ / 10000 * kMost
                                                          : word_ / 50 * 60;
    }
    Bytes answer_to(const Bytes& bytes)
    {
        if (!is_closed(bytes) || bytes[0] != 1) {
            return {};
        }
        if (refuse > 0) {
            --refuse;
            Bytes refusal{1, static_cast<std::uint8_t>(bytes[1] | 0x80U), 2};
            close(refusal);
            return refusal;
        }
        return protocol_ == vfd::Protocol::kHuanyang ? answer_as_huanyang(bytes)
                                                     : answer_by_registers(bytes);
    }
    static Bytes with_value(Bytes bytes, double value)
    {
        const auto word = static_cast<unsigned>(std::lround(value));
        bytes.push_back(static_cast<std::uint8_t>(word >> 8U));
        bytes.push_back(static_cast<std::uint8_t>(word & 255U));
        close(bytes);
        return bytes;
    }
    Bytes not_understood()
    {
        ++refused_;
        return {};
    }
    Bytes answer_as_huanyang(const Bytes& bytes)
    {
        if (bytes[1] == 3 && bytes[2] == 1 && bytes.size() == 6) {
            direction_ = bytes[3] == 0x01 ? 1 : bytes[3] == 0x11 ? -1 : bytes[3] == 0x08 ? 0 : 9;
            Bytes answer{1, 3, 1, static_cast<std::uint8_t>(direction_ == 0 ? 0 : 0x29)};
            close(answer);
            return answer;
        }
        if (bytes[1] == 5 && bytes[2] == 2 && bytes.size() == 7) {
            word_ = bytes[3] * 256 + bytes[4];
            return bytes;
        }
        if (bytes[1] == 4 && bytes[2] == 3 && bytes[3] == 1 && bytes.size() == 8) {
            return with_value({1, 4, 3, 1}, rpm() / kAt50Hz * 5000);
        }
        if (bytes[1] == 1 && bytes[2] == 3 && bytes[3] == 144 && bytes.size() == 8) {
            return with_value({1, 1, 3, 144}, kAt50Hz);
        }
        return not_understood();
    }
    Bytes answer_by_registers(const Bytes& bytes)
    {
        if (bytes.size() != 8) {
            return not_understood();
        }
        const bool p2a = protocol_ == vfd::Protocol::kHuanyangP2A;
        const unsigned place = bytes[2] * 256U + bytes[3];
        const unsigned value = bytes[4] * 256U + bytes[5];
        if (bytes[1] == 6 && place == 0x2000) {
            direction_ = p2a ? (value == 1   ? 1
                                : value == 2 ? -1
                                : value == 6 ? 0
                                             : 9)
                             : (value == 18   ? 1
                                : value == 34 ? -1
                                : value == 1  ? 0
                                              : 9);
            return bytes;
        }
        if (bytes[1] == 6 && place == (p2a ? 0x1000U : 0x2001U)) {
            word_ = value;
            return bytes;
        }
        if (bytes[1] == 3 && p2a && (place == 0xB005 || place == 0x700C)) {
            return with_value({1, 3, 0, 4}, place == 0xB005 ? kMost : rpm());
        }
        if (bytes[1] == 3 && !p2a && place == 0x2103) {
            return with_value({1, 3, 2}, rpm() / 60 * 100);
        }
        return not_understood();
    }

    vfd::Protocol protocol_;
    std::mt19937 random_{1};
    double word_{0};     // the speed that it was told, as it was told
    double turning_{0};  // rpm, signed
    int direction_{0};
    unsigned refused_{0};
    Bytes answer_;
    unsigned left_{0};  // ms until it is heard
    Bytes heard_;
};

}  // namespace cusp::test
