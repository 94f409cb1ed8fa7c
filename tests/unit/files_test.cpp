#include "base/files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>

#include "support/temporary_folder.h"

namespace parhelion {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using Names = std::set<std::string>;

/// The message of the InputError that action throws; empty if it throws none.
template <typename Action>
std::string inputError(const Action& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

TEST(Files, ReadsEveryByteAsWritten) {
    const TemporaryFolder folder;
    std::string content;
    for (int i = 0; i < 256; ++i) content += static_cast<char>(i);
    content += "\r\n\n";
    const fs::path path = folder.path() / "bytes";
    writeAtomically(path, content);
    EXPECT_EQ(readTextFile(path), content);
    EXPECT_EQ(readBinaryFile(path).size(), content.size());
    EXPECT_EQ(std::to_integer<int>(readBinaryFile(path)[255]), 255);
    EXPECT_EQ(readTextFile(folder.write("empty", "")), "");
}

TEST(Files, MissingFileBlamesThePlaceThatNamesIt) {
    const SourceLocation where{"scene.xml", 3, 7};
    EXPECT_EQ(inputError([&] { readTextFile("/no/such/file", where); }),
              "scene.xml:3:7: file must exist; got '/no/such/file'");
    EXPECT_EQ(inputError([&] { readBinaryFile("/no/such/file"); }),
              "/no/such/file: file must exist; got '/no/such/file'");
}

TEST(Files, RefusesWhatIsNotARegularFile) {
    const TemporaryFolder folder;
    const fs::path pipe = folder.path() / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    // Opening the pipe would wait for a writer for ever.
    for (const fs::path& path : {folder.path(), pipe, fs::path("/dev/zero")})
        EXPECT_NE(inputError([&] { readBinaryFile(path); }).find("must be a regular file"), std::string::npos) << path;
}

TEST(AtomicFileOutput, AppearsOnlyWhenCommitted) {
    const TemporaryFolder folder;
    const fs::path path = folder.write("image.exr", "old");
    {
        const AtomicFile file(path);
        EXPECT_EQ(file.temporaryPath().parent_path(), folder.path());
        EXPECT_EQ(file.temporaryPath().extension(), ".exr");
        EXPECT_EQ(readTextFile(path), "old");
        EXPECT_EQ(folder.names().size(), 2u);
    }
    EXPECT_EQ(readTextFile(path), "old");
    EXPECT_EQ(folder.names(), Names{"image.exr"});
    writeAtomically(path, "new");
    EXPECT_EQ(readTextFile(path), "new");
    EXPECT_EQ(folder.names(), Names{"image.exr"});
}

TEST(AtomicFileOutput, ReplacesTheTargetOfALink) {
    const TemporaryFolder folder;
    const fs::path target = folder.write("target", "old"), link = folder.path() / "link";
    fs::create_symlink(target, link);
    writeAtomically(link, "new");
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(readTextFile(target), "new");
}

TEST(AtomicFileOutput, RefusesImpossibleDestinations) {
    const TemporaryFolder folder;
    for (const fs::path& path :
         {fs::path("/dev/null"), folder.path(), folder.path() / "", folder.path() / "no/such/file"})
        EXPECT_NE(inputError([&] { writeAtomically(path, "x"); }), "") << path;
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_EQ(folder.names(), Names{});
}

TEST(AtomicFileOutput, FailureToRenameLeavesNothingBehind) {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / "image.exr";
    {
        AtomicFile file(path);
        fs::create_directories(path / "in the way");
        EXPECT_THROW(file.commit(), RuntimeFailure);
    }
    EXPECT_EQ(folder.names(), Names{"image.exr"});
}

}  // namespace
}  // namespace parhelion
