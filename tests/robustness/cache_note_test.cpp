#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gpu/cache.h"
#include "support/paths.h"
#include "support/run_program.h"
#include "support/scene_text.h"
#include "support/scoped_variable.h"

// Where compiled shaders cannot be kept, starts are slow: users are told, once.
namespace parhelion::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class CacheNote : public testing::Test {
protected:
    TemporaryFolder folder_;
    const std::filesystem::path file_ = folder_.write("file", "");  // nobody can make a folder below it, root included

    /// What a render says where none of the folders for caches can be written.
    std::string notesOf(const std::vector<std::string>& more = {}) {
        folder_.write("scene.xml", SceneText{}.text());
        std::vector<std::string> arguments{"XDG_CACHE_HOME=" + (file_ / "cache").string(),
                                           "HOME=" + file_.string(),
                                           "TMPDIR=" + file_.string(),
                                           programFile(),
                                           "render",
                                           "scene.xml",
                                           "-o",
                                           "out.exr",
                                           "--spp",
                                           "1"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = runProgram("/usr/bin/env", arguments, folder_.path());
        EXPECT_EQ(result.exitCode, 0) << result.error;
        return result.error;
    }
};

TEST_F(CacheNote, SaysWhatIsSlowWhereNothingCanBeWritten) {
    const std::string notes = notesOf();
    EXPECT_THAT(notes, HasSubstr("note: " + (file_ / "cache/parhelion").string() + " or "));
    EXPECT_THAT(notes, HasSubstr("compiled at every start"));
    EXPECT_THAT(notes, HasSubstr("set XDG_CACHE_HOME"));
    EXPECT_EQ(notes.find("XDG_CACHE_HOME"), notes.rfind("XDG_CACHE_HOME")) << notes;
    EXPECT_THAT(notesOf({"--quiet"}), Not(HasSubstr("XDG_CACHE_HOME")));
}

TEST_F(CacheNote, NamesTheTemporaryFolderThatIsTakenInstead) {
    const ScopedVariable cacheHome("XDG_CACHE_HOME", ""), place("TMPDIR", folder_.path());
    {
        const ScopedVariable home("HOME", file_);
        EXPECT_THAT(gpu::cacheNote(), HasSubstr((file_ / ".cache/parhelion").string() + " cannot be written"));
        EXPECT_THAT(gpu::cacheNote(), HasSubstr("kept in " + folder_.path().string()));
    }
    const ScopedVariable home("HOME", "");
    EXPECT_THAT(gpu::cacheNote(), HasSubstr("neither XDG_CACHE_HOME nor HOME"));
}

TEST_F(CacheNote, IsNoneWhereOneOfTheUsersFoldersCanBeWritten) {
    const ScopedVariable cacheHome("XDG_CACHE_HOME", file_ / "cache");
    {
        const ScopedVariable home("HOME", folder_.path());
        EXPECT_EQ(gpu::cacheNote(), "");
    }
    const ScopedVariable home("HOME", file_), better("XDG_CACHE_HOME", folder_.path());
    EXPECT_EQ(gpu::cacheNote(), "");
}

}  // namespace
}  // namespace parhelion::test
