#include "support.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <thread>

namespace isolux {
namespace {
using testing::HasSubstr;

TEST(AtomicFile, LeavesTheOldFileAndNothingElseWhenWritingFails) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("out.txt", "old");
  EXPECT_THROW(write_atomically(path,
                                [](std::ostream& out) {
                                  out << "half";
                                  throw Cancelled("interrupted");
                                }),
               Cancelled);
  EXPECT_EQ(test::read_file(path), "old");
  EXPECT_EQ(folder.entries(), 1u);
  EXPECT_THAT(
      test::error_of([&] { write_atomically(path, [](std::ostream& out) { out.setstate(std::ios::badbit); }); }),
      HasSubstr("out.txt: writing failed"));
  EXPECT_EQ(test::read_file(path), "old");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(AtomicFile, ReplacesTheOldFileWithAllOfTheNew) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("out.tar.gz", "old");
  std::string named;
  write_atomically_by_name(path, [&](const std::string& temporary) {
    named = temporary;
    EXPECT_EQ(test::read_file(path), "old") << "seen by others until the end";
    std::ofstream(temporary) << "new";
  });
  EXPECT_TRUE(named.ends_with(".tar.gz")) << named;
  EXPECT_EQ(std::filesystem::path(named).parent_path(), std::filesystem::path(path).parent_path());
  EXPECT_EQ(test::read_file(path), "new");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(AtomicFile, FollowsTheUmaskAndSymbolicLinks) {
  const test::TemporaryFolder folder;
  const mode_t before = umask(027);
  write_atomically(folder.file("a"), [](std::ostream& out) { out << 1; });
  umask(before);
  struct stat status {};
  ASSERT_EQ(stat(folder.file("a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0640u);

  std::filesystem::create_symlink(folder.file("a"), folder.file("link"));
  write_atomically(folder.file("link"), [](std::ostream& out) { out << 2; });
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link")));
  EXPECT_EQ(test::read_file(folder.file("a")), "2");
}

TEST(AtomicFile, EndsByNameAsItWasAskedForWhereverLinksLead) {
  const test::TemporaryFolder folder;
  for (const std::string& target : {folder.file("blob"), folder.file("other.stl"), std::string("/dev/null")}) {
    std::filesystem::remove(folder.file("link.ply"));
    std::filesystem::create_symlink(target, folder.file("link.ply"));
    std::string named;
    write_atomically_by_name(folder.file("link.ply"), [&](const std::string& name) {
      named = name;
      std::ofstream(name) << "content";
    });
    EXPECT_TRUE(named.ends_with("link.ply")) << named;
    EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link.ply")));
    if (target != "/dev/null") {
      EXPECT_EQ(test::read_file(target), "content");
    }
  }
}

TEST(AtomicFile, KeepsLinksThatLeadToNoFileYet) {
  const test::TemporaryFolder folder;
  std::filesystem::create_symlink("second", folder.file("first"));
  std::filesystem::create_symlink(folder.file("new"), folder.file("second"));
  EXPECT_EQ(std::filesystem::path(written_file(folder.file("first"))).filename(), "new");
  write_atomically(folder.file("first"), [](std::ostream& out) { out << 1; });
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("first")));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("second")));
  EXPECT_EQ(test::read_file(folder.file("new")), "1");

