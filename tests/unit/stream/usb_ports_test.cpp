// A board on USB by its name, serial number, or vendor and product.
#include "host_tools/controller/stream/usb_ports.hpp"

#include "CppUTest/TestHarness.h"

#include "host_tools/base/input_error/input_error.hpp"

using cusp::stream::pick_usb_port;
using cusp::stream::UsbPort;

TEST_GROUP(UsbPorts)
{
    const std::vector<UsbPort> ports{
        {"/dev/ttyUSB0", 0x1A86, 0x7523, "USB Serial", ""},
        {"/dev/ttyACM0", 0x1209, 0x0001, "cusp skr2_f407", "0011"},
        {"/dev/ttyACM1", 0x1209, 0x0001, "cusp black_pill_f411", "2233"},
    };
    std::string error_of(const std::vector<UsbPort>& all, const std::string& wanted) const
    {
        try {
            (void)pick_usb_port(all, wanted);
        } catch (const cusp::InputError& error) {
            return error.what();
        }
        FAIL("no error");
        return "";
    }
};

TEST(UsbPorts, AreFoundByNameNumberAndPair)
{
    STRCMP_EQUAL("/dev/ttyACM0", pick_usb_port(ports, "skr2").c_str());
    STRCMP_EQUAL("/dev/ttyACM1", pick_usb_port(ports, "cusp black_pill_f411").c_str());
    STRCMP_EQUAL("/dev/ttyACM1", pick_usb_port(ports, "2233").c_str());
    STRCMP_EQUAL("/dev/ttyUSB0", pick_usb_port(ports, "1a86:7523").c_str());
    STRCMP_EQUAL("/dev/ttyACM0", pick_usb_port({ports[0], ports[1]}, "").c_str());
}

TEST(UsbPorts, AreListedWhereNoneOrSeveralAreMeant)
{
    STRCMP_CONTAINS("/dev/ttyACM1 (cusp black_pill_f411, 1209:0001, serial number 2233)",
                    error_of(ports, "").c_str());
    STRCMP_CONTAINS("several", error_of(ports, "1209:0001").c_str());
    STRCMP_CONTAINS("usb:octopus: no port", error_of(ports, "octopus").c_str());
    STRCMP_CONTAINS("there are: none", error_of({}, "").c_str());
}
