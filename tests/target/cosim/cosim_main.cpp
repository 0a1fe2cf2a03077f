// Runs the image of a board on models of its chip's registers, as the commands on its input say.
//
// usage: cosim CHIP CRYSTAL_HZ IMAGE.bin; of an STM32 also [external] [usart2] [drive PIN]... [bus_drive SELECT CLOCK TO FROM]... [spindle PROTOCOL USART PIN] [loader FILE.bin SECTOR]
//
// `loader`: the file lies before the image, which begins at 0x08008000 and may write to two sectors; `drive`: a TMC2209 is at this pin; `bus_drive`: a TMC5160 at these; `spindle`: a spindle's drive (1 Huanyang, 2 P2A, 3 plain) is at this USART, this pin its transceiver's; `external`: a clock from outside is there in place of a crystal; `usart2`: the line is USART2.
//
// Each command is a line; its answer ends with the line "done". tests/target/cosim/chip.py sends them.
// Exit status: 0, or 2 where a command or the image can't be used.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "firmware/base/assert.hpp"
#include "tests/target/cosim/golden_sender.hpp"
#include "tests/target/cosim/pseudo_terminal.hpp"
#include "tests/target/cosim/rp2350/rp2350_chip.hpp"
#include "tests/target/cosim/stm32_chip.hpp"
#include "tests/target/cosim/usb_console.hpp"

void cusp::fault(const char* expression, const char* file, int line) noexcept
{
    std::cerr << file << ":" << line << ": " << expression << std::endl;
    std::abort();
}

namespace cusp::cosim {
namespace {

std::vector<std::uint8_t> read_file(const std::string& name)
{
    std::ifstream file{name, std::ios::binary};
    if (!file) {
        throw std::runtime_error{name + ": can't be read"};
    }
    return {std::istreambuf_iterator<char>{file}, std::istreambuf_iterator<char>{}};
}

class Console {
public:
    explicit Console(ChipUnderTest& chip) : chip_{chip} { listen(); }

    void perform(const std::string& line);

private:
    void listen()
    {
        chip_.serial().set_receiver([this](char byte) { heard_[0].push_back(byte); });
        chip_.usb().set_receiver([this](char byte) { heard_[1].push_back(byte); });
    }
    void run(std::istream& words);
    void send(std::istream& words);
    void pin(std::istream& words);
    void core(std::istream& words);
    void serial(std::istream& words);
    void power(std::istream& words);
    void golden(std::istream& words);
    void drive(std::istream& words);
    void spindle(std::istream& words);
    void tell_drives();
    void tell_pins() const;
    void tell_changes() const;
    void tell_duties();
    void tell_state() const;
    void tell_heard();

    ChipUnderTest& chip_;
    std::string& heard() { return heard_[usb_ ? 1 : 0]; }

