#include "src/cli/file_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "needlework/error.h"
#include "needlework/parse.h"
#include "src/io/formats/read_configuration.h"
#include "src/scene/schema.h"
#include "src/scene_text/document.h"

namespace needlework::cli {
namespace {

constexpr std::string_view hdf5_signature = "\x89HDF\r\n\x1a\n";
constexpr std::ptrdiff_t commas_of_a_pair = 27;

// Empty for what cannot be read.
std::string beginning_of(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return {};
  std::ifstream file(path, std::ios::binary);
  std::string text(max_scene_bytes, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

FileKind kind_of_toml(const std::string& text) {
  const Document document(text, "", {});
  FileKind kind = FileKind::unknown;
  for (const Entry& entry : document.entries()) {
    const std::string& word = entry.section.empty() ? entry.key : entry.section;
    if (word == "seeds" || word == "parameters") return FileKind::grid;
    if (is_scene_section(word)) kind = FileKind::scene;
  }
  return kind;
}

bool is_line_of_a_pair(const std::string& text) {
  const auto end = text.find('\n');
  return std::count(text.begin(), end == text.npos ? text.end() : text.begin() + end, ',') ==
         commas_of_a_pair;
}

std::string name_of(FileKind kind) {
  switch (kind) {
    case FileKind::scene:
      return "a scene (TOML)";
    case FileKind::grid:
      return "the grid of a sweep (TOML)";
    case FileKind::pairs:
      return "a list of pairs of needles (CSV)";
    case FileKind::configuration:
      return "a configuration of another program";
    default:
      return "an HDF5 file";
  }
}

std::string command_for(FileKind kind, const std::string& path) {
  switch (kind) {
    case FileKind::scene:
      return fmt::format("needlework run {} runs", path);
    case FileKind::grid:
      return fmt::format("needlework sweep {} runs", path);
    case FileKind::pairs:
      return fmt::format("needlework predict {} reads", path);
    case FileKind::configuration:
      return fmt::format("needlework import {} reads", path);
    default:
      return fmt::format("needlework info {} describes", path);
  }
}

// The message with what the file is, if it is something else than was expected. What is said of the
// lines of a file in HDF5 is of no use.
std::string with_advice(const std::string& message, const std::string& path, FileKind expected) {
  const FileKind found = kind_of(path);
  if (found == expected || found == FileKind::unknown) return message;
  if (found != FileKind::h5md) {
    return fmt::format("{}; it is {}, which {}", message, name_of(found), command_for(found, path));
  }
  std::string text = fmt::format("{}: expected {}; it is {}, which {}", path, name_of(expected),
                                 name_of(found), command_for(found, path));
  if (expected == FileKind::scene) {
    text += fmt::format(" and initial.file = \"{}\" in a scene continues from", path);
  }
  return text;
}

}  // namespace

FileKind kind_of(const std::string& path) {
  const std::string text = beginning_of(path);
  if (text.starts_with(hdf5_signature)) return FileKind::h5md;
  if (is_line_of_a_pair(text)) return FileKind::pairs;
  if (io::is_configuration(text)) return FileKind::configuration;
  try {
    return kind_of_toml(text);
  } catch (const InputError&) {
    return FileKind::unknown;
  }
}

void rethrow_for(const std::string& path, FileKind expected) {
  try {
    throw;
  } catch (const InputError& error) {
    throw InputError(with_advice(error.what(), path, expected));
  } catch (const IoError& error) {
    throw IoError(with_advice(error.what(), path, expected));
  }
}

}  // namespace needlework::cli
