#include "app/render_outputs.h"

#include <fmt/format.h>

#include "base/files.h"
#include "image/film_image.h"

namespace parhelion::app {

namespace {

namespace fs = std::filesystem;

double meanSamples(const Film& film) {
    if (film.pixelSamples.empty()) return static_cast<double>(film.samples);
    double sum = 0;
    for (const std::uint64_t samples : film.pixelSamples) sum += static_cast<double>(samples);
    return sum / static_cast<double>(film.pixelSamples.size());
}

ErrorReport describeError(const RenderArguments& arguments, const RenderSettings& settings,
                          const RenderOutcome& outcome) {
    ErrorReport report;
    report.norm = arguments.errorNorm;
    report.target = arguments.error;
    report.seconds = arguments.seconds;
    if (arguments.sampleCount) report.maximum = settings.sampleCount;
    report.estimate = estimateFilmError(outcome.film);
    report.controlError = outcome.controlError;
    report.checkpoints = outcome.checkpoints;
    report.samplesForTarget = outcome.samplesForTarget;
    report.secondsForTarget = outcome.secondsForTarget;
    report.samplesForHalf = outcome.samplesForHalf;
    report.secondsForHalf = outcome.secondsForHalf;
    if (report.estimate) report.checks = judge(*report.estimate, report.checkpoints);
    return report;
}

RenderReport makeReport(const RenderOutputs& outputs, const RenderOutcome& outcome) {
    const CompiledScene& scene = outputs.scene;
    return {.scene = outputs.arguments.scene.file,
            .exr = outputs.files.exr.string(),
            .png = outputs.files.png.string(),
            .backend = nameOf(outputs.arguments.backend),
            .device = outcome.device,
            .driver = outcome.driver,
            .filmSize = scene.filmSize,
            .cropOffset = scene.cropOffset,
            .cropSize = scene.cropSize,
            .samples = outcome.film.samples,
            .samplesPerPixel = meanSamples(outcome.film),
            .endedBy = outcome.endedBy,
            .samplesWanted = outputs.settings.sampleCount,
            .seed = outputs.settings.seed,
            .prepareSeconds = outcome.prepareSeconds,
            .seconds = outcome.seconds,
            .error = describeError(outputs.arguments, outputs.settings, outcome),
            .effects = outputs.settings.effects,
            .quality = outputs.settings.quality,
            .counters = outcome.film.counters,
            .range = {},
            .clouds = outputs.clouds,
            .notes = scene.notes};
}

}  // namespace

std::vector<fs::path> OutputFiles::all() const {
    return report.empty() ? std::vector{exr, png} : std::vector{exr, png, report};
}

OutputFiles prepareOutputs(const RenderArguments& arguments) {
    OutputFiles files;
    files.exr =
        arguments.output.empty() ? fs::path(arguments.scene.file).stem().concat(".exr") : fs::path(arguments.output);
    if (files.exr.extension() != ".exr")
        throw InputError(fmt::format(
            "--output: expected a name that ends in .exr (a .png is written beside it); got {}", files.exr.string()));
    files.png = fs::path(files.exr).replace_extension(".png");
    files.report = arguments.report;
    if (!files.report.empty() && files.report.extension() != ".html" && files.report.extension() != ".json")
        throw InputError(
            fmt::format("--report: expected a name that ends in .html or .json; got {}", files.report.string()));
    for (const fs::path& file : files.all()) AtomicFile probe(file);
    return files;
}

RenderReport RenderOutputs::write(const RenderOutcome& outcome) const {
    RenderReport report = makeReport(*this, outcome);
    Image image = toImage(outcome.film, &report.range, varianceFactorsOf(outcome.film));
    addErrorLayers(image, outcome.film);
    addAttributes(report, image);
    const auto lock = interruption.holdOff();
    writeExr(files.exr, image);
    writePng(files.png, image, arguments.exposure);
    if (!files.report.empty()) writeErrorReport(report, files.report);
    return report;
}

}  // namespace parhelion::app
