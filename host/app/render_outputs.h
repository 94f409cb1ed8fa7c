#pragma once

#include <filesystem>
#include <vector>

#include "app/interrupt.h"
#include "app/render_command.h"
#include "app/render_report.h"

namespace parhelion::app {

/// The files that a render writes.
struct OutputFiles {
    std::filesystem::path exr, png;
    std::filesystem::path report;  ///< of the error; empty: none

    std::vector<std::filesystem::path> all() const;
};

/// Where to write; all places are tried now, not after hours of rendering.
/// @throws InputError for names of another kind and places that cannot be written to.
OutputFiles prepareOutputs(const RenderArguments& arguments);

/// Writes what a render has come to, at its end and on its way.
struct RenderOutputs {
    const RenderArguments& arguments;
    const OutputFiles& files;
    const CompiledScene& scene;
    const RenderSettings& settings;
    const std::vector<CloudBakeReport>& clouds;
    Interruption& interruption;

    /// Replaces the files, each at once, and says what is in them.
    RenderReport write(const RenderOutcome& outcome) const;
};

}  // namespace parhelion::app
