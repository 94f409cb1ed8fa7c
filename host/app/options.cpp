#include "app/options.h"

namespace parhelion::app {

void addSceneOptions(CLI::App& command, SceneArguments& arguments) {
    command.add_option("SCENE", arguments.file, "scene file (Mitsuba 3 XML, or Nori XML)")->required()->type_name("");
    command
        .add_option_function<std::vector<std::string>>(
            "-D",
            [&arguments](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) {
                    auto [name, value] = parseDefine("-D", text);
                    arguments.defines.insert_or_assign(std::move(name), std::move(value));
                }
            },
            "value of a $name in the scene, instead of its <default>; may be repeated")
        ->type_name("name=value")
        ->allow_extra_args(false);
    addParsedOption(command, "--size", arguments.size, "WxH", "film size in pixels, instead of the scene's", parseSize);
}

SceneDescription readScene(const SceneArguments& arguments) {
    return parhelion::readScene(arguments.file, {.defines = arguments.defines});
}

}  // namespace parhelion::app
