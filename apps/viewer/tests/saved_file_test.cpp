#include "model/saved_file.h"

#include <gtest/gtest.h>
#include <isolux/core/error.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>

namespace isolux::viewer {
namespace {

namespace fs = std::filesystem;

/// In an empty folder of its own.
class SavedFile : public testing::Test {
 protected:
  void SetUp() override {
    before_ = fs::current_path();
    folder_ = fs::temp_directory_path() / ("isolux-saved-file-" + std::to_string(getpid()));
    fs::create_directories(folder_);
    fs::current_path(folder_);
  }
  void TearDown() override {
    fs::current_path(before_);
    fs::remove_all(folder_);
  }

  static std::string save(const std::string& volume, const std::string& content) {
    return save_under_free_name(volume, 0.25, "png", [&](const std::string& path) { std::ofstream(path) << content; });
  }
  static std::string content(const std::string& name) {
    std::ifstream file(name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  [[nodiscard]] std::set<std::string> names() const {
    std::set<std::string> result;
    for (const auto& entry : fs::directory_iterator(folder_)) result.insert(entry.path().filename().string());
    return result;
  }

  fs::path before_;
  fs::path folder_;
};

TEST_F(SavedFile, IsNamedByTheVolumeAndOverwritesNothing) {
  EXPECT_EQ(save("/data/head.nrrd", "one"), "head-0.25.png");
  EXPECT_EQ(save("/data/head.nrrd", "two"), "head-0.25-2.png");
  fs::create_symlink("nowhere", "head-0.25-3.png");
  EXPECT_EQ(save("/data/head.nrrd", "four"), "head-0.25-4.png");
  EXPECT_EQ(content("head-0.25.png"), "one");
  EXPECT_EQ(content("head-0.25-2.png"), "two");
  EXPECT_EQ(save("gen:sphere:8", ""), "gen_sphere_8-0.25.png");
  EXPECT_EQ(names().size(), 5u) << "nothing else is left";
}

TEST_F(SavedFile, HasANameThatFileSystemsTake) {
  const std::string name = save(std::string(251, 'L') + ".raw", "long");
  EXPECT_LE(name.size(), 255u);
  EXPECT_EQ(content(name), "long");
  std::string letters = "x";
  for (int i = 0; i < 120; ++i) letters += "\xc3\xa9";
  const std::string accented = save(letters + ".raw", "long");
  EXPECT_EQ(accented.find("\xc3-"), std::string::npos) << "no half of a letter";
  EXPECT_EQ(content(accented), "long");
}

TEST_F(SavedFile, LeavesNothingBehindIfItCannotBeMade) {
  const auto fails = [](const std::string& path) {
    std::ofstream(path) << "half";
    throw std::runtime_error("no more");
  };
  EXPECT_THROW(static_cast<void>(save_under_free_name("a", 1.0, "ply", fails)), std::runtime_error);
  EXPECT_TRUE(names().empty());
  const auto names_it = [](const std::string& path) { throw IoError(path + ": writing failed"); };
  try {
    static_cast<void>(save_under_free_name("a", 1.0, "ply", names_it));
    FAIL();
  } catch (const IoError& error) {
    EXPECT_STREQ(error.what(), "a-1.ply: writing failed");
  }
}

// Two windows in one folder: neither may take the other's name.
TEST_F(SavedFile, IsNotTakenByAnotherProgramOfTheSameMoment) {
  constexpr int kFiles = 150;
  std::array<pid_t, 4> children{};
  for (std::size_t c = 0; c < children.size(); ++c) {
    children[c] = fork();
    if (children[c] == 0) {
      for (int i = 0; i < kFiles; ++i) save("head.nrrd", std::to_string(c) + ":" + std::to_string(i));
      _exit(0);
    }
  }
  for (const pid_t child : children) waitpid(child, nullptr, 0);
  std::set<std::string> contents;
  for (const std::string& name : names()) contents.insert(content(name));
  EXPECT_EQ(contents.size(), children.size() * kFiles);
}

}  // namespace
}  // namespace isolux::viewer