    std::array<std::string, 2> heard_;  // over the serial port, over USB
    bool usb_{false};                   // which of both is the line
};

Picoseconds milliseconds(std::istream& words)
{
    double value = 0;
    if (!(words >> value) || value < 0) {
        throw std::runtime_error{"a time in milliseconds is missing"};
    }
    return static_cast<Picoseconds>(value * 1e9);
}

// run MS [HEX]: so long, or until the bytes were heard.
void Console::run(std::istream& words)
{
    const Picoseconds time = milliseconds(words);
    std::string wanted;
    std::string hex;
    words >> hex;
    for (std::size_t at = 0; at + 1 < hex.size(); at += 2) {
        wanted.push_back(static_cast<char>(std::stoi(hex.substr(at, 2), nullptr, 16)));
    }
    const auto was_heard = [&] {
        return heard().find(wanted) != std::string::npos;
    };
    chip_.run(time, wanted.empty() ? std::function<bool()>{} : was_heard);
    tell_heard();
}

void Console::tell_heard()
{
    std::cout << "heard ";
    for (const char byte : heard()) {
        std::printf("%02x", static_cast<unsigned char>(byte));
    }
    std::fflush(stdout);
    std::cout << "\n";
    heard().clear();
}

// send HEX
void Console::send(std::istream& words)
{
    std::string hex;
    words >> hex;
    std::string bytes;
    for (std::size_t at = 0; at + 1 < hex.size(); at += 2) {
        bytes.push_back(static_cast<char>(std::stoi(hex.substr(at, 2), nullptr, 16)));
    }
    chip_.line().send(bytes);
}

// pin PB12 0|1|open
void Console::pin(std::istream& words)
{
    std::string name;
    std::string level;
    words >> name >> level;
    const PinName pin = pin_name(name);
    chip_.port(pin.port).drive(pin.number, level == "open" ? -1 : level == "1" ? 1 : 0);
}

// core stop|halt|go|hang: locked up, held by a debugger, on again; the main loop in circles
void Console::core(std::istream& words)
{
    std::string what;
    words >> what;
    if (what == "go") {
        chip_.go_on();
    } else if (what == "hang") {
        chip_.hang_main_loop();
    } else {
        chip_.stop_core(what == "halt");
    }
}

// serial mute|reads|overrun|damage: of the other end, or of a byte
void Console::serial(std::istream& words)
{
    std::string what;
    words >> what;
    if (what == "overrun") {
        chip_.serial().overrun();
    } else if (what == "damage") {
        chip_.serial().damage();
    } else {
        chip_.line().set_mute(what == "mute");
    }
}

// power cycle | power fails_after WRITES
void Console::power(std::istream& words)
{
    std::string what;
    std::uint64_t writes = 0;
    words >> what >> writes;
    if (what == "cycle") {
        chip_.power_cycle();
    } else {
        chip_.fail_power_after(writes);
    }
}

// drive PLACE missing|there|garbled COUNT|version N|deaf 0|1|drift PER_THOUSAND|status BITS|starve|restart
void Console::drive(std::istream& words)
{
    std::size_t place = 0;
    std::string what;
    std::int64_t number = 0;
    words >> place >> what >> number;
    const auto value = static_cast<std::uint32_t>(number);
    SocketModel& drive = chip_.drive(place);
    if (what == "missing" || what == "there") {
        drive.set_missing(what == "missing");
    } else if (what == "garbled") {
        drive.garble_answers(value);
    } else if (what == "version") {
        drive.set_version(value);
    } else if (what == "deaf") {
        drive.set_deaf(value != 0);
    } else if (what == "drift") {
        drive.set_drift(static_cast<std::int32_t>(number));
    } else if (what == "status") {
        drive.set_status(value);
    } else if (what == "starve") {
        drive.starve();
    } else if (what == "restart") {
        drive.reset();
    } else {
        throw std::runtime_error{"no such drive command: " + what};
    }
}

// spindle lose|garble|refuse COUNT | delay MS | baud BAUD | tell
void Console::spindle(std::istream& words)
{
    std::string what;
    unsigned number = 0;
    words >> what >> number;
    SpindleModel& spindle = chip_.spindle();
    test::SpindleSlave& slave = spindle.slave();
    if (what == "lose" || what == "garble" || what == "refuse") {
        (what == "lose" ? slave.lose : what == "garble" ? slave.garble : slave.refuse) = number;
    } else if (what == "delay") {
        slave.delay = number;
    } else if (what == "baud") {
        spindle.set_baud(number);
    } else if (what == "tell") {
        std::cout << "direction " << slave.direction() << "\nrpm " << static_cast<long>(slave.rpm())
                  << "\nrefused " << slave.refused() << "\n";
    } else {
        throw std::runtime_error{"no such spindle command: " + what};
    }
}

void Console::tell_drives()
{
    for (std::size_t place = 0; place < chip_.drives(); ++place) {
        const SocketModel& drive = chip_.drive(place);
        std::cout << "drive " << place << " written_ns " << drive.written_at() / 1000 << "\n"
                  << "drive " << place << " answers " << drive.answers() << "\n"
                  << "drive " << place << " damaged " << drive.damaged() << "\n"
                  << "drive " << place << " baud " << static_cast<long>(drive.baud()) << "\n";
        for (const auto& [number, value] : drive.registers()) {
            std::cout << "drive " << place << " " << number << " " << value << "\n";
        }
    }
}

// golden PROGRAM SCRIPT|- TRACE INVERTED MOST_TICKS PIN...
void Console::golden(std::istream& words)
{
    GoldenJob job;
    std::string program;
    std::string script;
    std::string trace;
    words >> program >> script >> trace >> job.inverted >> job.most_ticks;
    for (std::string name; words >> name;) {
        job.pins.push_back(pin_name(name));
    }
    std::istringstream lines{[&] {
        const std::vector<std::uint8_t> bytes = read_file(program);
        return std::string(bytes.begin(), bytes.end());
    }()};
    for (std::string line; std::getline(lines, line);) {
        job.lines.push_back(line);
    }
    if (script != "-") {
        std::ifstream file{script};
        std::uint64_t tick = 0;
        int byte = 0;
        while (file >> tick >> byte) {
            job.script.emplace_back(tick, static_cast<char>(byte));
        }
    }
    GoldenSender sender{chip_, std::move(job)};
    const int status = sender.run();
    listen();
    std::ofstream file{trace, std::ios::binary};
    file.write(reinterpret_cast<const char*>(sender.edges().data()),
               static_cast<std::streamsize>(sender.edges().size() * sizeof(std::uint64_t)));
    std::cout << "status " << status << "\n";
}

void Console::tell_pins() const
{
    for (const auto& [letter, port] : chip_.ports()) {
        for (unsigned pin = 0; pin < port->count(); ++pin) {
            const bool driven = port->driven(pin);
            const int value = driven ? (port->high(pin) ? 1 : 0) : port->given_to(pin);
            if (value >= 0) {
                std::cout << (driven ? "pin " : "function ") << port->name() << pin << " " << value
                          << "\n";
            }
        }
    }
    for (unsigned channel = 1; channel <= 4; ++channel) {
        std::cout << "spindle " << channel << " " << chip_.spindle_duty(channel) << "\n";
    }
    std::cout << "rate TIM3 " << chip_.spindle_hz() << "\n";
}

void Console::tell_duties()
{
    for (const ChipUnderTest::Duty& change : chip_.take_spindle_changes()) {
        std::cout << "duty " << change.time / 1000 << " " << change.channel << " " << change.ppm
                  << "\n";
    }
}

void Console::tell_changes() const
{
    for (const auto& [letter, port] : chip_.ports()) {
        for (const PinChange& change : port->changes()) {
            std::cout << "change " << change.time / 1000 << " " << letter << " " << change.driven
                      << " " << change.high << "\n";
        }
        port->forget_changes();
    }
}

void Console::tell_state() const
{
    std::cout << "now " << chip_.circuit().now / kMicrosecond << "\n"
              << "instructions " << chip_.core().instructions() << "\n"
              << "core_hz " << chip_.core_hz() << "\n"
              << "resets " << chip_.resets() << "\n"
              << "powered " << chip_.powered() << "\n"
              << "erases " << chip_.erases() << "\n"
              << "words " << chip_.words() << "\n"
              << "lost " << chip_.line().lost() << "\n"
              << "unsent " << chip_.line().waiting() << "\n"
              << "lowest_stack " << chip_.core().lowest_stack() << "\n";
    for (unsigned exception = 1; exception < 100; ++exception) {
        if (const auto longest = chip_.core().longest(exception); longest != 0) {
            std::cout << "longest_" << exception << " " << longest << "\namid_tick_" << exception
                      << " " << chip_.core().amid_tick(exception) << "\n";
        }
    }
    for (const std::string& violation : chip_.circuit().violations.list()) {
        std::cout << "violation " << violation << "\n";
    }
}

void Console::perform(const std::string& line)
{
    std::istringstream words{line};
    std::string command;
    words >> command;
    if (command == "run") {
        run(words);
    } else if (command == "send") {
        send(words);
    } else if (command == "pin") {
        pin(words);
    } else if (command == "core") {
        core(words);
    } else if (command == "serial") {
        serial(words);
    } else if (command == "line") {
        std::string which;
        words >> which;
        usb_ = which == "usb";
        chip_.make_usb_the_line(usb_);
    } else if (command == "usb") {
        command_usb(chip_, words);
    } else if (command == "pace") {
        chip_.stop_pace();
    } else if (command == "power") {
        power(words);
    } else if (command == "golden") {
        golden(words);
    } else if (command == "crystal") {
        chip_.kill_crystal();
    } else if (command == "baud") {
        std::uint32_t baud = 0;
        words >> baud;
        chip_.serial().set_sender_baud(baud);
    } else if (command == "flash") {
        const Picoseconds erase = milliseconds(words);
        chip_.set_flash_times(erase, milliseconds(words));
    } else if (command == "drive") {
        drive(words);
    } else if (command == "spindle") {
        spindle(words);
    } else if (command == "drives") {
        tell_drives();
    } else if (command == "pins") {
        tell_pins();
    } else if (command == "duties") {
        tell_duties();
    } else if (command == "changes") {
        tell_changes();
    } else if (command == "state") {
        tell_state();
    } else if (command == "terminal") {
        std::string link;
        words >> link;
        run_on_terminal(chip_, link, milliseconds(words));
        listen();
    } else {
        throw std::runtime_error{"no such command: " + line};
    }
}

constexpr std::size_t kLoaderBytes = 0x8000;

int obey(ChipUnderTest& chip, std::uint32_t hz)
{
    // 1.3 cycles an instruction.
    chip.core().set_instruction_time(kSecond / hz * 13 / 10);
    Console console{chip};
    for (std::string line; std::getline(std::cin, line);) {
        console.perform(line);
        std::cout << "done" << std::endl;
    }
    return 0;
}

int run_rp2350(int count, char** arguments)
{
    if (count > 4) {
        throw std::runtime_error{std::string{"no such word for this chip: "} + arguments[4]};
    }
    rp2350::Rp2350Chip chip{static_cast<std::uint32_t>(std::stoul(arguments[2])),
                            read_file(arguments[3])};
    return obey(chip, rp2350::Rp2350Chip::kMostHz);
}

int run_stm32(int count, char** arguments)
{
    ChipKind kind = chip_kind(arguments[1]);
    kind.clocks.crystal_hz = static_cast<std::uint32_t>(std::stoul(arguments[2]));
    std::vector<std::vector<Stm32Chip::Place>> drives;
    std::vector<std::uint8_t> image = read_file(arguments[3]);
    unsigned settings = 1;  // their first sector
    struct Spindle {
        vfd::Protocol protocol;
        unsigned usart;
        PinName pin;
    };
    std::optional<Spindle> spindle;
    for (int i = 4; i < count; ++i) {
        const std::string word = arguments[i];
        if (word == "external") {
            kind.clocks.external = true;
        } else if (word == "usart2") {
            kind.serial = 2;
        } else if (const int wires = word == "drive" ? 1 : 4;
                   (word == "drive" || word == "bus_drive") && i + wires < count) {
            drives.emplace_back();
            for (int end = i + wires; i < end;) {
                ++i;
                const PinName pin = pin_name(arguments[i]);
                drives.back().push_back({pin.port, pin.number});
            }
        } else if (word == "spindle" && i + 3 < count) {
            spindle = {static_cast<vfd::Protocol>(std::stoi(arguments[i + 1])),
                       static_cast<unsigned>(std::stoul(arguments[i + 2])),
                       pin_name(arguments[i + 3])};
            i += 3;
        } else if (word == "loader" && i + 2 < count) {
            std::vector<std::uint8_t> loader = read_file(arguments[i + 1]);
            settings = static_cast<unsigned>(std::stoul(arguments[i + 2]));
            i += 2;
            loader.resize(kLoaderBytes, 0xFF);
            image.insert(image.begin(), loader.begin(), loader.end());
        } else {
            throw std::runtime_error{"no such word: " + word};
        }
    }
    Stm32Chip chip{kind, image};
    chip.flash().set_free_sectors(settings);
    if (settings > 4) {
        chip.flash().set_times(2 * kSecond, 16 * kMicrosecond);  // 128 KB
    }
    for (const auto& wires : drives) {
        chip.add_drive("drive " + std::to_string(chip.drives()), wires);
    }
    if (spindle) {
        chip.add_spindle(spindle->protocol, spindle->usart, spindle->pin.port, spindle->pin.number);
    }
    return obey(chip, kind.clocks.most_hz);
}

}  // namespace
}  // namespace cusp::cosim

int main(int count, char** arguments)
{
    if (count < 4) {
        std::cerr << "usage: cosim CHIP CRYSTAL_HZ IMAGE.bin [external] [usart2] [drive PIN]... "
                     "[loader FILE.bin SECTOR]\n";
        return 2;
    }
    try {
        const bool pico = std::string{arguments[1]} == "rp2350";
        return pico ? cusp::cosim::run_rp2350(count, arguments)
                    : cusp::cosim::run_stm32(count, arguments);
    } catch (const std::exception& error) {
        std::cerr << "cosim: " << error.what() << "\n";
        std::cout << "failed: " << error.what() << std::endl;  // the answer to the last command
        return 2;
    }
}
