#include "app/cloud_reports.h"
#include "app/render_command.h"

namespace parhelion::app {

namespace {

constexpr const char* kExamples = R"(Examples:
  parhelion render scenes/cloud_box.xml -o cloud.exr --spp 256
  parhelion render scenes/cloud_box.xml --error 1% --time 5m --report cloud.html
  parhelion render cloud.xml -D sigma=40 --size 320x240 --crop 100,80,64x64
  parhelion render cloud.xml --backend reference-double --spp 16 -o oracle.exr

Ctrl-C writes the image so far and exits with 130; a second one aborts.
Exit codes: 0 done, 1 samples dropped, majorants violated or values out of range, 2 bad input, 3 device or memory, 130 interrupted.)";

constexpr std::int64_t kMaxSamples = std::int64_t{1} << 40;
constexpr std::int64_t kMaxUint = 0xffffffff;

std::map<std::string, ErrorNorm> norms() {
    std::map<std::string, ErrorNorm> words;
    for (const ErrorNorm norm : {ErrorNorm::Rms, ErrorNorm::RelMse, ErrorNorm::Mean, ErrorNorm::Pixels})
        words.emplace(nameOf(norm), norm);
    return words;
}

void addImageOptions(Command& command, RenderArguments& arguments) {
    addTextOption(command, "-o,--output", arguments.output, "FILE",
                  "image to write (.exr; a .png is written beside it); "
                  "default: the scene's name, in the current folder");
    addIntegerOption(command, "--spp", arguments.sampleCount, 1, kMaxSamples,
                     "samples per pixel, instead of the scene's; with --error or --time: at most");
    addParsedOption(command, "--error", arguments.error, "X%", "render until the error is as small: 1%, 0.5%, 0.01",
                    parseShare);
    addChoiceOption<ErrorNorm, ErrorNorm>(
        command, "--error-norm", arguments.errorNorm, norms(),
        "what the error is: rms, root mean square error over the image's mean (default); relmse, root of the relative "
        "mean squared error; mean, half the 95 % interval of the image's mean; pixels, what 95 % of the pixels' own "
        "95 % intervals are within");
    addParsedOption(command, "--time", arguments.seconds, "TIME",
                    "end the whole process after 30s, 5m, 2h; together with --error: whichever comes first",
                    parseSeconds);
    addParsedOption(command, "--save-every", arguments.saveSeconds, "TIME",
                    "also write the image on the way, as soon as there is one and then as often, each time better",
                    parseSeconds);
    addTextOption(command, "--report", arguments.report, "FILE",
                  "what is known of the image's error and how far it can be trusted, as .html or .json");
    addIntegerOption(command, "--seed", arguments.seed, 0, kMaxUint,
                     "picks the random numbers (default: the scene's, 0)");
    addParsedOption(command, "--crop", arguments.crop, "X,Y,WxH", "render only these pixels of the film", parseCrop);
    addIntegerOption(command, "--max-depth", arguments.maxDepth, -1, 0x7fffffff,
                     "longest path, in scatterings + 1, instead of the scene's; -1: unlimited");
    addIntegerOption(command, "--depth-layers", arguments.depthLayers, 0, IntegratorDescription::kMostDepthLayers,
                     "EXR layers depth0, depth1, ... by number of scatterings, the last for all above; 0: none");
    addIntegerOption(command, "--feature-spp", arguments.featureSamples, 0, 65536,
                     "camera rays per pixel for albedo, normal and depth (default 16; 0: leave them out)");
    addNumberOption(command, "--exposure", arguments.exposure, -64, 64, "stops; brightens the PNG only (default 0)");
}

void addDeviceOptions(Command& command, RenderArguments& arguments) {
    std::map<std::string, Backend> backends;
    for (const Backend backend : {Backend::Vulkan, Backend::Reference, Backend::ReferenceDouble})
        backends.emplace(nameOf(backend), backend);
    addChoiceOption<Backend, Backend>(command, "--backend", arguments.backend, backends,
                                      "what renders (default vulkan); the reference is plain C++ on the CPU");
    addTextOption(command, "--device", arguments.device, "NAME",
                  "part of a device's name, or its number: see parhelion devices");
    addChoiceOption<std::optional<unsigned>, unsigned>(
        command, "--vector-bits", arguments.vectorBits, {{"0", 0}, {"128", 128}, {"256", 256}, {"512", 512}},
        "vector width of the software device (default 0: the widest, 256 with meshes)");
    addChoiceOption<std::optional<bool>, bool>(
        command, "--effects", arguments.allEffects, {{"scene", false}, {"all", true}},
        "simulate the scene's effects, or keep the code of all (same image, slower)");
}

void addQualityOptions(Command& command, RenderArguments& arguments) {
    addChoiceOption<bool, bool>(
        command, "--nee", arguments.sampleEveryLight, {{"auto", false}, {"all", true}},
        "aim rays at the lights that gain from it (default auto), or at the constant environment too");
    addChoiceOption<std::optional<bool>, bool>(
        command, "--sampler", arguments.sobol, {{"sobol", true}, {"independent", false}},
        "random numbers: Owen-scrambled Sobol points (default where surfaces or light sampling gain from them), or "
        "independent ones (default in media alone)");
    addChoiceOption<bool, bool>(command, "--density-filter", arguments.quality.stochasticFilter,
                                {{"stochastic", true}, {"trilinear", false}},
                                "one random corner per density lookup (default), or all eight");
    addNumberOption(command, "--shadow-roulette", arguments.quality.shadowRoulette, 0, 1e6,
                    "threshold of the shadow rays' roulette, relative to 4 pi times the scattering value (default 3)");
    addIntegerOption(command, "--steps-per-event", arguments.stepsPerEvent, 1, 1024,
                     "tracking steps between two event evaluations (default 4): speed only");
}

}  // namespace

const char* nameOf(Backend backend) {
    switch (backend) {
        case Backend::Vulkan:
            return "vulkan";
        case Backend::Reference:
            return "reference";
        case Backend::ReferenceDouble:
            return "reference-double";
    }
    return "";
}

Command addRenderCommand(CommandLine& program, RenderArguments& arguments) {
    Command command = program.addCommand("render", "Render a scene to an EXR and a PNG");
    addSceneOptions(command, arguments.scene);
    addImageOptions(command, arguments);
    addDeviceOptions(command, arguments);
    addQualityOptions(command, arguments);
    command.addFlag("--bake-error", arguments.bakeError, kBakeErrorHelp);
    command.addFlag("--allow-anomalies", arguments.allowAnomalies,
                    "exit with 0 although samples were dropped, majorants violated or values out of range");
    command.addFlag("--json", arguments.json, "print the report as JSON");
    command.addFlag("--quiet", arguments.quiet, "print errors only");
    command.setFooter(kExamples);
    return command;
}

}  // namespace parhelion::app
