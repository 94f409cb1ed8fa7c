#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <cstring>
#include <sstream>

#include "base/error.h"
#include "gpu/cache.h"
#include "gpu/pipeline.h"
#include "gpu/shader_source.h"

namespace parhelion::gpu {
namespace fs = std::filesystem;
namespace {

/// Changes with the options below, so that SPIR-V made with others is not found again.
constexpr std::string_view kOptions = "vulkan1.2 spv1.5 1";

/// Serves #include from what readSources read, so that what is compiled is what was hashed.
class Includer : public glslang::TShader::Includer {
public:
    explicit Includer(const SourceFiles& files) : files_(files) {}

    IncludeResult* includeLocal(const char* name, const char* includer, std::size_t) override {
        const auto file = files_.find(resolveInclude(includer, name).string());
        if (file == files_.end()) return nullptr;
        return new IncludeResult(file->first, file->second.data(), file->second.size(), nullptr);
    }
    void releaseInclude(IncludeResult* result) override { delete result; }

private:
    const SourceFiles& files_;
};

/// glslang's own state, shared by all compilations of the process: building it takes longer than most shaders.
void initialiseGlslang() {
    struct Process {
        Process() { glslang::InitializeProcess(); }
        ~Process() { glslang::FinalizeProcess(); }
    };
    static const Process process;
}

/// Turns "ERROR: file:12: 'x' : undeclared" into "file:12: 'x' : undeclared" and drops lines that only count errors.
std::string readableMessages(const std::string& log) {
    std::istringstream lines(log);
    std::string text;
    for (std::string line; std::getline(lines, line);) {
        if (line.find("compilation terminated") != std::string::npos) continue;
        if (line.find("compilation errors") != std::string::npos) continue;
        for (const std::string_view severity : {"ERROR: ", "WARNING: "})
            if (line.starts_with(severity)) line.erase(0, severity.size());
        line.erase(line.find_last_not_of(" \t\r") + 1);
        if (!line.empty()) text += "\n  " + line;
    }
    return text;
}

std::string preambleOf(const std::vector<std::string>& defines) {
    std::string preamble = "#extension GL_GOOGLE_include_directive : require\n";
    for (const std::string& define : defines) {
        std::string text = define;
        if (const std::size_t equals = text.find('='); equals != std::string::npos) text[equals] = ' ';
        preamble += "#define " + text + "\n";
    }
    return preamble;
}

std::vector<std::uint32_t> compile(const fs::path& file, const SourceFiles& sources, const std::string& preamble) {
    initialiseGlslang();
    const std::string name = file.string();
    const std::string& text = sources.at(name);
    const char* const strings[] = {text.data()};
    const int lengths[] = {static_cast<int>(text.size())};
    const char* const names[] = {name.c_str()};
    glslang::TShader shader(EShLangCompute);
    shader.setStringsWithLengthsAndNames(strings, lengths, names, 1);
    shader.setPreamble(preamble.c_str());
    shader.setEnvInput(glslang::EShSourceGlsl, EShLangCompute, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_2);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_5);
    Includer includer(sources);
    constexpr auto kMessages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
    if (!shader.parse(GetDefaultResources(), 460, false, kMessages, includer))
        throw RuntimeFailure(
            fmt::format("{}: this shader does not compile:{}", name, readableMessages(shader.getInfoLog())));
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(kMessages))
        throw RuntimeFailure(
            fmt::format("{}: this shader does not link:{}", name, readableMessages(program.getInfoLog())));
    std::vector<std::uint32_t> spirv;
    glslang::SpvOptions options;
    glslang::GlslangToSpv(*program.getIntermediate(EShLangCompute), spirv, &options);
    return spirv;
}

/// Named by all that decides the SPIR-V: paths count relative to the shader, so that a moved tree finds its code.
fs::path cacheFileOf(const fs::path& shader, const SourceFiles& sources, const std::string& preamble) {
    const fs::path folder = cacheFolder("spirv");
    if (folder.empty()) return {};
    const glslang::Version version = glslang::GetVersion();
    std::uint64_t hash = contentHash(fmt::format("{} glslang {}.{}.{}\n{}\n{}\n", kOptions, version.major,
                                                 version.minor, version.patch, shader.filename().string(), preamble));
    for (const auto& [path, text] : sources) {
        const fs::path relative = fs::path(path).lexically_relative(shader.parent_path());
        hash = contentHash(fmt::format("{}\n{}\n{}", relative.string(), text.size(), text), hash);
    }
    return folder / fmt::format("{:016x}.spv", hash);
}

std::vector<std::uint32_t> readSpirv(const fs::path& file) {
    constexpr std::uint32_t kMagic = 0x07230203;
    const std::vector<std::byte> bytes = readCacheFile(file);
    std::vector<std::uint32_t> words(bytes.size() / sizeof(std::uint32_t));
    if (words.empty()) return {};
    std::memcpy(words.data(), bytes.data(), words.size() * sizeof words[0]);
    return words[0] == kMagic ? words : std::vector<std::uint32_t>{};
}

}  // namespace

std::vector<std::uint32_t> compileShader(const fs::path& file, const std::vector<std::string>& defines) {
    const fs::path shader = file.lexically_normal();
    const SourceFiles sources = readSources(shader);
    const std::string preamble = preambleOf(defines);
    const fs::path cached = cacheFileOf(shader, sources, preamble);
    std::vector<std::uint32_t> spirv = readSpirv(cached);
    if (!spirv.empty()) return spirv;
    spirv = compile(shader, sources, preamble);
    if (!cached.empty()) writeCacheFile(cached, std::as_bytes(std::span(spirv)));
    return spirv;
}

}  // namespace parhelion::gpu