  std::filesystem::create_symlink("gone/a", folder.file("astray"));
  EXPECT_THAT(test::error_of([&] { require_writable(folder.file("astray")); }), HasSubstr("there is no folder"));
  std::filesystem::create_symlink("ring", folder.file("ring"));
  EXPECT_NE(test::error_of([&] { require_writable(folder.file("ring")); }), "");
}

TEST(AtomicFile, LeavesNothingBehindForWhoEndsAtOnce) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("out", "old");
  EXPECT_NE(test::error_of([&] {
              write_atomically(path, [&](std::ostream& out) {
                out << "half";
                EXPECT_EQ(folder.entries(), 2u);
                const auto no_more = remove_temporary_files();
                EXPECT_EQ(folder.entries(), 1u);
                EXPECT_TRUE(no_more.owns_lock());
              });
            }),
            "");
  EXPECT_EQ(test::read_file(path), "old");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(AtomicFile, NamesAMissingFolder) {
  const test::TemporaryFolder folder;
  const auto write = [](std::ostream& out) { out << 1; };
  EXPECT_THAT(test::error_of([&] { write_atomically(folder.file("none/a"), write); }),
              testing::AllOf(HasSubstr("there is no folder"), HasSubstr("none")));
  EXPECT_THAT(test::error_of([&] { write_atomically(folder.file(""), write); }), HasSubstr("directory"));
}

TEST(AtomicFile, FindsOutBeforehandWhetherAFileCanBeWritten) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("old.txt", "old");
  EXPECT_NO_THROW(require_writable(path));
  EXPECT_EQ(test::read_file(path), "old");
  EXPECT_NO_THROW(require_writable(folder.file("new.txt")));
  EXPECT_NO_THROW(require_writable("/dev/null"));
  EXPECT_EQ(folder.entries(), 1u);
  EXPECT_THAT(test::error_of([&] { require_writable(folder.file("none/a")); }), HasSubstr("there is no folder"));
  EXPECT_THAT(test::error_of([&] { require_writable(folder.file("")); }), HasSubstr("directory"));
}

TEST(AtomicFile, NamesTheFileAskedForAndNotTheTemporary) {
  const test::TemporaryFolder folder;
  const auto write = [](const std::string& temporary) { throw IoError(temporary + ": cannot be written"); };
  EXPECT_EQ(test::error_of([&] { write_atomically_by_name(folder.file("a"), write); }),
            folder.file("a") + ": cannot be written");
}

TEST(AtomicFile, WritesIntoADeviceInsteadOfReplacingIt) {
  write_atomically("/dev/null", [](std::ostream& out) { out << "gone"; });
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(AtomicFile, GoesOnWritingAnOpenFile) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("log", "first ");
  const int file = open(path.c_str(), O_WRONLY | O_APPEND);
  ASSERT_GE(file, 0);
  for (const char* where : {"/dev/fd/", "/proc/self/fd/"}) {
    const std::string name = where + std::to_string(file);
    EXPECT_NO_THROW(require_writable(name));
    write_atomically(name, [](std::ostream& out) { out << "second "; });
    std::filesystem::remove(folder.file("link"));
    std::filesystem::create_symlink(name, folder.file("link"));
    write_atomically_by_name(folder.file("link"),
                             [](const std::string& temporary) { std::ofstream(temporary) << "third "; });
  }
  ASSERT_EQ(write(file, "last", 4), 4);
  close(file);
  EXPECT_EQ(test::read_file(path), "first second third second third last");
  EXPECT_EQ(folder.entries(), 2u);
}

TEST(AtomicFile, WritesIntoAPipe) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const std::string name = "/dev/fd/" + std::to_string(ends[1]);
  EXPECT_NO_THROW(require_writable(name));
  write_atomically(name, [](std::ostream& out) { out << "through"; });
  char text[16] = {};
  EXPECT_EQ(read(ends[0], text, sizeof(text)), 7);
  EXPECT_STREQ(text, "through");
  close(ends[0]);
  close(ends[1]);
}

TEST(AtomicFile, KeepsTheModeOfTheFileThatItReplaces) {
  const test::TemporaryFolder folder;
  const auto path = folder.write("secret", "old");
  ASSERT_EQ(chmod(path.c_str(), 0600), 0);
  write_atomically(path, [](std::ostream& out) { out << "new"; });
  struct stat status {};
  ASSERT_EQ(stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0600u);
  EXPECT_EQ(test::read_file(path), "new");
}

TEST(AtomicFile, LetsManyThreadsWriteOneFile) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("shared");
  {
    std::vector<std::jthread> threads;
    for (char c = 'a'; c < 'i'; ++c)
      threads.emplace_back(
          [&, c] { write_atomically(path, [&](std::ostream& out) { out << std::string(100000, c); }); });
  }
  const std::string text = test::read_file(path);
  EXPECT_EQ(text, std::string(100000, text.front()));
  EXPECT_EQ(folder.entries(), 1u);
}

}  // namespace
}  // namespace isolux
