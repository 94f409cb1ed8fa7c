#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "app/option_values.h"
#include "scene/scene_description.h"

namespace parhelion::app {

/// Declares an option that takes one text, which `parse(name, text)` turns into `target`.
template <typename Target, typename Parse>
CLI::Option* addParsedOption(CLI::App& command, const std::string& name, Target& target, const std::string& placeholder,
                             const std::string& help, Parse parse) {
    return command
        .add_option_function<std::string>(
            name, [&target, name, parse](const std::string& text) { target = parse(name, text); }, help)
        ->type_name(placeholder);
}

template <typename Target>
CLI::Option* addIntegerOption(CLI::App& command, const std::string& name, Target& target, std::int64_t minimum,
                              std::int64_t maximum, const std::string& help) {
    return addParsedOption(command, name, target, "N", help, [=](const std::string& option, const std::string& text) {
        return parseInteger(option, text, minimum, maximum);
    });
}

template <typename Target>
CLI::Option* addNumberOption(CLI::App& command, const std::string& name, Target& target, double minimum, double maximum,
                             const std::string& help) {
    return addParsedOption(command, name, target, "X", help, [=](const std::string& option, const std::string& text) {
        return parseNumber(option, text, minimum, maximum);
    });
}

/// Declares an option that takes one of a few words, each standing for a value.
template <typename Target, typename Value>
CLI::Option* addChoiceOption(CLI::App& command, const std::string& name, Target& target,
                             const std::map<std::string, Value>& choices, const std::string& help) {
    std::string words;
    for (const auto& [word, value] : choices) words += (words.empty() ? "" : "|") + word;
    return addParsedOption(command, name, target, words, help,
                           [choices, words](const std::string& option, const std::string& text) {
                               const auto found = choices.find(text);
                               if (found == choices.end())
                                   throw InputError(option + ": expected " + words + "; got " + text);
                               return found->second;
                           });
}

/// What every command that reads a scene takes.
struct SceneArguments {
    std::string file;
    std::map<std::string, std::string> defines;
    std::optional<glm::uvec2> size;
};

/// Declares SCENE, -D and --size.
void addSceneOptions(CLI::App& command, SceneArguments& arguments);

/// Reads the scene that the arguments name.
SceneDescription readScene(const SceneArguments& arguments);

}  // namespace parhelion::app
