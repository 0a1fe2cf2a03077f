// The chip's wiring: which block lies where, and what asks which stream.
#include <algorithm>
#include <stdexcept>
#include <utility>

#include "tests/target/cosim/stm32_chip.hpp"

namespace cusp::cosim {
namespace {

constexpr unsigned kDma1Clock = 21;
constexpr unsigned kDma2Clock = 22;

class PowerModel final : public Model {
public:
    PowerModel(Circuit& circuit, ClockModel& clocks) : Model{circuit}, clocks_{clocks} {}
    std::uint32_t read(std::uint32_t offset) override { return clocks_.read_power(offset); }
    void write(std::uint32_t offset, std::uint32_t value) override
    {
        clocks_.write_power(offset, value);
    }
    void reset() override {}

private:
    ClockModel& clocks_;
};

bool always() { return true; }

// A stream and a channel of DMA2 (RM0090 table 43).
struct Request {
    unsigned stream;
    unsigned channel;
};
// Those of the update and of the compare channels 1 to 4.
using Requests = std::array<std::vector<Request>, 5>;

const Requests kRequestsOfTimer8{
    {{{1, 7}}, {{2, 7}, {2, 0}}, {{3, 7}, {2, 0}}, {{4, 7}, {2, 0}}, {{7, 7}}}};
const Requests kRequestsOfTimer1{
    {{{5, 6}}, {{1, 6}, {3, 6}, {6, 0}}, {{2, 6}, {6, 0}}, {{6, 6}, {6, 0}}, {{4, 6}}}};

}  // namespace

ChipKind chip_kind(const std::string& name)
{
    // Data sheets DS8626, DS8626, DS9405, DS10314, DS10693: rates, wait states at 3.3 V, memories. The F429
    // and the F446 without their over-drive.
    if (name == "stm32f405" || name == "stm32f407") {
        return {{8000000, 168000000, 42000000, 84000000, 30000000, 1},
                1024 * 1024,
                128 * 1024,
                64 * 1024,
                true,
                "ABCDEFGHI"};
    }
    if (name == "stm32f429") {
        return {{8000000, 168000000, 45000000, 90000000, 30000000, 3},
                1024 * 1024,
                192 * 1024,
                64 * 1024,
                true,
                "ABCDEFGHI"};
    }
    if (name == "stm32f446") {
        return {{8000000, 168000000, 45000000, 90000000, 30000000, 3},
                512 * 1024,
                128 * 1024,
                0,
                true,
                "ABCDEFGH",
                1,
                true};
    }
    if (name == "stm32f411") {
        return {{25000000, 100000000, 50000000, 100000000, 30000000, 3},
                512 * 1024,
                128 * 1024,
                0,
                false,
                "ABCDEH"};
    }
    throw std::runtime_error{"no such chip: " + name};
}

void Stm32Chip::make_blocks()
{
    for (const char letter : kind_.ports) {
        const auto bit = static_cast<unsigned>(letter - 'A');
        ports_[letter] = std::make_unique<PortModel>(circuit_, letter);
        add(0x40020000 + bit * kBlock, std::string{"port "} + letter, *ports_[letter],
            [this, bit] { return clocks_->ahb1_on(bit); });
    }
    power_ = std::make_unique<PowerModel>(circuit_, *clocks_);
    watchdog_ = std::make_unique<WatchdogModel>(circuit_);
    const auto read_any = [this](std::uint32_t address) {
        return read(address, 4);
    };
    // DMA1 reaches its own bus only, where the ports are not.
    dma1_ = std::make_unique<DmaModel>(
        circuit_, "DMA1", std::array<unsigned, 8>{11, 12, 13, 14, 15, 16, 17, 47},
        DmaModel::Port{read_any, [this](std::uint32_t address, std::uint32_t value) {
                           if (address >= 0x40010000) {
                               circuit_.violate("DMA1: no way to " + hexadecimal(address));
                               return;
                           }
                           write(address, 4, value);
                       }});
    dma2_ = std::make_unique<DmaModel>(
        circuit_, "DMA2", std::array<unsigned, 8>{56, 57, 58, 59, 60, 68, 69, 70},
        DmaModel::Port{read_any, [this](std::uint32_t address, std::uint32_t value) {
                           write_by_dma(address, value);
                       }});
    add(0x40007000, "PWR", *power_, always);
    add(0x40023800, "RCC", *clocks_, always);
    add(0x40023C00, "FLASH", *flash_, always);
    add(0x40003000, "IWDG", *watchdog_, always);
    add(0x40026000, "DMA1", *dma1_, [this] { return clocks_->ahb1_on(kDma1Clock); });
    add(0x40026400, "DMA2", *dma2_, [this] { return clocks_->ahb1_on(kDma2Clock); });
    active_ = {dma1_.get(), dma2_.get(), watchdog_.get()};
}

void Stm32Chip::add_timer(const std::string& name,
                          std::uint32_t address,
                          TimerModel::Wiring wiring,
                          std::function<bool()> clocked)
{
    auto timer = std::make_unique<TimerModel>(circuit_, name, std::move(wiring));
    add(address, name, *timer, std::move(clocked));
    active_.push_back(timer.get());
    timers_[name] = std::move(timer);
}

void Stm32Chip::make_timers()
{
    const auto slow = [this] {
        return clocks_->slow_timer_hz();
    };
    const auto fast = [this] {
        return clocks_->fast_timer_hz();
    };
    const auto on_slow = [this](unsigned bit) {
        return [this, bit] {
            return clocks_->apb1_on(bit);
        };
    };
    const auto on_fast = [this](unsigned bit) {
        return [this, bit] {
            return clocks_->apb2_on(bit);
        };
    };
    const auto ask = [this](const Requests& requests) {
        return [this, &requests](TimerModel::Event event) {
            for (const Request& request : requests[static_cast<std::size_t>(event)]) {
                static_cast<void>(dma2_->request(request.stream, request.channel));
            }
        };
    };
    add_timer("TIM2", 0x40000000, {slow, {}, {}, {}, 28, true}, on_slow(0));
    add_timer("TIM3", 0x40000400, {slow, {}, {}, {}, 29, false}, on_slow(1));
    add_timer("TIM4", 0x40000800, {slow, {}, {}, {}, 30, false}, on_slow(2));
    add_timer("TIM5", 0x40000C00, {slow, {}, {}, {}, 50, true}, on_slow(3));
    add_timer("TIM11", 0x40014800,
              {fast, {}, [this] { return clocks_->divided_crystal_hz(); }, {}, 26, false},
              on_fast(18));
    // RM0090 table 93: what ITR0 to ITR3 of a timer are.
    TimerModel* const gate = timers_["TIM2"].get();
    add_timer("TIM1", 0x40010000, {fast, ask(kRequestsOfTimer1), {}, {nullptr, gate}, -1, false},
              on_fast(0));
    gate->set_listener(timers_["TIM1"].get());
    if (kind_.has_timer8) {
        add_timer("TIM8", 0x40010400,
                  {fast, ask(kRequestsOfTimer8), {}, {nullptr, gate}, -1, false}, on_fast(1));
        gate->set_listener(timers_["TIM8"].get());
    }
}

// RM0090 tables 42 and 43: the streams that take and give bytes, all by channel 4.
struct Stm32Chip::SerialWiring {
    unsigned number;
    std::uint32_t address;
    DmaModel& dma;
    std::vector<unsigned> receive_streams;
    std::vector<unsigned> send_streams;
    std::function<std::uint32_t()> bus_hz;
    std::function<bool()> clocked;
    char port;
    unsigned first_pin;  // transmit, then receive
    unsigned interrupt;
};

void Stm32Chip::add_serial(const SerialWiring& wiring)
{
    DmaModel* const dma = &wiring.dma;
    const auto ask = [dma](const std::vector<unsigned>& streams) {
        return [dma, streams] {
            return std::any_of(streams.begin(), streams.end(),
                               [dma](unsigned stream) { return dma->request(stream, 4); });
        };
    };
    const std::string name = "USART" + std::to_string(wiring.number);
    auto& usart = usarts_.at(wiring.number - 1);
    usart = std::make_unique<UsartModel>(
        circuit_, name,
        UsartModel::Wiring{wiring.bus_hz, ask(wiring.receive_streams), ask(wiring.send_streams),
                           [&port = port_model(wiring.port), first = wiring.first_pin] {
                               return port.mode(first) == 2 && port.function(first) == 7 &&
                                      port.mode(first + 1) == 2 && port.function(first + 1) == 7;
                           },
                           wiring.interrupt});
    add(wiring.address, name, *usart, wiring.clocked);
    active_.push_back(usart.get());
}

void Stm32Chip::make_serial()
{
    add_serial({1,
                0x40011000,
                *dma2_,
                {2, 5},
                {7},
                [this] { return clocks_->fast_bus_hz(); },
                [this] { return clocks_->apb2_on(4); },
                'A',
                9,
                37});
    add_serial({2,
                0x40004400,
                *dma1_,
                {5},
                {6},
                [this] { return clocks_->slow_bus_hz(); },
                [this] { return clocks_->apb1_on(17); },
                'A',
                2,
                38});
    add_serial({3,
                0x40004800,
                *dma1_,
                {1},
                {3},
                [this] { return clocks_->slow_bus_hz(); },
                [this] { return clocks_->apb1_on(18); },
                'D',
                8,
                39});
    dma2_->set_start_listener([this] { usarts_[0]->stream_ready(); });
    dma1_->set_start_listener([this] {
        usarts_[1]->stream_ready();
        usarts_[2]->stream_ready();
    });
}

// RM0090 section 34 and table 62; the pins by alternate function 10.
void Stm32Chip::make_usb()
{
    usb_ = std::make_unique<UsbModel>(
        circuit_, UsbModel::Wiring{[this] { return clocks_->usb_hz(); },
                                   [this] {
                                       const PortModel& a = *ports_.at('A');
                                       return a.mode(11) == 2 && a.function(11) == 10 &&
                                              a.mode(12) == 2 && a.function(12) == 10;
                                   },
                                   kind_.overrides_usb_session, 67});
    host_ = std::make_unique<UsbHost>(circuit_, *usb_);
    active_.push_back(host_.get());
}

}  // namespace cusp::cosim
