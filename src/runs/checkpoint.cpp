#include "src/runs/checkpoint.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "needlework/error.h"
#include "src/runs/checksum.h"
#include "src/runs/durable_file.h"
#include "src/scene/printable.h"
#include "src/scene/saved_scene.h"
#include "src/scene/scene_values.h"
#include "src/trajectory/saved_totals.h"

namespace needlework {

void transfer(Archive& archive, Checkpoint& checkpoint) { archive(checkpoint.bytes); }

namespace io {
void transfer(Archive& archive, Writer::Position& position) {
  archive(position.frames, position.samples, position.events);
}
}  // namespace io

}  // namespace needlework

namespace needlework::runs {

static void transfer(Archive& archive, RunFailure& failure) {
  auto& [message, needles, time, collisions, trajectory_hash, version] = failure;
  archive(message, needles, time, collisions, trajectory_hash, version);
}

namespace {

// To be changed whenever what is saved changes, here or in any function `transfer`.
constexpr std::string_view mark = "needlework checkpoint 3\n";

// Follows the mark.
struct Header {
  std::uint64_t size = 0;      // of what follows the header
  std::uint64_t checksum = 0;  // of the same
};

void transfer(Archive& archive, RunCheckpoint& run) {
  archive(run.scene, run.drawn, run.initial, run.simulation, run.output, run.observation,
          run.failure);
}

InputError damaged(const std::string& path, std::string_view how) {
  return InputError(fmt::format("{}: damaged: {}", path, how));
}

// Reads the next `size` bytes.
std::string read_bytes(std::FILE* file, std::size_t size, const std::string& path) {
  std::string bytes(size, '\0');
  bytes.resize(std::fread(bytes.data(), 1, size, file));
  if (std::ferror(file)) {
    throw IoError(
        fmt::format("{}: cannot be read: {}", path, std::generic_category().message(errno)));
  }
  return bytes;
}

void require_mark(const std::string& path, std::string_view begin) {
  if (begin == mark) return;
  constexpr std::string_view any_version = "needlework checkpoint ";
  if (!begin.starts_with(any_version)) throw damaged(path, "expected a checkpoint");
  throw InputError(fmt::format(
      "{}: expected \"{}\": a run is continued by the version of the program that began it", path,
      mark.substr(0, mark.size() - 1)));
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

// Opens a file and reads what stands before its content.
std::pair<File, Header> open_checkpoint(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw InputError(path + ": expected an ordinary file");
  }
  File file(std::fopen(path.c_str(), "rb"), [](std::FILE* f) { return f ? std::fclose(f) : 0; });
  if (!file) {
    throw IoError(
        fmt::format("{}: cannot be read: {}", path, std::generic_category().message(errno)));
  }
  require_mark(path, read_bytes(file.get(), mark.size(), path));
  Header header;
  const std::string head = read_bytes(file.get(), sizeof header, path);
  if (head.size() < sizeof header) throw damaged(path, "it is cut short");
  std::memcpy(&header, head.data(), sizeof header);
  return {std::move(file), header};
}

std::string bytes_of(const RunCheckpoint& checkpoint) {
  std::string bytes;
  bytes.reserve(checkpoint.simulation.bytes.size() + checkpoint.observation.size() +
                checkpoint.scene.text.size() + 65536);
  bytes = mark;
  bytes.resize(mark.size() + sizeof(Header));
  Archive archive = Archive::to(bytes);
  // An archive that writes changes nothing.
  transfer(archive, const_cast<RunCheckpoint&>(checkpoint));
  const std::string_view content = std::string_view(bytes).substr(mark.size() + sizeof(Header));
  const Header header{content.size(), checksum_of(content)};
  std::memcpy(bytes.data() + mark.size(), &header, sizeof header);
  return bytes;
}

std::string unfinished(const std::string& path) { return path + ".part"; }

void move_if_present(const std::string& from, const std::string& to) {
  if (std::rename(from.c_str(), to.c_str()) == 0 || errno == ENOENT) return;
  throw IoError(fmt::format("{}: {}", to, std::generic_category().message(errno)));
}

// A checksum says nothing about a file that somebody has made.
void restore(Scene& scene) {
  // The name of the output file may be any: options give it, and callers replace it.
  std::string file = std::exchange(scene.output.file, {});
  require_valid(scene);
  scene.output.file = std::move(file);
  // They become parts of messages.
  for (auto& [key, place] : scene.places) place = printable(place);
}

// The ordinary file to which a symbolic link leads, or else the name itself.
std::string behind_links(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  if (!std::filesystem::is_regular_file(path, error)) return path;
  const std::filesystem::path file = std::filesystem::canonical(path, error);
  return error ? path : file.string();
}

}  // namespace

RunCheckpoint CheckpointFiles::read(const std::string& path) {
  const auto [file, header] = open_checkpoint(path);
  // Before memory is taken for it.
  const std::uint64_t size = std::filesystem::file_size(path) - mark.size() - sizeof header;
  if (size != header.size) {
    throw damaged(path, fmt::format("{} bytes: expected {}", size, header.size));
  }
  const std::string bytes = read_bytes(file.get(), size, path);
  if (bytes.size() != size || checksum_of(bytes) != header.checksum) {
    throw damaged(path, "its checksum is wrong");
  }
  RunCheckpoint out;
  try {
    Archive archive = Archive::from(bytes);
    transfer(archive, out);
    archive.require_end();
    restore(out.scene);
  } catch (const InputError& error) {
    throw damaged(path, error.what());
  }
  out.origin = {.path = path, .checksum = header.checksum};
  return out;
}

CheckpointFiles::CheckpointFiles(const std::string& output_file)
    : newest_(behind_links(output_file) + ".checkpoint"),
      older_(newest_ + ".old"),
      bundle_(behind_links(output_file) + ".failure") {}

bool CheckpointFiles::exist() const {
  std::error_code ignored;
  return std::filesystem::exists(newest_, ignored) || std::filesystem::exists(older_, ignored);
}

void CheckpointFiles::require_writable() const {
  write_durably(unfinished(newest_), "");
  std::error_code ignored;
  std::filesystem::remove(unfinished(newest_), ignored);
}

void CheckpointFiles::write(const RunCheckpoint& checkpoint, Newest present) {
  write_durably(unfinished(newest_), bytes_of(checkpoint));
  if (present == Newest::becomes_older) move_if_present(newest_, older_);
  rename_durably(unfinished(newest_), newest_);
}

void CheckpointFiles::write_bundle(const RunCheckpoint& checkpoint) {
  replace_durably(bundle_, bytes_of(checkpoint));
}

void CheckpointFiles::move_bundle(const std::string& output_file) const {
  move_if_present(bundle_, CheckpointFiles(output_file).bundle_);
}

CheckpointFiles::Read CheckpointFiles::read() const {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const bool has_newest = fs::exists(newest_, ignored), has_older = fs::exists(older_, ignored);
  if (!has_newest && !has_older) {
    throw InputError(fmt::format(
        "{}: missing: expected the checkpoint of a run; there is nothing to continue", newest_));
  }
  // Without the newest, the program was stopped between two renames.
  if (!has_newest) return {read(older_), {}};
  try {
    return {read(newest_), {}};
  } catch (const std::runtime_error& error) {  // InputError or IoError
    try {
      if (has_older) return instead_of_newest(error.what());
    } catch (const InputError&) {
      // What is wrong with the newest says more.
    }
    throw;
  }
}

CheckpointFiles::Read CheckpointFiles::instead_of_newest(const char* reason) const {
  Read out{read(older_), fmt::format("{}; continuing from {}", reason, older_)};
  out.checkpoint.origin.instead_of_newest = true;
  return out;
}

void CheckpointFiles::require_unchanged(const RunCheckpoint::Origin& origin) const {
  try {
    // One that has replaced the newest may have left the one before as it was.
    const std::uint64_t checksum = origin.instead_of_newest
                                       ? read().checkpoint.origin.checksum
                                       : open_checkpoint(origin.path).second.checksum;
    if (checksum == origin.checksum) return;
  } catch (const InputError&) {
    // It is another one, or gone.
  }
  throw IoError(origin.path + ": another program has continued the run in the meantime");
}

void CheckpointFiles::remove() {
  for (const std::string& path : {newest_, older_, unfinished(newest_)}) {
    std::error_code error, ignored;
    std::filesystem::remove(path, error);
    if (error && std::filesystem::exists(path, ignored)) {
      throw IoError(fmt::format("{}: cannot be removed: {}", path, error.message()));
    }
  }
  // No run continues from it.
  for (const std::string& path : {bundle_, unfinished(bundle_)}) {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
}

}  // namespace needlework::runs
