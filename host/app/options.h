#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "app/command_line.h"
#include "app/option_values.h"
#include "scene/scene_description.h"

namespace parhelion::app {

/// Declares an option that takes one text, which `parse(name, text)` turns into `target`.
template <typename Target, typename Parse>
void addParsedOption(Command& command, const std::string& name, Target& target, const std::string& placeholder,
                     const std::string& help, Parse parse) {
    command.addOption(name, placeholder, help,
                      [&target, name, parse](const std::string& text) { target = parse(name, text); });
}

/// Declares an option whose text is kept as it is.
inline void addTextOption(Command& command, const std::string& name, std::string& target,
                          const std::string& placeholder, const std::string& help) {
    command.addOption(name, placeholder, help, [&target](const std::string& text) { target = text; });
}

template <typename Target>
void addIntegerOption(Command& command, const std::string& name, Target& target, std::int64_t minimum,
                      std::int64_t maximum, const std::string& help) {
    addParsedOption(command, name, target, "N", help, [=](const std::string& option, const std::string& text) {
        return parseInteger(option, text, minimum, maximum);
    });
}

template <typename Target>
void addNumberOption(Command& command, const std::string& name, Target& target, double minimum, double maximum,
                     const std::string& help) {
    addParsedOption(command, name, target, "X", help, [=](const std::string& option, const std::string& text) {
        return parseNumber(option, text, minimum, maximum);
    });
}

/// Declares an option that takes one of a few words, each standing for a value.
template <typename Target, typename Value>
void addChoiceOption(Command& command, const std::string& name, Target& target,
                     const std::map<std::string, Value>& choices, const std::string& help) {
    std::string words;
    for (const auto& [word, value] : choices) words += (words.empty() ? "" : "|") + word;
    addParsedOption(command, name, target, words, help,
                    [choices, words](const std::string& option, const std::string& text) {
                        const auto found = choices.find(text);
                        if (found == choices.end()) throw InputError(option + ": expected " + words + "; got " + text);
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
void addSceneOptions(Command& command, SceneArguments& arguments);

/// Reads the scene that the arguments name.
SceneDescription readScene(const SceneArguments& arguments);

}  // namespace parhelion::app
