// The arguments of a call: values of a JSON object, each of the type that it must have.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "nlohmann/json.hpp"

namespace cusp::engine {

using Json = nlohmann::ordered_json;

// Errors of all functions: InputError that names the argument.
class Arguments {
public:
    // call  its name, for messages
    // text  a JSON object; "" is {}
    Arguments(std::string call, const std::string& text);

    // Throws where the call is not given one.
    std::string text(const char* key) const;
    double number(const char* key) const;
    std::vector<std::string> texts(const char* key) const;

    // None where the argument is absent.
    std::optional<std::string> find_text(const char* key) const;
    std::optional<double> find_number(const char* key) const;
    std::vector<std::string> find_texts(const char* key) const;
    std::vector<double> find_numbers(const char* key) const;
    bool flag(const char* key, bool otherwise) const;

    // Sets a value where the argument is given.
    void read(const char* key, std::optional<std::string>& value) const
    {
        take(find_text(key), value);
    }
    void read(const char* key, std::optional<double>& value) const
    {
        take(find_number(key), value);
    }
    void read(const char* key, std::string& value) const { take(find_text(key), value); }
    void read(const char* key, std::vector<std::string>& value) const { value = find_texts(key); }
    void read(const char* key, std::vector<double>& value) const { value = find_numbers(key); }

    // Refuses arguments that nothing has asked for: misspelt ones.
    void check_all_read() const;

private:
    template <class T, class Value>
    static void take(std::optional<T>&& given, Value& value)
    {
        if (given) {
            value = *std::move(given);
        }
    }
    const Json* find(const char* key) const;
    [[noreturn]] void refuse(const char* key, const char* needed) const;

    std::string call_;
    Json values_;
    mutable std::vector<std::string> read_;
};

}  // namespace cusp::engine
