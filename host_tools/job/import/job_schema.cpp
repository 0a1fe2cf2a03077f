// One form a kind; an operation is one of the strategies, told by its name.
#include "host_tools/job/import/job_schema.hpp"

#include <algorithm>
#include <iterator>

#include "host_tools/base/json_text/json_text.hpp"
#include "host_tools/job/import/job_key_tables.hpp"
#include "host_tools/job/job/operation_keys.hpp"

#include "fmt/format.h"
#include "nlohmann/json.hpp"

namespace cusp::import {

using job::Key;
using job::KeyTable;
using Schema = nlohmann::ordered_json;
using Kind = job::KeyKind;

namespace {

Schema members_of(const std::vector<Key>& keys);

Schema table_form(const KeyTable& table)
{
    Schema form = members_of(table.keys);
    form["description"] = table.help;
    return form;
}

Schema number_form(const Key& key)
{
    Schema form{{"type", "number"}};
    form[key.range.above_low ? "exclusiveMinimum" : "minimum"] = key.range.low;
    form["maximum"] = key.range.high;
    return form;
}

Schema list_of(const Schema& items) { return {{"type", "array"}, {"items", items}}; }

Schema sized(Schema list, std::size_t count)
{
    list["minItems"] = count;
    list["maxItems"] = count;
    return list;
}

Schema pair_of(const Schema& items) { return sized(list_of(items), 2); }

// A value or a list. No `anyOf`, for editors then mark the whole and not what is wrong in it: limits of
// numbers do not apply to lists, nor those of lists to numbers.
Schema one_or(const Schema& one, const Schema& list)
{
    Schema form = one;
    form.update(list);
    form["type"] = {one["type"], "array"};
    return form;
}

// One table or several of them, by the name of their definition.
Schema tables_form(const std::string& name)
{
    const Schema each{{"$ref", "#/definitions/" + name}};
    return {{"type", {"object", "array"}},
            {"items", each},
            {"if", {{"type", "object"}}},
            {"then", each}};
}

Schema form_of(const Key& key)
{
    const Schema text{{"type", "string"}};
    const Schema number = number_form(key);
    Schema whole = number;
    whole["type"] = "integer";
    Schema tool = whole;
    tool["type"] = {"integer", "string"};
    switch (key.kind) {
        case Kind::kLength:
        case Kind::kRate:
        case Kind::kNumber:
        case Kind::kAngle:
            return number;
        case Kind::kCount:
            return whole;
        case Kind::kFlag:
            return {{"type", "boolean"}};
        case Kind::kText:
            return text;
        case Kind::kChoice:
            return {{"type", "string"}, {"enum", key.choices}};
        case Kind::kFiles:
        case Kind::kTexts: {
            Schema item = text;
            if (!key.choices.empty()) {
                item["enum"] = key.choices;
            }
            return one_or(text, list_of(item));
        }
        case Kind::kLengths:
            return list_of(number);
        case Kind::kTwo:
            return sized(list_of(number), 2);
        case Kind::kThree:
            return sized(list_of(number), 3);
        case Kind::kNumbers:
            return one_or(number, list_of(number));
        case Kind::kTurn:
            return one_or(number, sized(list_of(number), 3));
        case Kind::kMargin:
        case Kind::kInterval:
            return one_or(number, pair_of(number));
        case Kind::kExtent:
            return pair_of(number);
        case Kind::kPairs:
            return list_of(pair_of(number));
        case Kind::kTool:
            return tool;
        case Kind::kTools:
            return one_or(text, list_of(tool));
        case Kind::kTable:
            return table_form(key.members());
        case Kind::kTables:
            return tables_form(key.name);
    }
    return {};
}

Schema described(const Key& key)
{
    Schema form = form_of(key);
    form["description"] = key.help;
    form["x-kind"] = job::form_of(key.kind).words;
    form["x-default"] = key.otherwise;
    return form;
}

// A table that has the key, or has it with that value.
Schema has(const std::string& rule)
{
    const std::size_t equals = rule.find(" = ");
    const std::string name = rule.substr(0, equals);
    Schema form{{"required", {name}}};
    if (equals != std::string::npos) {
        form["properties"] = {{name, {{"const", Schema::parse(rule.substr(equals + 3))}}}};
    }
    return form;
}

Schema has_any(const std::vector<std::string>& rules)
{
    Schema any = Schema::array();
    std::transform(rules.begin(), rules.end(), std::back_inserter(any), has);
    return {{"anyOf", any}};
}

// The rest of the table has or lacks other keys beside this one.
Schema dependency_of(const Key& key)
{
    Schema form = key.needs.empty() ? Schema::object() : has_any(key.needs);
    if (!key.excludes.empty()) {
        form["not"] = has_any(key.excludes);
    }
    return form;
}

Schema members_of(const std::vector<Key>& keys)
{
    Schema dependencies = Schema::object();
    Schema properties = Schema::object();
    Schema required = Schema::array();
    for (const Key& key : keys) {
        properties[key.name] = described(key);
        if (key.otherwise == "needed") {
            required.push_back(key.name);
        }
        if (!key.needs.empty() || !key.excludes.empty()) {
            dependencies[key.name] = dependency_of(key);
        }
    }
    Schema out{{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
    if (!required.empty()) {
        out["required"] = required;
    }
    if (!dependencies.empty()) {
        out["dependencies"] = dependencies;
    }
    return out;
}

Schema operation_form(const job::Strategies& strategies)
{
    Schema names = Schema::array();
    Schema conditions = Schema::array();
    for (const job::Strategy* const strategy : strategies) {
        names.push_back(strategy->name);
        Schema keys = members_of(keys_of(*strategy));
        keys["description"] = strategy->help;
        const Schema name{{"properties", {{"strategy", {{"const", strategy->name}}}}},
                          {"required", {"strategy"}}};
        conditions.push_back({{"if", name}, {"then", keys}});
    }
    // editors that look at no conditions complete and explain the keys, too
    Schema properties{{"strategy", {{"enum", names}, {"description", "what cuts, and how"}}}};
    for (const Key& key : job::all_keys(strategies)) {
        if (!properties.contains(key.name)) {
            properties[key.name] = {{"description", key.help}};
        }
    }
    return {{"type", "object"},
            {"description", "What is cut; [[operation]] for each."},
            {"required", {"strategy"}},
            {"properties", properties},
            {"allOf", conditions}};
}

}  // namespace

std::string job_schema(const job::Strategies& strategies)
{
    Schema schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
                  {"title", "A job of cusp"}};
    schema.update(members_of(job_table().keys));
    Schema& definitions = schema["definitions"];
    for (const Key& key : job_table().keys) {
        if (key.kind == Kind::kTables) {
            definitions[key.name] =
                key.members == nullptr ? operation_form(strategies) : table_form(key.members());
        }
    }
    return json_text::written(schema, 1) + "\n";
}

}  // namespace cusp::import
