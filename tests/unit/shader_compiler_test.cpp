#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "base/error.h"
#include "gpu/cache.h"
#include "gpu/pipeline.h"
#include "gpu/spirv_interface.h"
#include "support/scoped_variable.h"
#include "support/temporary_folder.h"

namespace parhelion {
namespace {

namespace fs = std::filesystem;
using test::ScopedVariable;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::Not;

/// Each test compiles into a cache of its own: nothing an earlier run stored can hide a failure.
class ShaderCompiler : public testing::Test {
protected:
    TemporaryFolder folder_;
    TemporaryFolder cache_;
    ScopedVariable cacheHome_{"XDG_CACHE_HOME", cache_.path().string()};

    std::string failureOf(const fs::path& shader) {
        try {
            gpu::compileShader(shader);
        } catch (const RuntimeFailure& failure) {
            return failure.what();
        }
        return "compiled";
    }

    std::vector<fs::path> cacheFiles() const {
        std::vector<fs::path> files;
        for (const auto& entry : fs::recursive_directory_iterator(cache_.path()))
            if (entry.is_regular_file()) files.push_back(entry.path());
        return files;
    }
};

const std::string kHeader = "#version 460\nlayout(local_size_x = 1) in;\n";

TEST_F(ShaderCompiler, ReportsFileAndLineOfAnError) {
    const fs::path shader = folder_.write("bad.comp", kHeader + "void main() {\n    int x = undeclared;\n}\n");
    const std::string message = failureOf(shader);
    EXPECT_THAT(message, HasSubstr(shader.string() + ":4: 'undeclared'"));
    EXPECT_THAT(message, Not(HasSubstr("ERROR")));
}

TEST_F(ShaderCompiler, ReportsFileAndLineInsideAnInclude) {
    const fs::path included = folder_.write("part.glsl", "\n\nfloat part() { return missing; }\n");
    const fs::path shader = folder_.write("main.comp", kHeader + "#include \"part.glsl\"\nvoid main() {}\n");
    EXPECT_THAT(failureOf(shader), HasSubstr(included.string() + ":3: 'missing'"));
}

TEST_F(ShaderCompiler, CountsLinesOnAfterAnInclude) {
    folder_.write("part.glsl", "const float kHalf = 0.5;\n\n\n");
    const fs::path shader =
        folder_.write("main.comp", kHeader + "#include \"part.glsl\"\nvoid main() { missing(); }\n");
    EXPECT_THAT(failureOf(shader), HasSubstr(shader.string() + ":4: 'missing'"));
}

TEST_F(ShaderCompiler, IncludesBesideTheFileThenFromTheShaderFolder) {
    fs::create_directory(folder_.path() / "inner");
    folder_.write("inner/a.glsl", "#include \"b.glsl\"\n");
    folder_.write("inner/b.glsl", "const float kNear = 1.0;\n");
    folder_.write("b.glsl", "#error the wrong b.glsl\n");
    const fs::path shader = folder_.write("main.comp", kHeader +
                                                           "#include \"inner/a.glsl\"\n#include \"core/math.glsl\"\n"
                                                           "void main() { float x = kNear + kPi; }\n");
    EXPECT_NO_THROW(gpu::compileShader(shader));
}

TEST_F(ShaderCompiler, ReportsMissingInclude) {
    const fs::path shader = folder_.write("main.comp", kHeader + "#include \"nowhere.glsl\"\nvoid main() {}\n");
    const std::string message = failureOf(shader);
    EXPECT_THAT(message, HasSubstr(shader.string() + ":3:"));
    EXPECT_THAT(message, HasSubstr("nowhere.glsl"));
}

TEST_F(ShaderCompiler, RefusesIncludeCycle) {
    folder_.write("a.glsl", "#include \"b.glsl\"\n");
    const fs::path b = folder_.write("b.glsl", "\n#include \"a.glsl\"\n");
    const fs::path shader = folder_.write("main.comp", kHeader + "#include \"a.glsl\"\nvoid main() {}\n");
    const std::string message = failureOf(shader);
    EXPECT_THAT(message, HasSubstr(b.string() + ":2:"));
    EXPECT_THAT(message, HasSubstr("cycle"));
}

TEST_F(ShaderCompiler, AllowsOneFileFromTwoPlaces) {
    folder_.write("shared.glsl", "#ifndef S\n#define S\nconst float kOne = 1.0;\n#endif\n");
    folder_.write("a.glsl", "#include \"shared.glsl\"\n");
    const fs::path shader = folder_.write(
        "main.comp", kHeader + "#include \"a.glsl\"\n#include \"shared.glsl\"\nvoid main() { float x = kOne; }\n");
    EXPECT_NO_THROW(gpu::compileShader(shader));
}

TEST_F(ShaderCompiler, ReportsUnreadableShader) {
    EXPECT_THAT(failureOf(folder_.path() / "none.comp"), HasSubstr("none.comp"));
    EXPECT_THAT(failureOf(folder_.path()), HasSubstr("cannot read"));
}

TEST_F(ShaderCompiler, GivesDefinesTheirValues) {
    const fs::path shader = folder_.write(
        "main.comp",
        kHeader + "#if !defined(FLAG) || COUNT != 3\n#error defines are missing\n#endif\nvoid main() {}\n");
    EXPECT_NO_THROW(gpu::compileShader(shader, {"FLAG", "COUNT=3"}));
    EXPECT_THROW(gpu::compileShader(shader, {"FLAG", "COUNT=4"}), RuntimeFailure);
}

TEST_F(ShaderCompiler, FindsCompiledCodeAgainUntilAnIncludeChanges) {
    const std::string part = "layout(set = 0, binding = 0) buffer Result { uint value; };\n";
    folder_.write("part.glsl", part + "const uint kValue = 1u;\n");
    const fs::path shader =
        folder_.write("main.comp", kHeader + "#include \"part.glsl\"\nvoid main() { value = kValue; }\n");
    const auto first = gpu::compileShader(shader);
    ASSERT_EQ(cacheFiles().size(), 1u);
    EXPECT_EQ(gpu::compileShader(shader), first);
    EXPECT_EQ(cacheFiles().size(), 1u);

    folder_.write("part.glsl", part + "const uint kValue = 2u;\n");
    EXPECT_NE(gpu::compileShader(shader), first);
    EXPECT_EQ(cacheFiles().size(), 2u);
}

TEST_F(ShaderCompiler, TakesStoredCodeInsteadOfCompiling) {
    const fs::path shader = folder_.write("main.comp", kHeader + "void main() {}\n");
    gpu::compileShader(shader);
    const fs::path stored = cacheFiles().at(0);
    const std::vector<std::uint32_t> marked{0x07230203, 1, 2, 3, 4};
    gpu::writeCacheFile(stored, std::as_bytes(std::span(marked)));
    EXPECT_EQ(gpu::compileShader(shader), marked);
}

TEST_F(ShaderCompiler, CompilesAgainWhenStoredCodeIsDamaged) {
    const fs::path shader = folder_.write("main.comp", kHeader + "void main() {}\n");
    const auto sound = gpu::compileShader(shader);
    const fs::path stored = cacheFiles().at(0);
    for (const std::uintmax_t size : {std::uintmax_t{0}, std::uintmax_t{7}, fs::file_size(stored) - 1}) {
        fs::resize_file(stored, size);
        EXPECT_EQ(gpu::compileShader(shader), sound) << "after cutting the file to " << size << " bytes";
    }
    std::fstream(stored, std::ios::in | std::ios::out | std::ios::binary).seekp(40).put('\x55');
    EXPECT_EQ(gpu::compileShader(shader), sound) << "after changing a byte";
}

TEST_F(ShaderCompiler, FindsShadersWhereTheEnvironmentSays) {
    const ScopedVariable chosen("PARHELION_SHADERS", folder_.path().string());
    EXPECT_EQ(gpu::shaderFolder(), folder_.path());
    const ScopedVariable missing("PARHELION_SHADERS", (folder_.path() / "none").string());
    EXPECT_THROW(gpu::shaderFolder(), InputError);
}

TEST(CacheFolder, FallsBackWhenHomeCannotBeWritten) {
    const TemporaryFolder temporary;
    const fs::path file = temporary.write("file", "");  // a folder below a file can be made by nobody, root included
    const ScopedVariable cacheHome("XDG_CACHE_HOME", (file / "cache").string());
    const ScopedVariable home("HOME", file.string());
    const ScopedVariable place("TMPDIR", temporary.path().string());
    const fs::path folder = gpu::cacheFolder("part");
    EXPECT_THAT(folder.string(), HasSubstr(temporary.path().string()));
    EXPECT_TRUE(fs::is_directory(folder));
}

TEST(CacheFolder, IsEmptyWhenNothingCanBeWritten) {
    const TemporaryFolder temporary;
    const fs::path file = temporary.write("file", "");
    const ScopedVariable cacheHome("XDG_CACHE_HOME", (file / "cache").string());
    const ScopedVariable home("HOME", file.string());
    const ScopedVariable place("TMPDIR", file.string());
    EXPECT_EQ(gpu::cacheFolder("part"), fs::path());
}

}  // namespace
}  // namespace parhelion
