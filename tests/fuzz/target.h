// What fuzz targets share.
#pragma once

#include <fuzzer/FuzzedDataProvider.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "needlework/error.h"
#include "tests/support/temporary_folder.h"

namespace needlework::fuzz {

/// A promise that is not kept ends the target, as a crash does.
inline void require(bool condition) {
  if (!condition) std::abort();
}

/// Only the exceptions that stand for bad input may be thrown. Their messages must be short enough
/// to be read.
template <class Read>
void allow_bad_input(Read read) {
  try {
    read();
  } catch (const InputError& error) {
    require(std::string_view(error.what()).size() < 5000);
  } catch (const IoError& error) {
    require(std::string_view(error.what()).size() < 5000);
  }
}

/// The folder of this process, in memory where there is such a file system.
inline const std::filesystem::path& folder() {
  static const test::TemporaryFolder& temporary = [&]() -> const test::TemporaryFolder& {
    if (std::filesystem::is_directory("/dev/shm")) setenv("TMPDIR", "/dev/shm", 1);
    static const test::TemporaryFolder made;
    return made;
  }();
  return temporary.path();
}

inline void write_file(const std::string& path, std::string_view bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  require(file.good());
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace needlework::fuzz
