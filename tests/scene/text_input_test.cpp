// Files that people name: which of them can be read as text.
#include "src/scene_text/text_input.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <string>
#include <thread>

#include "needlework/error.h"
#include "tests/support/temporary_folder.h"

namespace needlework {
namespace {

std::string all_of(const std::string& path) {
  const auto file = open_text(path);
  std::string text(1 << 20, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), file.get()));
  return text;
}

TEST(TextInput, OfAFileAndOfAPipeIsTheSame) {
  const test::TemporaryFolder folder;
  const std::string text(200000, 'x'), file = folder.path() / "file", pipe = folder.path() / "pipe";
  std::ofstream(file) << text;
  EXPECT_EQ(all_of(file), text);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  // A writer that has opened the pipe before it is read, as the shell does it for <(COMMAND).
  std::fstream writer(pipe);
  std::thread writes([&] { writer << text << std::flush, writer.close(); });
  EXPECT_EQ(all_of(pipe), text);
  writes.join();
}

TEST(TextInput, OfAPipeWithoutAWriterIsRefusedAtOnce) {
  const test::TemporaryFolder folder;
  const std::string pipe = folder.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& path : {pipe, folder.path().string(), pipe + "/none"}) {
    EXPECT_THROW(open_text(path), IoError) << path;
  }
}

}  // namespace
}  // namespace needlework
