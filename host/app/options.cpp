#include "app/options.h"

namespace parhelion::app {

void addSceneOptions(Command& command, SceneArguments& arguments) {
    command.addArgument("SCENE", arguments.file, "scene file (Mitsuba 3 XML, or Nori XML)");
    command.addRepeatedOption("-D", "name=value",
                              "value of a $name in the scene, instead of its <default>; may be repeated",
                              [&arguments](const std::string& text) {
                                  auto [name, value] = parseDefine("-D", text);
                                  arguments.defines.insert_or_assign(std::move(name), std::move(value));
                              });
    addParsedOption(command, "--size", arguments.size, "WxH", "film size in pixels, instead of the scene's", parseSize);
}

SceneDescription readScene(const SceneArguments& arguments) {
    return parhelion::readScene(arguments.file, {.defines = arguments.defines});
}

}  // namespace parhelion::app
